"""A build in areas: every tile is that of a build at once, whoever builds it and however often it was broken off."""
import glob
import json
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import time

from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, extract, hashes, main, read_json, stray_siblings
from osm_files import METRE, Node, Relation, Way, house, read_xml, ring, town, write_xml
from region_run import LIMITS_OFF, Map, RegionTest

LEVEL = '14'
QUICK = ('--jobs', '2', '--lod', '1', '--formats', 'gltf,cityjson', '--no-report')
OF_TILES = ('tiles', 'citygml', 'cityjson', 'explain')


def areas(folder):
    return sorted(os.path.relpath(p, os.path.join(folder, 'areas')) for p in glob.glob(os.path.join(folder, 'areas', '*', '*', '*')))


def tile_files(folder):
    return {p: h for p, h in hashes(folder, *OF_TILES).items() if p not in ('explain/index.txt', 'explain/places.tsv')}


def in_areas(folder):
    """The files of tiles of all areas, each once."""
    out = {}
    for area in areas(folder):
        for path, digest in tile_files(os.path.join(folder, 'areas', area)).items():
            assert path not in out, path + ' is in two areas'
            out[path] = digest
    return out


def without_runs(files):
    return {p: h for p, h in files.items() if os.path.basename(p) != 'run.json'}


def workers(run):
    """The processes that RUN has started and that have not ended."""
    found = []
    for stat in glob.glob('/proc/[0-9]*/stat'):
        try:
            with open(stat, encoding='utf-8', errors='replace') as file:
                state, parent = file.read().rpartition(')')[2].split()[:2]
        except OSError:
            continue
        if int(parent) == run.pid and state not in 'ZX':
            found.append(int(stat.split('/')[2]))
    return found


def wait_for_a_worker(run):
    """Returns when RUN has a worker, or has ended."""
    while not workers(run) and run.poll() is None:
        time.sleep(0.01)


