"""A region that is rebuilt every night: updates equal clean builds, gates hold back, nothing of others is touched."""
import contextlib
import json
import os
import random
import shutil
import sqlite3
import subprocess
import unittest

from blockrand_run import SAMPLE, Setup, blockrand, extract, files_of, hashes, main, read_json
from osm_files import Node, read_xml, town, write_xml
from region_run import LIMITS_OFF, Map, RegionTest, key


class Updates(RegionTest):
    def test_a_first_night_and_the_next_ones(self):
        folder = self.path('town')
        run = self.update(folder, SAMPLE)
        self.assertIn('build 1 is published', run.out)
        self.stands(folder, '000001')
        self.assertTrue(os.path.exists(os.path.join(folder, 'region.toml')))
        self.assertIn('up to date', self.update(folder, SAMPLE).out)
        map_ = Map(read_xml(SAMPLE))
        house = next(o for o in map_.ways('building') if 'building:levels' in o.tags)
        map_.edit(house, tags=dict(house.tags, **{'building:levels': '7'}))
        changes = map_.write_changes(self.path('one.osc.gz'))
        planned = self.update(folder, changes, '--dry-run').out
        self.assertIn('run 2 would build', planned)
        self.assertIn('mapped in 1', planned)
        self.assertIn('it should take about', planned)
        self.stands(folder, '000001')
        run = self.update(folder, changes)
        self.stands(folder, '000002')
        told = read_json(folder, 'log', '000002.changes.json')
        row = next(a for a in told['attributes'] if a['id'] == f'w{house.id}' and a['attribute'] == 'storeys')
        self.assertEqual((row['to'], row['to_source']), ('7', 'tag'))
        # The same for people and for a GIS; what servers must forget.
        with open(os.path.join(folder, 'log', '000002.changes.html'), encoding='utf-8') as f:
            self.assertIn(f'<title>w{house.id}: changed, storeys', f.read())
        with contextlib.closing(sqlite3.connect(os.path.join(folder, 'log', '000002.changes.gpkg'))) as layers:
            rows = dict(layers.execute('SELECT id, changed_values FROM buildings'))
            self.assertIn('\u2192 7', rows[f'w{house.id}'])
            self.assertEqual({r[0] for r in layers.execute('SELECT DISTINCT id FROM "values"')} - set(rows), set())
            self.assertEqual(layers.execute('SELECT count(*) FROM buildings WHERE geom IS NULL').fetchone(), (0,))
        first, second = (read_json(folder, 'builds', n, 'build.json')['files'] for n in ('000001', '000002'))
        self.assertEqual(told['files']['changed'], sorted(p for p in second if first.get(p) != second[p]))
        self.assertIn('up to date', self.update(folder, changes).out, 'a replay is no change')
        # Files that did not change are one on disk.
        first, second = (os.path.join(folder, 'builds', n) for n in ('000001', '000002'))
        same = [os.stat(os.path.join(first, p)).st_ino == os.stat(os.path.join(second, p)).st_ino for p in files_of(second)]
        self.assertTrue(any(same) and not all(same), same)
        status = json.loads(blockrand('status', folder, '--json').out)
        self.assertEqual((status['current'], status['published']), (2, [1, 2]))
        self.assertEqual(status['last_run']['state'], 'unchanged')

    def test_updates_equal_clean_builds(self):
        """Random edits, one night after the other: every file but run.json is that of a clean build."""
        rng = random.Random(5)
        folder, map_ = self.region('edited', LIMITS_OFF + '[region]\nkeep = 2\n'), Map(read_xml(SAMPLE))
        self.update(folder, map_.write(self.path('begin.osm')))
        for night in range(8):
            map_.random_edits(rng, rng.choice([1, 3, 20]))
            self.update(folder, map_.write_changes(self.path(f'night{night}.osc')))
            self.same_files(self.current(folder), self.clean(map_, folder))
        self.assertEqual(len(os.listdir(os.path.join(folder, 'builds'))), 2, 'keep = 2')
        # Another road to the same data: a full extract into a fresh region.
        other = self.region(os.path.join('other', 'edited'))
        self.update(other, map_.write(self.path('whole.osm')))
        self.same_files(self.current(folder), self.current(other))

    def test_facades_and_all_formats(self):
        rng = random.Random(9)
        options = ['--lod', '3']
        folder, map_ = self.region('facades', LIMITS_OFF + '[build]\nlod = 3\n'), Map(read_xml(SAMPLE))
        self.update(folder, map_.write(self.path('begin3.osm')))
        map_.random_edits(rng, 12)
        self.update(folder, map_.write_changes(self.path('night3.osc')))
        self.same_files(self.current(folder), self.clean(map_, folder, *options))
        self.assertEqual(blockrand('validate', self.current(folder)).code, 0)

    def test_a_real_quarter(self):
        source = extract('berlin-zionskirchplatz-2020.osm')
        if not source:
            self.skipTest('the shared data is absent')
        rng = random.Random(3)
        folder, map_ = self.region('zion', LIMITS_OFF), Map(read_xml(source))
        self.update(folder, map_.write(self.path('zion.osm')))
        map_.random_edits(rng, 30)
        self.update(folder, map_.write_changes(self.path('zion.osc')))
        self.same_files(self.current(folder), self.clean(map_, folder))

    def test_a_replication_folder(self):
        map_, server = Map(read_xml(SAMPLE)), self.path('server')

        def offer(number):
            place = os.path.join(server, '000', f'{number // 1000:03}')
            os.makedirs(place, exist_ok=True)
            map_.random_edits(random.Random(number), 2)
            map_.write_changes(os.path.join(place, f'{number % 1000:03}.osc.gz'))
            for path in (os.path.join(place, f'{number % 1000:03}.state.txt'), os.path.join(server, 'state.txt')):
                with open(path, 'w', encoding='utf-8') as f:
                    f.write(f'#Thu\nsequenceNumber={number}\ntimestamp=2026-11-{number - 4120:02}T20\\:21\\:22Z\n')
        offer(4123)
        folder = self.region('nightly', LIMITS_OFF + '[region]\nreplication = "../server"\nfirst_sequence = 4123\n')
        run = blockrand('update', folder)
        self.refused(run, 1, 'no data yet')
        begin = write_xml(self.path('begin_r.osm'), read_xml(SAMPLE))
        self.update(folder, begin)
        self.update(folder)
        self.assertEqual(read_json(folder, 'store', '000002.json')['sequence'], 4123)
        self.assertIn('up to date', self.update(folder).out)
        for number in (4124, 4125, 4126):  # a missed week
            offer(number)
        self.assertIn('wait: 3', blockrand('status', folder).out)
        self.update(folder)
        self.assertEqual(read_json(folder, 'store', '000003.json')['sequence'], 4126)
        self.same_files(self.current(folder), self.clean(map_, folder))
        with open(os.path.join(server, 'state.txt'), 'r+', encoding='utf-8') as f:
            text = f.read()
            f.seek(0), f.truncate(), f.write(text.replace('4126', '41'))
        self.refused(blockrand('update', folder), 2, 'is behind')
        offer(4127), offer(4128)
        os.remove(os.path.join(server, '000', '004', '127.osc.gz'))
        run = self.update(folder, code=2)
        self.refused(run, 2, 'sequence 4127', '127.osc.gz')
        self.stands(folder, '000003')
        self.assertIn('the next run will fail', blockrand('status', folder).out)


