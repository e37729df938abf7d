"""District rules and overrides as a user meets them: check, show, diff; overrides that survive a rebuild."""
import csv
import json
import os
import shutil
import sqlite3
import unittest

from blockrand_run import SAMPLE, SOURCE, BuildTest, blockrand, extract, main, read_json, sha256

RULES = '''
title = "Two kinds"
[[rule]]
name = "all"
level = "city"
preset = "postwar"
[[rule]]
name = "large"
which.area = [200, 100000]
preset = "slab"
parameters = { ornament = 0.5 }
'''


class Districts(BuildTest):
    def districts(self, *arguments, code=0):
        run = blockrand('districts', *arguments, *(() if arguments[0] == 'check' else ('--progress', 'none')))
        self.assertEqual(run.code, code, run)
        return run

    def test_shipped_rule_sets_are_sound(self):
        run = self.districts('check')
        for name in (n for n in os.listdir(os.path.join(SOURCE, "configs", "districts")) if n.endswith(".toml")):
            self.assertIn(name.removesuffix('.toml'), run.out)

    def test_mistakes_are_located(self):
        wrong = self.place('wrong.toml', '[[rule]]\nname = "r"\npreset = "postwra"\n')
        run = self.districts('check', wrong, code=2)
        self.assertIn('wrong.toml:3', run.err)
        self.assertIn('postwar', run.err)
        # One call tells the errors of all files, also beside one that is not there.
        second = self.place('second.toml', '')
        run = self.districts('check', wrong, self.path('missing.toml'), second, code=2)
        for told in ('wrong.toml:3', 'missing.toml', 'second.toml:1'):
            self.assertIn(told, run.err)
        configs = self.path('configs')
        shutil.copytree(os.path.join(SOURCE, 'configs'), configs)
        for name in ('berlin', 'leipzig'):
            with open(os.path.join(configs, 'districts', name + '.toml'), 'a', encoding='utf-8') as f:
                f.write('\n[[rule]]\nname = "broken"\npreset = "postwra"\n')
        run = self.districts('check', '--configs', configs, code=2)
        for told in ('berlin.toml:', 'leipzig.toml:'):
            self.assertIn(told, run.err)
        self.refused(blockrand('districts', 'show', SAMPLE, '--districts', wrong, '-o', self.path('never'), '--progress', 'none'),
                     2, 'wrong.toml:3', target=self.path('never'))
        self.refused(blockrand('districts', 'show', SAMPLE, '--districts', 'leipzg', '-o', self.path('never')), 1, 'leipzig')
        self.refused(blockrand('districts', 'paint'), 1, 'paint')

    def test_files_of_others_in_the_output_folder(self):
        out = self.path('shared')
        self.districts('show', SAMPLE, '-o', out)
        self.place('shared/notes.txt', 'mine')
        self.refused(blockrand('districts', 'show', SAMPLE, '-o', out, '--force'), 1, 'notes.txt', 'did not write')
        self.assertTrue(os.path.exists(os.path.join(out, 'notes.txt')))
        os.remove(os.path.join(out, 'notes.txt'))
        self.districts('show', SAMPLE, '-o', out, '--force')

    def test_show_and_diff_agree_with_a_build(self):
        rules = self.place('rules.toml', RULES)
        out = self.path('map')
        self.districts('show', SAMPLE, '--districts', rules, '-o', out)
        with open(os.path.join(out, 'map.png'), 'rb') as f:
            self.assertEqual(f.read(8), b'\x89PNG\r\n\x1a\n')
        told = read_json(out, 'districts.json')
        db = sqlite3.connect(os.path.join(out, 'districts.gpkg'))
        shown = dict(db.execute('select id, preset from districts'))
        self.assertEqual(told['buildings'], len(shown))
        self.assertEqual(sum(c['buildings'] for c in told['counts']), len(shown))
        self.assertEqual(set(shown.values()), {'postwar', 'slab'})
        built = sqlite3.connect(os.path.join(self.build(SAMPLE, 'built', '--districts', rules), 'buildings.gpkg'))
        rows = built.execute('select id, preset, preset_source from buildings').fetchall()
        self.assertTrue(rows)
        for identity, preset, source in rows:
            if identity in shown:
                self.assertEqual((preset, source), (shown[identity], 'district'), identity)
        # The same map again has the same bytes.
        again = self.path('map2')
        self.districts('show', SAMPLE, '--districts', rules, '-o', again, '-j', '1')
        for name in ('map.png', 'districts.gpkg', 'districts.json'):
            self.assertEqual(sha256(os.path.join(out, name)), sha256(os.path.join(again, name)), name)
        other = self.place('other.toml', RULES.replace('[200, 100000]', '[300, 100000]'))
        table = self.path('changes.csv')
        run = self.districts('diff', rules, other, SAMPLE, '-o', table)
        with open(table, encoding='utf-8', newline='') as f:
            changes = list(csv.DictReader(f))
        self.assertTrue(changes)
        self.assertIn(f'{len(changes)} of', run.out)
        for row in changes:
            self.assertEqual((row['preset_a'], row['preset_b']), ('slab', 'postwar'))
            self.assertEqual(shown[row['id']], 'slab')
        self.assertIn('0 of', self.districts('diff', rules, rules, SAMPLE).out)
        # What is ordered is stronger than both rule sets.
        first = changes[0]['id']
        orders = self.place('orders.toml', f'[{first}]\npreset = "detached"\n')
        ordered = self.path('ordered')
        self.districts('show', SAMPLE, '--districts', rules, '--overrides', orders, '-o', ordered)
        row = sqlite3.connect(os.path.join(ordered, 'districts.gpkg')).execute('select * from districts where id = ?', (first,)).fetchone()
        self.assertIn('detached', row)
        self.assertIn('override', row)
        run = self.districts('diff', rules, other, SAMPLE, '--overrides', orders)
        self.assertIn('1 of them in parameters only', run.out)
        self.assertIn('detached: ornament=0.5', run.out)

    def test_diff_is_that_of_two_shows_where_priors_differ(self):
        rules = '[[rule]]\nname = "all"\nlevel = "city"\npreset = "postwar"\n[[rule]]\nname = "old"\nwhich.style = "gruenderzeit"\npreset = "gz_plain"\n'
        sets, shown = [], []
        for i, share in enumerate((0.04, 0.94)):
            sets.append(self.place(f'prior{i}.toml', rules + f'[prior]\nstyle = {{ gruenderzeit = {share}, tenement = 0.02, modern = {0.96 - share}, other = 0.02 }}\n'))
            out = self.path(f'prior_map{i}')
            self.districts('show', SAMPLE, '--districts', sets[i], '-o', out)
            shown.append(dict(sqlite3.connect(os.path.join(out, 'districts.gpkg')).execute('select id, preset from districts')))
        differ = {k: (v, shown[1][k]) for k, v in shown[0].items() if v != shown[1][k]}
        self.assertTrue(differ)
        table = self.path('priors.csv')
        self.districts('diff', *sets, SAMPLE, '-o', table)
        with open(table, encoding='utf-8', newline='') as f:
            self.assertEqual({r['id']: (r['preset_a'], r['preset_b']) for r in csv.DictReader(f)}, differ)

    def test_rules_that_never_choose_are_told(self):
        idle = '[[rule]]\nname = "weak"\nwhich.area = [0, 100000]\npreset = "slab"\n[[rule]]\nname = "strong"\npriority = 1\nwhich.area = [0, 1000000]\npreset = "postwar"\n'
        out = self.path('idle')
        run = self.districts('show', SAMPLE, '--districts', self.place('idle.toml', idle), '-o', out)
        self.assertIn('idle: weak', run.out)
        self.assertEqual(read_json(out, 'districts.json')['idle_rules'], ['idle: weak'])

    def test_vector_files_are_inputs_and_missing_places_are_told(self):
        square = json.dumps({'type': 'FeatureCollection', 'features': [{'type': 'Feature', 'properties': {}, 'geometry': {
            'type': 'Polygon', 'coordinates': [[[-180, -80], [180, -80], [180, 80], [-180, 80], [-180, -80]]]}}]})
        area = self.place('area.geojson', square)
        rules = self.place('file.toml', RULES + '[[rule]]\nname = "f"\nwhere.polygon = "area.geojson"\npreset = "infill"\n'
                                                '[[rule]]\nname = "p"\npriority = 2\nwhere.place = "Nowhere upon Nothing"\npreset = "slab"\n')
        out = self.build(SAMPLE, 'filed', '--districts', rules)
        self.assertIn('Nowhere upon Nothing', type(self).last.err)
        inputs = {i['path']: i['sha256'] for i in read_json(out, 'build.json')['inputs']}
        self.assertEqual({v for k, v in inputs.items() if k.endswith('area.geojson')}, {sha256(area)})

    def test_a_diff_that_fails_leaves_the_old_table(self):
        rules = self.place('same.toml', RULES)
        table = self.place('old.csv', 'old\n')
        wrong = self.place('no.osm', 'nothing')
        self.districts('diff', rules, rules, wrong, '-o', table, '--force', code=2)
        with open(table, encoding='utf-8') as f:
            self.assertEqual(f.read(), 'old\n')
        self.assertEqual([n for n in os.listdir(os.path.dirname(table)) if '.part-' in n], [])
        run = self.districts('diff', rules, rules, wrong, '-o', self.path('none/table.csv'), code=4)
        self.assertIn('cannot be written', run.err)

    def test_a_height_tells_storeys(self):
        text = '<osm version="0.6">'
        for i in range(3):
            for n, (x, y) in enumerate(((0, 0), (2e-4, 0), (2e-4, 1e-4), (0, 1e-4))):
                text += f'<node id="{10 * i + n + 1}" version="1" lat="{51.3 + y:.7f}" lon="{12.3 + x + 1e-3 * i:.7f}"/>'
        for i, tags in enumerate((dict(height='18'), dict(height='3'), {'building:levels': '2', 'height': '18'})):
            refs = ''.join(f'<nd ref="{10 * i + n}"/>' for n in (1, 2, 3, 4, 1))
            text += f'<way id="{i + 1}" version="1">{refs}<tag k="building" v="apartments"/>'
            text += ''.join(f'<tag k="{k}" v="{v}"/>' for k, v in tags.items()) + '</way>'
        town = self.place('town.osm', text + '</osm>')
        rules = self.place('storeys.toml', '[[rule]]\nname = "high"\nwhich.storeys = [5.5, 6.5]\npreset = "slab"\n'
                                           '[[rule]]\nname = "low"\nwhich.storeys = [0, 1]\npreset = "detached"\n')
        out = self.path('storeys')
        self.districts('show', town, '--districts', rules, '-o', out)
        shown = dict(sqlite3.connect(os.path.join(out, 'districts.gpkg')).execute('select id, preset from districts'))
        self.assertEqual({k: v or '' for k, v in shown.items()}, {'w1': 'slab', 'w2': 'detached', 'w3': ''})

    def test_overrides_survive_a_rebuild(self):
        plain = self.build(SAMPLE, 'plain')
        db = sqlite3.connect(os.path.join(plain, 'buildings.gpkg'))
        identity, = db.execute("select id from buildings where state = 'modelled' and parts = 1 and id like 'w%' order by id limit 1").fetchone()
        orders = self.place('overrides.toml', f'[{identity}]\nstoreys = 7\nroof_shape = "flat"\nwall_colour = "#123456"\n'
                                              f'preset = "slab"\n[{identity}.storey.1]\nheight = 4.5\n[w1]\nstoreys = 2\n')
        first = self.build(SAMPLE, 'first', '--overrides', orders)
        self.assertIn('match nothing', type(self).last.err)
        second = self.build(SAMPLE, 'second', '--overrides', orders, '-j', '1')
        self.same_files(first, second)
        row = sqlite3.connect(os.path.join(first, 'buildings.gpkg')).execute(
            'select storeys, storeys_source, storeys_confidence, roof_shape, wall_colour, wall_colour_source, preset, preset_source '
            'from buildings where id = ?', (identity,)).fetchone()
        self.assertEqual(row, (7, 'override', 1, 'flat', '#123456', 'override', 'slab', 'override'))
        run = blockrand('explain', first, identity, '--all')
        self.assertEqual(run.code, 0, run)
        self.assertIn('overrides.toml:2', run.out)
        self.assertIn('storey 1 ordered height=4.5', ' '.join(run.out.split()))
        notices = [n for n in read_json(first, 'report.json')['notices'] if n['code'] == 'OVERRIDE_UNMATCHED']
        self.assertEqual(len(notices), 1, notices)
        self.assertIn('overrides.toml:8', json.dumps(notices))
        wrong = self.place('wrong.toml', '[w1]\nstoreys = "many"\n')
        self.refused(blockrand('build', SAMPLE, '-o', self.path('never'), '--overrides', wrong, '--progress', 'none'), 2, 'wrong.toml:2',
                     target=self.path('never'))

    def test_real_places(self):
        for name, rule_set in (('dortmund-innenstadt.osm.gz', 'germany_west'), ('berlin-mitte-2014.osm.pbf', 'berlin'),
                                ('prague-vinohrady.osm.gz', 'czechia'), ('piestany-2025.osm.gz', 'slovakia'),
                                ('ingolstadt-altstadt.osm', 'bavaria'), ('zuerich-niederdorf-2025.osm.pbf', 'switzerland'),
                                ('monaco-2021.osm.pbf', 'elsewhere')):
            with self.subTest(name):
                path = extract(name)
                if not path:
                    raise unittest.SkipTest(f'{name} is not here')
                out = self.path('real_' + rule_set)
                self.districts('show', path, '-o', out)
                told = read_json(out, 'districts.json')
                self.assertGreater(told['buildings'], 200)
                self.assertEqual(told['without_preset'], 0)
                self.assertEqual({c['rule_set'] for c in told['counts']}, {rule_set})
                self.assertGreater(len({c['preset'] for c in told['counts']}), 4)


if __name__ == '__main__':
    main()