class Areas(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.town = write_xml(os.path.join(cls.folder, 'town.osm'), town(1200))

    def same_build(self, a, b):
        first, second = (without_runs(hashes(f)) for f in (a, b))
        self.assertTrue(first)
        self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])

    def test_the_tiles_are_those_of_a_build_at_once(self):
        for source, options in ((SAMPLE, ('--lod', '3', '--precompress')), (self.town, ('--lod', '2', '--gzip')), (SAMPLE, ('--compress', 'none', '--lod', '1'))):
            with self.subTest(options):
                at_once = self.build(source, 'once', *options, '--force', '--allow-shrink', '100')
                divided = self.build(source, 'divided', *options, '--areas', LEVEL, '--force', '--allow-shrink', '100')
                self.assertGreater(len(areas(divided)), 1)
                whole, parts = tile_files(at_once), in_areas(divided)
                self.assertEqual(whole, parts)
                one, all_ = read_json(at_once, 'build.json'), read_json(divided, 'build.json')
                for key in ('buildings_in', 'parts_in', 'models', 'represented', 'reported', 'bodies', 'windows', 'doors', 'missing_nodes'):
                    self.assertEqual(one['counts'][key], all_['counts'][key], key)
                self.assertEqual(one['issues'], all_['issues'])
                self.assertEqual(one['data_time'], all_['data_time'])
                self.assertEqual(one['crs']['code'], all_['crs']['code'])
                self.assertEqual(one['region'], all_['region'])
                sound = blockrand('validate', divided, '--extract', source)
                self.assertEqual(sound.code, 0, sound)

    def test_real_places(self):
        """Blocks, rows and relations across the borders of areas: what is told of them is what a build at once tells."""
        for name, level, lod in (('monaco-2021.osm.pbf', '12', '1'), ('limerick-2026.osm.gz', '14', '1')):
            source = extract(name)
            if source is None:
                self.skipTest('the shared data is absent')
            with self.subTest(name):
                at_once = self.build(source, 'real_once', '--lod', lod, '--force', '--allow-shrink', '100')
                divided = self.build(source, 'real_divided', '--lod', lod, '--force', '--allow-shrink', '100', '--areas', level)
                self.assertGreater(len(areas(divided)), 1)
                self.assertEqual(tile_files(at_once), in_areas(divided))
                one, all_ = read_json(at_once, 'build.json'), read_json(divided, 'build.json')
                self.assertEqual(one['issues'], all_['issues'])
                for key, count in all_['counts'].items():
                    self.assertEqual(one['counts'][key], count, key)
                for key, value in one['statistics'].items():
                    if isinstance(value, (int, float)):
                        self.assertAlmostEqual(all_['statistics'][key], value, delta=0.2 if isinstance(value, float) else 0, msg=key)
                sound = blockrand('validate', divided, '--extract', source)
                self.assertEqual(sound.code, 0, sound)
                if shutil.which('ogrinfo'):
                    layer = subprocess.run(['ogrinfo', '-so', '-ro', os.path.join(divided, 'buildings.vrt'), 'buildings'], capture_output=True, text=True, check=True)
                    self.assertIn(f'Feature Count: {all_["counts"]["buildings"]}', layer.stdout)
                    self.assertEqual(layer.stderr.count('ERROR'), 0, layer.stderr)

    def test_an_object_that_another_area_stands_for(self):
        """An outline that is covered by two houses, of which one lies in the next area."""
        size = 180 / 2 ** int(LEVEL)
        border, south = -180 + round((11 + 180) / size) * size, 51.5

        def plan(number, west, east):
            corners = [(border + x * METRE * 1.6, south + y * METRE) for x, y in ((west, 0), (east, 0), (east, 15), (west, 15))]
            return ring(500000 + 100 * number, 7000 + number, corners, {'building': 'yes'})
        objects = [o for i in range(10) for o in house(i, border + (i - 5) * 40 * METRE * 1.6, south + 60 * METRE, stretch=1.6)]
        objects += plan(0, -20, 19.6) + plan(1, -5, 19.6) + plan(2, -20, -5)
        source = write_xml(self.path('cover.osm'), sorted(objects, key=lambda o: (isinstance(o, Way), o.id)))
        at_once = self.build(source, 'cover_once', *QUICK)
        divided = self.build(source, 'cover_divided', *QUICK, '--areas', LEVEL)
        one, all_ = read_json(at_once, 'build.json'), read_json(divided, 'build.json')
        self.assertEqual((one['counts']['represented'], len(areas(divided))), (1, 2))
        self.assertEqual({k: one['counts'][k] for k in all_['counts']}, all_['counts'])
        self.assertEqual(one['issues'], all_['issues'])

    def test_whoever_builds_an_area(self):
        divided = self.build(self.town, 'all', *QUICK, '--areas', LEVEL)
        for other in (('--jobs', '1'), ('--jobs', '2', '--memory-limit', '8000000000')):
            again = self.build(self.town, 'again', *QUICK, '--areas', LEVEL, '--force', *other)
            self.same_build(divided, again)
        self.assertEqual(read_json(again, 'run.json')['areas']['at_once'], 2)
        for n, area in enumerate(areas(divided)):
            alone = self.build(self.town, f'alone{n}', *QUICK, '--area', area, '--pinned', os.path.join(divided, 'build.json'))
            self.same_build(os.path.join(divided, 'areas', area), alone)

    def test_objects_in_any_order(self):
        objects = read_xml(self.town)
        random.Random(4).shuffle(objects)
        divided = self.build(self.town, 'sorted', *QUICK, '--areas', LEVEL)
        os.makedirs(self.path('shuffled'))  # pages bear the name of the file
        shuffled = self.build(write_xml(self.path('shuffled', 'town.osm'), objects), 'unsorted', *QUICK, '--areas', LEVEL)
        self.same_build(divided, shuffled)

    def test_nothing_is_lost_that_has_no_place(self):
        objects = read_xml(self.town)
        number = max(o.id for o in objects) + 1
        objects.append(Way(number, [number + 5, number + 6, number + 7], {'building': 'yes'}))
        source = write_xml(self.path('lost.osm'), objects)
        at_once = self.build(source, 'lost_once', *QUICK)
        divided = self.build(source, 'lost_divided', *QUICK, '--areas', LEVEL)
        self.assertEqual(read_json(at_once, 'build.json')['issues'], read_json(divided, 'build.json')['issues'])
        told = blockrand('explain', divided, f'w{number}', '--all')
        self.assertEqual(told.code, 0, told)
        self.assertIn('OPEN_WAY', told.out + told.err)
        orders = self.place('lost.toml', f'[w{number}]\nstoreys = 3\n')
        self.build(source, 'lost_ordered', *QUICK, '--areas', LEVEL, '--overrides', orders)
        self.assertIn('it is not built: OPEN_WAY', self.last.err)

    def test_explain_finds_every_house(self):
        divided = self.build(self.town, 'explained', *QUICK, '--areas', LEVEL)
        ids = []
        for area in areas(divided):
            with open(os.path.join(divided, 'areas', area, 'explain', 'index.txt'), encoding='utf-8') as f:
                ids.append(f.readline().split()[0])
        for id_ in ids:
            self.assertEqual(blockrand('explain', divided, id_).code, 0)
        places = []
        for area in areas(divided):
            with open(os.path.join(divided, 'areas', area, 'explain', 'places.tsv'), encoding='utf-8', newline='') as f:
                places += f.readlines()
        at_once = self.build(self.town, 'explained_once', *QUICK)
        with open(os.path.join(at_once, 'explain', 'places.tsv'), encoding='utf-8', newline='') as f:
            self.assertEqual(sorted(places), sorted(f.readlines()))
        self.assertIn('no building is mapped', blockrand('explain', divided, 'Nowhere Street 5').err)
        self.assertNotEqual(blockrand('explain', divided, 'w999999999').code, 0)

    def test_orders_that_match_nothing_are_told(self):
        orders = self.place('orders.toml', '[w999999999]\nstoreys = 3\n')
        divided = self.build(self.town, 'orders', *QUICK, '--areas', LEVEL, '--overrides', orders)
        self.assertIn('w999999999', self.last.err)
        self.assertEqual(len(read_json(divided, 'report.json')['overrides_unmatched']), 1)

    def test_places_that_are_nowhere_are_told(self):
        """A name that one area has is not asked for in vain, though others do not have it."""
        objects = town(1200)
        objects.insert(0, Node(7, objects[0].lon, objects[0].lat, {'place': 'suburb', 'name': 'Firstham'}))
        source = write_xml(self.path('named.osm'), objects)
        rule = '[[rule]]\nname = "{0}"\npriority = {1}\nwhere.place = "{0}"\nwhere.radius = 300\npreset = "slab"\n'
        rules = self.place('places.toml', 'title = "Two"\n[[rule]]\nname = "all"\nlevel = "city"\npreset = "postwar"\n' +
                           rule.format('Firstham', 2) + rule.format('Lastham', 3))
        self.build(source, 'named_once', *QUICK, '--districts', rules)
        told = [line for line in self.last.err.splitlines() if 'nothing here is' in line]
        self.assertEqual(len(told), 1, told)
        self.assertIn('Lastham', told[0])
        self.build(source, 'named', *QUICK, '--districts', rules, '--areas', LEVEL)
        self.assertEqual([line for line in self.last.err.splitlines() if 'nothing here is' in line], told)

    def test_what_contradicts_is_refused(self):
        divided = self.build(self.town, 'usage', *QUICK, '--areas', LEVEL)
        target, pinned = self.path('none'), os.path.join(divided, 'build.json')
        self.refused(blockrand('build', self.town, '-o', target, '--areas', '12', '--bbox', '1,1,2,2'), 1, '--bbox', target=target)
        self.refused(blockrand('build', self.town, '-o', target, '--area', '14/1/1'), 1, '--pinned', target=target)
        self.refused(blockrand('build', self.town, '-o', target, '--area', '14/1/1', '--pinned', pinned, *QUICK), 2, 'has no area', target=target)
        self.refused(blockrand('build', self.town, '-o', target, '--area', 'here', '--pinned', pinned, *QUICK), 1, 'is no tile', target=target)
        self.refused(blockrand('build', self.town, '-o', target, '--areas', '15'), 1, '--areas', target=target)
        self.refused(blockrand('build', self.town, '-o', target, '--areas', '12', '--single-glb'), 1, '--single-glb', target=target)
        self.refused(blockrand('build', self.town, '-o', target, '--memory-limit', '1000'), 1, '--memory-limit', target=target)

    def test_files_of_others_stay(self):
        divided = self.build(self.town, 'foreign', *QUICK, '--areas', LEVEL)
        area = areas(divided)[0]
        with open(os.path.join(divided, 'areas', area, 'notes.txt'), 'w', encoding='utf-8') as f:
            f.write('mine')
        again = blockrand('build', self.town, '-o', divided, *QUICK, '--areas', LEVEL, '--force')
        self.assertEqual(again.code, 1, again)
        self.assertIn('notes.txt', again.err)

    def test_damage_is_found(self):
        divided = self.build(self.town, 'damage', *QUICK, '--areas', LEVEL)
        area = os.path.join(divided, 'areas', areas(divided)[-1])
        with open(os.path.join(area, 'build.json'), 'a', encoding='utf-8') as f:
            f.write(' ')
        with open(os.path.join(divided, 'tileset.json'), encoding='utf-8') as f:
            tileset = f.read()
        with open(os.path.join(divided, 'tileset.json'), 'w', encoding='utf-8') as f:
            f.write(tileset.replace('areas/', 'ares/', 1))
        found = blockrand('validate', divided)
        self.assertEqual(found.code, 2, found)
        for code in ('FILE_CHANGED', 'TILE_MISSING', 'TILESET_RULE'):
            self.assertIn(code, found.out)
        shutil.rmtree(area)
        self.assertIn('FILE_MISSING', blockrand('validate', divided).out)

    def test_documents_of_another_form(self):
        """What has another type than it should, or is nested without end, is a finding."""
        divided = self.build(self.town, 'form', *QUICK, '--areas', LEVEL)
        area = areas(divided)[0]

        def deep(j):
            for _ in range(3000):
                j = {'boundingVolume': j['boundingVolume'], 'geometricError': 1, 'children': [j]}
            return j
        cases = (('build.json', lambda j: j['areas'].update({area: 5})), ('build.json', lambda j: j['areas'][area].update(build_sha256=5)),
                 ('build.json', lambda j: j.update(counts='many')), ('build.json', lambda j: j.update(files={'tileset.json': 7})),
                 ('tileset.json', lambda j: j['root'].update(geometricError='x')), ('tileset.json', lambda j: j['root'].update(children=3)),
                 ('tileset.json', lambda j: j['root']['boundingVolume'].update(region=list('abcdef'))),
                 ('tileset.json', lambda j: j.update(root=deep(j['root']))), ('run.json', lambda j: j.update(inputs=[{'role': 4, 'path': 5}])))
        for name, change in cases:
            path = os.path.join(divided, name)
            with open(path, encoding='utf-8') as f:
                text = f.read()
            document = json.loads(text)
            change(document)
            sys.setrecursionlimit(20000)
            with open(path, 'w', encoding='utf-8') as f:
                json.dump(document, f)
            with self.subTest(name + json.dumps(document)[-60:]):
                self.assertEqual(blockrand('validate', divided).code, 2)
            with open(path, 'w', encoding='utf-8') as f:
                f.write(text)
        self.assertEqual(blockrand('validate', divided).code, 0)

    def test_a_worker_that_is_killed(self):
        """The last good build stays; what was done is kept."""
        options = ('--jobs', '2', '--lod', '3', '--formats', 'gltf,cityjson', '--no-report', '--areas', LEVEL, '--cache', self.path('kept'))
        plain = self.build(self.town, 'unkilled', *options[:-2])
        target, rng, killed = self.path('killed'), random.Random(6), 0
        for delay in (0, *(rng.uniform(0, 2) for _ in range(3))):
            run = subprocess.Popen([Setup.program, 'build', self.town, '-o', target, '--quiet', *options], stderr=subprocess.PIPE, text=True)
            wait_for_a_worker(run)
            time.sleep(delay)
            for child in workers(run):
                try:
                    os.kill(child, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            error = run.stderr.read()
            code = run.wait()
            if code:
                killed += 1
                self.assertEqual(code, 4, error)
                self.assertIn('signal 9', error)
                self.assertFalse(os.path.exists(target))
                self.assertEqual(stray_siblings(target), [])
            else:  # the last worker had just ended
                shutil.rmtree(target)
        self.assertGreater(killed, 0)
        self.same_build(plain, self.build(self.town, 'killed', *options))

    def test_a_run_that_is_killed_takes_its_workers_along(self):
        target = self.path('gone')
        run = subprocess.Popen([Setup.program, 'build', self.town, '-o', target, '--progress', 'none', '--areas', LEVEL, '--lod', '3'])
        wait_for_a_worker(run)
        run.kill()
        run.wait()
        time.sleep(1)
        with subprocess.Popen(['ps', '-eo', 'args'], stdout=subprocess.PIPE, text=True) as ps:
            self.assertEqual([line for line in ps.stdout if target in line and 'blockrand' in line], [])
        self.assertFalse(os.path.exists(target))
        self.build(self.town, 'gone', *QUICK, '--areas', LEVEL)  # removes what was left


class RegionInAreas(RegionTest):
    SETTINGS = LIMITS_OFF + f'[build]\nlod = 2\nareas = {LEVEL}\njobs = 2\n'

    def test_nights(self):
        map_, rng = Map(town(1200)), random.Random(9)
        folder = self.region('province', self.SETTINGS)
        self.update(folder, map_.write(self.path('province.osm')))
        taken = 0
        for night in range(1, 7):
            map_.random_edits(rng, rng.choice([1, 2, 6]))
            changes = map_.write_changes(self.path('night.osc'))
            planned = blockrand('update', folder, changes, '--dry-run', '--progress', 'none')
            self.assertEqual(planned.code, 0, planned)
            self.update(folder, changes)
            with open(os.path.join(folder, 'log', 'runs.jsonl'), encoding='utf-8') as f:
                last = json.loads(f.readlines()[-1])
            if last['state'] == 'unchanged':
                continue
            taken += last['areas']['taken_over']
            self.assertIn(f'{last["tiles"]["built"]:,} tile', planned.out)
            clean = self.clean(map_, folder, '--lod', '2', '--areas', LEVEL)
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])
        sound = blockrand('validate', self.current(folder))
        self.assertEqual(sound.code, 0, sound)
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.assertEqual(blockrand('status', folder).code, 0)

    def test_in_areas_and_at_once_again(self):
        """areas = 1 is a build at once; a region may change between the two."""
        map_ = Map(town(300))
        folder = self.region('both', self.SETTINGS)
        self.update(folder, map_.write(self.path('both.osm')))
        self.assertTrue(areas(self.current(folder)))
        for setting, divided in (('1', False), (LEVEL, True), ('1', False)):
            with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
                f.write(self.SETTINGS.replace(f'areas = {LEVEL}', f'areas = {setting}'))
            self.assertIn('0 new, 0 gone; 0 footprints and 0 values differ', self.update(folder).out)
            self.assertEqual(bool(areas(self.current(folder))), divided)
            options = ('--areas', LEVEL) if divided else ()
            clean = self.clean(map_, folder, '--lod', '2', *options)
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])

    def test_only_what_a_change_concerns_is_looked_into(self):
        """Two towns 8 km apart in one area: an edit in one is worked in without a look at the other."""
        objects, far = town(200), 10 ** 9
        for o in list(objects):
            if isinstance(o, Node):
                objects.append(Node(o.id + far, o.lon + 0.12, o.lat, o.tags))
            elif isinstance(o, Way):
                objects.append(Way(o.id + far, [r + far for r in o.refs], o.tags))
        map_, level = Map(objects), '9'
        folder = self.region('wide', self.SETTINGS.replace(LEVEL, level))
        self.update(folder, map_.write(self.path('wide.osm')))
        area = os.path.join('areas', areas(self.current(folder))[0])
        houses = [next(w for w in map_.ways('building') if (w.id < far) == near) for near in (True, False)]

        def night(looked_into_all_because=None):
            self.update(folder, map_.write_changes(self.path('wide.osc')))
            run = read_json(os.path.join(self.current(folder), area), 'run.json')
            clean = self.clean(map_, folder, '--lod', '2', '--areas', level)
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])
            tiles = run['tiles']['built'] + run['tiles']['kept']
            if looked_into_all_because:
                self.assertNotIn('looked_into', run)
                self.assertIn(looked_into_all_because, run['looked_into_all_because'])
            else:
                self.assertLess(run['looked_into'], tiles / 2 + 1)
            self.assertGreater(run['tiles']['built'], 0)

        for storeys in ('7', '3'):
            for house in houses:
                map_.edit(house, tags=dict(house.tags, **{'building:levels': storeys}))
                night()
        # Kept work that is gone, or another thing: told, and all is looked into.
        kept = glob.glob(os.path.join(folder, 'cache', 'areas', '*', '*'))
        self.assertTrue(kept)
        for entry in kept:
            shutil.rmtree(entry)
        map_.edit(houses[0], tags=dict(houses[0].tags, **{'building:levels': '4'}))
        night('records')
        shutil.rmtree(os.path.join(folder, 'cache', 'stores'))
        map_.edit(houses[0], tags=dict(houses[0].tags, **{'building:levels': '5'}))
        night('data of the earlier build')
        map_.edit(houses[1], tags=dict(houses[1].tags, **{'building:levels': '5'}))
        night()

    def test_the_divided_data_follow_the_changes(self):
        """The store is brought up to date: nodes that come a night before their way, tags that decide between outlines."""
        map_ = Map(town(200))
        folder = self.region('follows', self.SETTINGS.replace(LEVEL, '10'))
        self.update(folder, map_.write(self.path('follows.osm')))
        far = 10 ** 9

        def night(anew=None):
            self.update(folder, map_.write_changes(self.path('follows.osc')))
            run = read_json(self.current(folder), 'run.json')
            self.assertEqual(run.get('store_written_because'), anew)
            self.assertEqual(run.get('store'), None if anew else 'brought up to date')
            clean = self.clean(map_, folder, '--lod', '2', '--areas', '10')
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])

        houses = map_.ways('building')
        corner = map_.objects[(0, houses[0].refs[0])]
        for k, (x, y) in enumerate(((0, 0), (12, 0), (12, 9), (0, 9))):
            map_.put(Node(far + k, corner.lon + (40 + x) * METRE, corner.lat + y * METRE, {}))
        night()  # nothing that is kept
        map_.put(Way(far, [far, far + 1, far + 2, far + 3, far], {'building': 'yes'}))
        night()
        # Nodes move that no way had so far, and one that a kept way has.
        map_.edit(map_.objects[(0, far + 2)], lon=corner.lon + 55 * METRE)
        night()
        # Over the house lies another one: which of them stays whole, their tags decide.
        map_.put(Way(far + 1, [far, far + 1, houses[1].refs[0], far], {'building': 'yes', 'name': 'A'}))
        night()
        for tags in ({'building:levels': '2', 'roof:shape': 'flat'}, {'building:levels': '3', 'roof:shape': 'flat'},
                     {'height': '9'}, {'attributes': '[x', 'building:levels': '3'}, {}):
            map_.edit(map_.objects[(1, far)], tags=dict({'building': 'yes'}, **tags))
            night()
        # All have one time: that of another one may be the newest, or not.
        map_.delete(map_.objects[(1, far)])
        night('the newest object is gone')

    def test_what_stands_for_an_object_may_lie_anywhere(self):
        """The ways of a multipolygon lie far apart, its middle in neither's tile: a night beside one of them is looked into."""
        tile = 180 / 2 ** 15  # degrees
        west, south = (math.floor(13.2 / tile) + 0.5) * tile, math.floor(52.0 / tile) * tile

        def square(number, x, y):
            corners = [(x + dx * METRE, y + dy * METRE) for dx, dy in ((0, 0), (18, 0), (18, 11), (0, 11))]
            return ring(500000 + 100 * number, 7000 + number, corners, {'building': 'yes'})
        # One at the north of its tile, its mate 12 km to the east (no building is as wide: there is no outline) and some tiles to the north; a house that the tile hears of and the
        # multipolygon does not; others in between.
        objects = town(200) + square(0, west, south + 0.9 * tile) + square(1, west + 0.175, south + 3.5 * tile)
        objects += square(2, west, south - 1000 * METRE) + square(3, west + 0.08, south - 20 * tile)
        map_ = Map(objects)
        map_.put(Relation(9000, [('way', 7000, 'outer'), ('way', 7001, 'outer')],
                          {'type': 'multipolygon', 'building': 'yes'}))
        beside = map_.objects[(1, 7002)]
        folder = self.region('stands_for', self.SETTINGS.replace(LEVEL, '9'))
        self.update(folder, map_.write(self.path('stands_for.osm')))
        at_once = self.build(self.path('stands_for.osm'), 'stands_for_once', '--lod', '1', '--formats', 'gltf')
        counts = [read_json(self.current(folder), 'areas', a, 'build.json')['counts'] for a in areas(self.current(folder))]
        for key in ('buildings_in', 'represented', 'reported'):
            self.assertEqual(sum(c[key] for c in counts), read_json(at_once, 'build.json')['counts'][key], key)
        for metres in (0.3, 0.6):
            node = map_.objects[(0, beside.refs[0])]
            map_.edit(node, lat=node.lat + metres * METRE)
            self.update(folder, map_.write_changes(self.path('stands_for.osc')))
            looked = [read_json(self.current(folder), 'areas', a, 'run.json') for a in areas(self.current(folder))]
            self.assertTrue(any('looked_into' in run for run in looked), 'the whole area was looked into: nothing is tested')
            clean = self.clean(map_, folder, '--lod', '2', '--areas', '9')
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])

    def test_a_neighbour_whose_middle_lies_far_off(self):
        """Of a multipolygon one way stands beside a house and another 12 km to the north-east (no building is as wide: there is no outline). A night that
        looks into the house alone knows of it: a corner that both share stays in the straight wall of one."""
        tile = 180 / 2 ** 15  # degrees
        west, south = (math.floor(13.2 / tile) + 0.5) * tile, (math.floor(52.0 / tile) + 0.5) * tile
        objects = town(200)

        def square(number, x, y):
            corners = [(x + dx * METRE, y + dy * METRE) for dx, dy in ((0, 0), (18, 0), (18, 11), (0, 11))]
            objects.extend(ring(500000 + 100 * number, 7000 + number, corners, {'building': 'yes'}))
        square(0, west, south)
        square(1, west + 0.14, south + 0.09)
        # Two corners of the first square lie in its east wall.
        corners = [(west + dx * METRE, south + dy * METRE) for dx, dy in ((-20, -6), (0, -6), (0, 17), (-20, 17))]
        objects += [Node(600000 + i, *c) for i, c in enumerate(corners)]
        objects.append(Way(8000, [600000, 600001, 500000, 500003, 600002, 600003, 600000], {'building': 'yes'}))
        # A house that their tile hears of and the multipolygon does not; another one far off, so that not all is concerned.
        square(2, west - 300 * METRE, south - 300 * METRE)
        square(3, west + 0.08, south - 20 * tile)
        map_ = Map(objects)
        map_.put(Relation(9000, [('way', 7000, 'outer'), ('way', 7001, 'outer')],
                          {'type': 'multipolygon', 'building': 'yes'}))
        beside = map_.objects[(1, 7002)]
        folder = self.region('far_middle', self.SETTINGS.replace(LEVEL, '9'))
        self.update(folder, map_.write(self.path('far_middle.osm')))
        for metres in (0.3, 0.6):
            node = map_.objects[(0, beside.refs[0])]
            map_.edit(node, lat=node.lat + metres * METRE)
            self.update(folder, map_.write_changes(self.path('far_middle.osc')))
            runs = [read_json(self.current(folder), 'areas', a, 'run.json') for a in areas(self.current(folder))]
            self.assertTrue(any('looked_into' in run for run in runs), 'the whole area was looked into: nothing is tested')
            clean = self.clean(map_, folder, '--lod', '2', '--areas', '9')
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])

    def test_places_far_from_each_other_in_one_area(self):
        """Two towns and one area, an edit in each on one night: what lies between is not read, and nothing differs."""
        objects = town(300, 11.0, 51.5)
        far = 10 ** 9
        for o in town(300, 11.15, 51.62):
            if isinstance(o, Node):
                objects.append(Node(o.id + far, o.lon, o.lat, o.tags))
            else:
                objects.append(Way(o.id + far, [r + far for r in o.refs], o.tags))
        map_ = Map(objects)
        folder = self.region('places', self.SETTINGS.replace(LEVEL, '9'))
        self.update(folder, map_.write(self.path('places.osm')))
        # In the middle: the box around all data is the region's.
        one, other = (next(w for w in map_.ways('building') if w.id == n) for n in (1150, far + 1150))
        for metres in (0.4, 0.8):
            for way in (one, other):
                node = map_.objects[(0, way.refs[0])]
                map_.edit(node, lon=node.lon - metres * METRE)
            self.update(folder, map_.write_changes(self.path('places.osc')))
            runs = [read_json(self.current(folder), 'areas', a, 'run.json') for a in areas(self.current(folder))]
            self.assertEqual([run.get('looked_into_all_because') for run in runs], [None])
            clean = self.clean(map_, folder, '--lod', '2', '--areas', '9')
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])

    def test_far_areas_stay_as_they_are(self):
        """Two towns 40 km apart: an edit in one touches nothing of the other."""
        objects = town(400)
        far = 10 ** 9
        for o in list(objects):
            if isinstance(o, Node):
                objects.append(Node(o.id + far, o.lon + 0.5, o.lat, o.tags))
            elif isinstance(o, Way):
                objects.append(Way(o.id + far, [r + far for r in o.refs], o.tags))
        map_ = Map(objects)
        folder = self.region('two', self.SETTINGS.replace(LEVEL, '11'))
        self.update(folder, map_.write(self.path('two.osm')))
        before = self.current(folder)
        house = next(w for w in map_.ways('building') if w.id < far)
        map_.edit(house, tags=dict(house.tags, **{'building:levels': '7'}))
        self.update(folder, map_.write_changes(self.path('two.osc')))
        with open(os.path.join(folder, 'log', 'runs.jsonl'), encoding='utf-8') as f:
            last = json.loads(f.readlines()[-1])
        self.assertGreater(last['areas']['taken_over'], 0)
        self.assertLess(last['areas']['taken_over'], last['areas']['all'])
        linked = 0
        for path in hashes(self.current(folder), 'areas'):
            one, other = os.path.join(before, path), os.path.join(self.current(folder), path)
            linked += os.path.exists(one) and os.path.samefile(one, other)
        self.assertGreater(linked, 10)
        # A published file is damaged in an area where nothing differs, the record of another one: both are built anew, and the rest stays.
        def same(path):
            return os.path.samefile(os.path.join(before, path), os.path.join(self.current(folder), path))
        taken = [p for p in hashes(self.current(folder), 'areas') if p.endswith('.glb') and same(p.split('/tiles/')[0] + '/run.json')]
        with open(os.path.join(self.current(folder), taken[0]), 'r+b') as f:
            f.seek(200)
            f.write(b'!!')
        map_.edit(house, tags=dict(house.tags, **{'building:levels': '3'}))
        self.assertIn('is damaged', self.update(folder, map_.write_changes(self.path('two.osc'))).err)
        self.assertEqual(blockrand('validate', self.current(folder)).code, 0)
        record = os.path.join(self.current(folder), taken[0].split('/tiles/')[0], 'build.json')
        with open(record, encoding='utf-8') as f:
            text = f.read()
        os.remove(record)  # not what it is linked to
        with open(record, 'w', encoding='utf-8') as f:
            f.write(text.replace('"models": ', '"models": 9', 1))
        map_.edit(house, tags=dict(house.tags, **{'building:levels': '4'}))
        self.assertIn('is damaged', self.update(folder, map_.write_changes(self.path('two.osc'))).err)
        self.assertEqual(blockrand('validate', self.current(folder)).code, 0)
        # What a later night takes over must still find its kept work.
        house = next(w for w in map_.ways('building') if w.id > far)
        map_.edit(house, tags=dict(house.tags, **{'building:levels': '7'}))
        self.update(folder, map_.write_changes(self.path('two.osc')))
        clean = self.clean(map_, folder, '--lod', '2', '--areas', '11')
        first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
        self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])


if __name__ == '__main__':
    main()