class Gates(RegionTest):
    def test_a_vandalised_map_is_not_published(self):
        folder, map_ = self.region('guarded', ''), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        before = hashes(self.current(folder))
        for house in map_.ways('building')[::2]:
            map_.delete(house)
        run = self.update(folder, map_.write_changes(self.path('vandal.osc')), code=5)
        self.assertIn('max_lost', run.out)
        self.stands(folder, '000001')
        self.assertEqual(hashes(self.current(folder)), before)
        told = read_json(folder, 'log', '000002.changes.json')
        self.assertIn('max_lost', [g['gate'] for g in told['gates'] if g['exceeded']])
        self.assertTrue(os.path.exists(os.path.join(folder, 'builds', '000002.refused', 'build.json')))
        self.assertEqual(sorted(os.listdir(os.path.join(folder, 'store'))), ['000001.json', '000001.osm.pbf', '000001.toml'])
        self.assertFalse(os.path.exists(os.path.join(folder, 'builds', '000002')))

    def test_each_limit(self):
        begin = Map(read_xml(SAMPLE))
        folder = self.region('limits', '')
        self.update(folder, begin.write(self.path('limits.osm')))

        def night(name, edit):
            map_ = Map(read_xml(self.path('limits.osm')))
            edit(map_)
            run = self.update(folder, map_.write_changes(self.path(name + '.osc')), code=5)
            self.assertIn(name, run.out)
            self.stands(folder, '000001')

        def grow(map_):
            for o in town(100, lon=11.02, lat=51.46):
                map_.put(o)

        def raise_(map_):
            for house in map_.ways('building'):
                map_.edit(house, tags=dict(house.tags, height='60'))

        def spoil(map_):
            for house in map_.ways('building')[:40]:
                map_.edit(house, refs=house.refs[:2])
        night('max_added', grow)
        night('max_height_change', raise_)
        night('max_lost', lambda m: [m.delete(h) for h in m.ways('building')[:12]])
        night('max_simpler', spoil)
        # Nothing left at all.
        empty = write_xml(self.path('empty.osm'), [Node(1, 11, 51)])
        self.assertIn('no_buildings', self.update(folder, empty, code=5).out)
        self.stands(folder, '000001')

    def test_a_first_build_without_buildings_is_not_published(self):
        folder = self.region('nothing', '')
        self.update(folder, write_xml(self.path('empty2.osm'), [Node(1, 11, 51)]), code=5)
        self.assertFalse(os.path.lexists(os.path.join(folder, 'current')))

    def test_a_slow_drift_is_held_against_a_baseline(self):
        settings = '[gates]\nmax_lost = 20\nmax_simpler = 1000\nmax_height_change = 1000\nbaseline = 1\nmax_drift = 15\n[region]\nkeep = 1\n'
        folder, map_ = self.region('drift', settings), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        for night, code in ((0, 0), (1, 5)):
            for house in map_.ways('building')[:14]:
                map_.delete(house)
            run = self.update(folder, map_.write_changes(self.path(f'drift{night}.osc')), code=code)
        self.assertIn('max_drift', run.out)
        self.assertIn('against build 1', run.out)
        self.stands(folder, '000002')
        self.assertTrue(os.path.isdir(os.path.join(folder, 'builds', '000001')), 'the baseline stays')
        with open(os.path.join(folder, 'region.toml'), 'a', encoding='utf-8') as f:
            f.write('first_sequence = 5\n')
        shutil.rmtree(os.path.join(folder, 'builds', '000001'))
        self.refused(blockrand('update', folder, self.path('drift1.osc')), 2, 'no build 1', 'baseline')

    def test_a_reference_is_asked(self):
        reference = self.build(SAMPLE, 'handmade')
        settings = LIMITS_OFF + f'reference = "{reference}"\nmax_worse = 5\n'
        folder, map_ = self.region('measured', settings), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        self.assertTrue(os.path.exists(os.path.join(folder, 'store', '000001.compare.json')))
        house = map_.ways('building')[0]
        map_.edit(house, tags=dict(house.tags, colour='red'))
        self.update(folder, map_.write_changes(self.path('harmless.osc')))
        self.stands(folder, '000002')
        for house in map_.ways('building')[:40]:
            map_.edit(house, tags=dict(house.tags, height='40'))
        run = self.update(folder, map_.write_changes(self.path('harmful.osc')), code=5)
        self.assertIn('against the reference', run.out)
        self.stands(folder, '000002')

    def test_settings_that_differ_are_told(self):
        folder = self.region('told', LIMITS_OFF)
        self.update(folder, SAMPLE)
        with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
            f.write('[build]\nlod = 1\n' + LIMITS_OFF)
        self.update(folder)
        self.assertEqual(read_json(folder, 'log', '000002.changes.json')['settings'], {'removed': ['lod = 2'], 'added': ['lod = 1']})

    def test_an_edited_rule_file_beside_a_rule_set_is_noticed(self):
        def wall(width):
            return self.place('beside.cga', f'''version "2025.1"
@StartRule
Facade --> case scope.sx < 3 || scope.sy < 4 : Wall. else : split(x){{ ~1 : Wall. | {width} : split(y){{ 1 : Wall. | 1.5 : Pane | ~1 : Wall. }} | ~1 : Wall. }}
Pane --> blockrand.window("casement_window")
''')
        wall(1.2)
        rules = self.place('beside.toml', '''title = "Beside"
[presets.beside]
description = "A preset of a test"
class = "gruenderzeit"
grammar = "beside.cga"
roof_grammar = ""
[[rule]]
name = "all"
level = "city"
preset = "beside"
''')
        folder = self.region('beside', f'[build]\nlod = 3\nformats = "gltf"\ndistricts = "{rules}"\n' + LIMITS_OFF)
        self.update(folder, SAMPLE)
        first = self.current(folder)
        self.update(folder)
        self.assertEqual(self.current(folder), first, 'nothing changed')
        wall(0.8)
        self.update(folder)
        self.assertNotEqual(self.current(folder), first)

    def test_a_hook_is_called_whatever_happens(self):
        told = self.path('told.txt')
        folder = self.region('hooked', f'[region]\nhook = "echo $BLOCKRAND_STATE $BLOCKRAND_BUILD >> {told}; exit 3"\n')
        run = self.update(folder, SAMPLE)
        self.assertIn('exit code 3', run.err)
        self.update(folder, SAMPLE)
        self.update(folder, write_xml(self.path('empty3.osm'), [Node(1, 11, 51)]), code=5)
        self.assertEqual(blockrand('update', folder, self.path('absent.osc')).code, 2)
        with open(told, encoding='utf-8') as f:
            lines = [line.split() for line in f]
        self.assertEqual([state for state, _ in lines], ['published', 'unchanged', 'refused', 'failed'])
        self.assertEqual(os.path.realpath(lines[0][1]), self.current(folder))

    def test_rollback(self):
        folder, map_ = self.region('back'), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        self.refused(blockrand('rollback', folder), 1, 'no earlier build')
        for night in range(2):
            map_.random_edits(random.Random(night), 2)
            self.update(folder, map_.write_changes(self.path(f'back{night}.osc')))
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.stands(folder, '000002')
        self.refused(blockrand('rollback', folder, '--to', '9'), 1, 'no build 9', '1, 2, 3')
        self.assertEqual(blockrand('rollback', folder, '--to', '1').code, 0)
        self.stands(folder, '000001')
        # What was left out comes again.
        for night in range(2):
            self.update(folder, self.path(f'back{night}.osc'))
        self.same_files(self.current(folder), os.path.join(folder, 'builds', '000003'))


class Care(RegionTest):
    """What is somebody else's stays; what was once done is not undone by chance."""

    def test_foreign_files_stay(self):
        folder = self.region('shared')
        self.update(folder, SAMPLE)
        kept = [os.path.join(folder, *p) for p in (('builds', '202411', 'thesis.txt'), ('builds', 'mine.refused', 'x'), ('builds', '.notes.part-x'),
                                                   ('store', '202411.csv'), ('store', 'readme'), ('log', 'mine.txt'), ('notes.txt',))]
        for path in kept:
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, 'w', encoding='utf-8') as f:
                f.write('mine')
        map_ = Map(read_xml(SAMPLE))
        map_.edit(map_.ways('building')[0], tags={'building': 'yes', 'height': '9'})
        for house in map_.ways('building')[1:]:
            map_.edit(house, tags=dict(house.tags, note='x'))
        self.update(folder, map_.write_changes(self.path('f.osc')))
        self.assertEqual([p for p in kept if not os.path.exists(p)], [])
        # Nor is a folder a region for its names.
        other = self.path('project')
        os.makedirs(os.path.join(other, 'builds', '202411'))
        os.makedirs(os.path.join(other, 'store'))
        self.refused(blockrand('update', other, SAMPLE), 1, 'not empty')
        self.assertTrue(os.path.isdir(os.path.join(other, 'builds', '202411')))

    def test_the_log_may_be_cleared(self):
        folder, map_ = self.region('log'), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        for night in range(2):
            map_.random_edits(random.Random(night), 1)
            self.update(folder, map_.write_changes(self.path(f'l{night}.osc')))
            shutil.rmtree(os.path.join(folder, 'log'))
        self.assertEqual(json.loads(blockrand('status', folder, '--json').out)['published'], [1, 2, 3])
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.stands(folder, '000002')

    def test_what_was_deleted_does_not_come_back(self):
        folder, map_ = self.region('deleted'), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        house = map_.ways('building')[3]
        map_.edit(house, tags=dict(house.tags, height='9'))
        monday = map_.write_changes(self.path('monday.osc'))
        map_.delete(map_.objects[key(house)])
        tuesday = map_.write_changes(self.path('tuesday.osc'))
        for changes in (monday, tuesday, monday):
            self.update(folder, changes)
        self.same_files(self.current(folder), self.clean(map_, folder))

    def test_a_polygon(self):
        """Data are cut to the region's polygon as they come in: the builds are those of an extract that was cut alike."""
        west, south, east, north = 11.0025, 51.4999, 11.0275, 51.5022  # through houses of the town
        ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
        self.place('area.geojson', json.dumps({'type': 'FeatureCollection', 'features': [
            {'type': 'Feature', 'properties': {}, 'geometry': {'type': 'Polygon', 'coordinates': [ring]}}]}))
        self.place('area.poly', 'area\n1\n' + ''.join(f'  {x:.7E}  {y:.7E}\n' for x, y in ring) + 'END\nEND\n')

        def inside(lon, lat):
            return west < lon < east and south < lat < north
        def same(a, b):
            first, second = ({p: h for p, h in hashes(f).items() if os.path.basename(p) != 'run.json'} for f in (a, b))
            self.assertEqual(sorted(p for p in first | second if first.get(p) != second.get(p)), [])
        for name, areas in (('area.geojson', ''), ('area.poly', 'areas = 14\n')):
            with self.subTest(name):
                whole, rng = Map(town(1200)), random.Random(11)
                folder = self.region('cut', LIMITS_OFF + f'[region]\npolygon = "../{name}"\n[build]\nlod = 1\nreport = false\n{areas}')
                self.update(folder, whole.write(self.path('whole.osm')))
                options = ['--lod', '1', '--no-report', *(['--areas', '14'] if areas else [])]
                same(self.current(folder), self.clean(whole.clipped(inside), folder, *options))
                crs = ['--crs', read_json(self.current(folder), 'build.json')['crs']['code']]
                for night in range(4):
                    for house in rng.sample(whole.ways('building'), 40):
                        corners = [whole.objects[(0, r)] for r in house.refs[:-1]]
                        step = rng.choice((0, 2e-5, -8e-5, 1e-4))
                        if rng.random() < 0.1:
                            for o in (house, *corners):
                                whole.delete(o)
                            continue
                        for n in corners:  # with the house itself: else one that enters would be unknown
                            whole.edit(n, lon=n.lon + step, lat=n.lat - step)
                        whole.edit(house, tags=dict(house.tags, height=str(rng.randrange(3, 20))))
                    # Beyond the polygon, and over its border.
                    far = next(o for o in whole.ways('building') if not inside(*[getattr(whole.objects[(0, o.refs[0])], c) for c in ('lon', 'lat')]))
                    whole.edit(far, tags=dict(far.tags, **{'building:levels': str(3 + night)}))
                    run = self.update(folder, whole.write_changes(self.path(f'p{night}.osc')))
                    self.assertIn('outside of the polygon', run.out)
                    same(self.current(folder), self.clean(whole.clipped(inside), folder, *options, *crs))

                # A night in which a house leaves and nothing else happens; an older change that comes late brings it not back.
                house = next(o for o in whole.ways('building') if all(inside(whole.objects[(0, r)].lon, whole.objects[(0, r)].lat) for r in o.refs))
                corners = [whole.objects[(0, r)] for r in house.refs[:-1]]
                late = Map(whole.objects.values())
                for n in corners:
                    whole.edit(n, lon=n.lon + 1)
                whole.edit(house, tags=house.tags)
                self.assertIn('is published', self.update(folder, whole.write_changes(self.path('leaves.osc'))).out)
                same(self.current(folder), self.clean(whole.clipped(inside), folder, *options, *crs))
                late.changes = [('modify', o) for o in (house, *corners)]
                self.assertIn('nothing to build', self.update(folder, late.write_changes(self.path('late.osc'))).out)

                # A house grows into it by nodes that were outside, and that its change does not bring.
                house = next(o for o in reversed(whole.ways('building')) if (0, o.refs[0]) in whole.objects
                             and not inside(whole.objects[(0, o.refs[0])].lon, whole.objects[(0, o.refs[0])].lat))
                node = whole.objects[(0, house.refs[1])]
                whole.edit(node, lon=(west + east) / 2, lat=(south + north) / 2)
                whole.edit(house, tags=dict(house.tags, name='late'))
                self.update(folder, whole.write_changes(self.path('late.osc')))
                explained = blockrand('explain', self.current(folder), f'w{house.id}', '--all')
                self.assertIn('OUTLINE_INCOMPLETE', explained.out + explained.err)
                self.update(folder, whole.write(self.path('whole.osm')))
                same(self.current(folder), self.clean(whole.clipped(inside), folder, *options, *crs))
        for text, word in (('a\n1\n 1 1\n', 'area.poly'), ('', 'area.poly')):
            self.place('area.poly', text)
            run = self.update(folder, self.path('whole.osm'), code=2)
            self.assertIn(word, run.err)
        self.assertIn('below [region]', self.update(folder, '--polygon', self.path('area.geojson'), code=1).err)
        self.assertIn('below [region]', self.update(self.path('none_yet'), self.path('whole.osm'), '--polygon', self.path('area.geojson'), code=1).err)
        self.assertFalse(os.path.exists(self.path('none_yet')))
        os.remove(self.path('area.poly'))
        self.assertIn('area.poly', self.update(folder, self.path('whole.osm'), code=2).err)

    def test_what_was_published_before_stays(self):
        folder, map_ = self.region('held', LIMITS_OFF + '[region]\nkeep = 2\n'), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        for night in range(1):
            map_.random_edits(random.Random(night), 1)
            self.update(folder, map_.write_changes(self.path('h.osc')))
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.update(folder, self.path('h.osc'))
        self.stands(folder, '000003')
        self.hashes_match(os.path.join(folder, 'builds', '000001'))
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.stands(folder, '000001')

    def test_the_input_of_the_settings_does_not_undo_changes(self):
        begin = self.path('begin_i.osm')
        shutil.copy(SAMPLE, begin)
        folder, map_ = self.region('input', LIMITS_OFF + f'[build]\ninput = "{begin}"\n'), Map(read_xml(SAMPLE))
        self.update(folder)
        map_.random_edits(random.Random(8), 2)
        self.update(folder, map_.write_changes(self.path('i.osc')))
        self.assertIn('up to date', self.update(folder).out)
        self.stands(folder, '000002')
        map_.random_edits(random.Random(9), 2)
        map_.write(begin)
        self.update(folder)
        self.stands(folder, '000003')

    def test_a_damaged_published_build_is_replaced(self):
        folder, map_ = self.region('broken', ''), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        records = os.path.join(self.current(folder), 'explain')
        for victim in (os.path.join(records, n) for n in os.listdir(records) if n.endswith('.gz')):
            with open(victim, 'r+b') as f:
                f.truncate(100)
        map_.edit(map_.ways('building')[0], tags={'building': 'yes'})
        self.assertIn('compared by its number', self.update(folder, map_.write_changes(self.path('b.osc'))).err)
        self.stands(folder, '000002')
        # Without its record it is none: the way out is to go back, or to say so.
        os.remove(os.path.join(self.current(folder), 'build.json'))
        self.refused(blockrand('update', folder, SAMPLE), 2, 'rollback')
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.assertEqual(os.path.basename(self.current(folder)), '000001')

    def test_failures_are_on_record(self):
        folder = self.region('record')
        self.update(folder, SAMPLE)
        self.refused(blockrand('update', folder, self.path('absent.osc')), 2, 'no such file')
        last = json.loads(blockrand('status', folder, '--json').out)['last_run']
        self.assertEqual(last['state'], 'failed')
        self.assertIn('absent.osc', last['error'])

    def test_pointers_that_are_none(self):
        folder = self.region('copied')
        self.update(folder, SAMPLE)
        current = os.path.join(folder, 'current')
        build = self.current(folder)
        os.remove(current)
        self.assertIn('was missing', self.update(folder, SAMPLE).err)  # as after a kill between gates and switch
        self.stands(folder, '000001')
        map_ = Map(read_xml(SAMPLE))
        map_.random_edits(random.Random(2), 1)
        self.update(folder, map_.write_changes(self.path('p.osc')))
        os.remove(current)
        self.refused(blockrand('update', folder, SAMPLE), 2, 'rollback')
        shutil.copytree(build, current)
        self.refused(blockrand('update', folder, SAMPLE), 2, 'no link')
        shutil.rmtree(current)
        self.assertEqual(blockrand('rollback', folder, '--to', '1').code, 0)
        self.stands(folder, '000001')
        os.remove(os.path.join(folder, 'region.toml'))
        self.refused(blockrand('update', folder, SAMPLE), 1, 'region.toml is missing')

    def test_names(self):
        folder = self.region('named')
        self.assertEqual(blockrand('update', '.', SAMPLE, cwd=folder).code, 0)
        with open(os.path.join(self.current(folder), 'report.html'), encoding='utf-8') as f:
            self.assertIn('<h1>named</h1>', f.read())
        odd = os.path.join(self.folder.encode(), b'm\xfcn.osm')
        with open(SAMPLE, 'rb') as f, open(odd, 'wb') as g:
            g.write(f.read().replace(b'building:levels" v="4"', b'building:levels" v="5"', 1))
        run = subprocess.run([Setup.program.encode(), b'update', folder.encode(), odd, b'-q'], capture_output=True)
        self.assertEqual(run.returncode, 0, run)
        self.stands(folder, '000002')


if __name__ == '__main__':
    main()
