"""What stands around the houses of a region: what an update works in is what a clean build makes; areas make what a build at once makes."""
import glob
import json
import os
import random
import shutil
import sqlite3

from areas_test import areas, in_areas, tile_files, without_runs
from blockrand_run import SAMPLE, blockrand, extract, hashes, main, read_json
from osm_files import read_xml
from region_run import LIMITS_OFF, RegionTest
from surroundings_edits import Surroundings

FORMATS = 'gltf,citygml,cityjson,geopackage'
SEA_LEVEL = ('--terrain-height-reference', 'sea-level')


def settings(lod=1, **more):
    lines = {'lod': lod, 'formats': f'"{FORMATS}"', 'surroundings': '"on"', 'report': 'false', 'jobs': 2, **more}
    return LIMITS_OFF + '[build]\n' + ''.join(f'{k} = {v}\n' for k, v in lines.items()) + '[region]\nkeep = 2\n'


def options(lod=1, *more):
    return ('--lod', str(lod), '--formats', FORMATS, '--surroundings', 'on', '--no-report', '--jobs', '2', *more)


def hill(map_, path, cell=5e-5, margin=0.002):
    """A raster in degrees around all nodes of a map: slopes, a hump and a step. \\returns its path"""
    lons, lats = ([getattr(o, v) for k, o in map_.objects.items() if k[0] == 0] for v in ('lon', 'lat'))
    west, south, east, north = min(lons) - margin, min(lats) - margin, max(lons) + margin, max(lats) + margin
    columns, rows = int((east - west) / cell), int((north - south) / cell)
    with open(path, 'w', encoding='utf-8') as f:
        f.write(f'ncols {columns}\nnrows {rows}\nxllcorner {west}\nyllcorner {south}\ncellsize {cell}\nNODATA_value -9999\n')
        for r in range(rows):
            y = r / rows
            f.write(' '.join(f'{40 + 12 * c / columns + 9 * y * y + (3 if 0.4 < y < 0.5 and c > columns / 3 else 0):.2f}' for c in range(columns)) + '\n')
    with open(path[:-3] + 'prj', 'w', encoding='utf-8') as f:
        f.write('GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["Degree",0.0174532925199433]]')
    return path


def around(folder):
    """Files of what stands around, by path."""
    return {p: h for p, h in tile_files(folder).items() if 'surroundings' in os.path.basename(p)}


def rows_around(folder):
    """Rows of the layers of what stands around, without the numbers that the file gave them: sorted, by layer."""
    out = {}
    for path in sorted(glob.glob(os.path.join(folder, '**', 'buildings.gpkg'), recursive=True)):
        with sqlite3.connect(path) as db:
            names = [n for (n,) in db.execute("SELECT table_name FROM gpkg_contents WHERE data_type='features'")]
            for name in names:
                if name in ('buildings', 'parts', 'blocks', 'courtyards', 'cells', 'facade_edges', 'duplicates') or name.startswith('building'):
                    continue
                columns = [c[1] for c in db.execute(f'PRAGMA table_info("{name}")') if c[1] != 'fid']
                out.setdefault(name, []).extend(db.execute('SELECT ' + ','.join(f'"{c}"' for c in columns) + f' FROM "{name}"'))
    return {name: sorted(map(repr, rows)) for name, rows in out.items() if rows}


class Nights(RegionTest):
    def nights(self, name, source, rng, edits, settings_, options_, least_kept=1):
        """Each entry of `edits` is worked in and compared with a clean build. \\returns how many tiles were kept"""
        map_ = source if isinstance(source, Surroundings) else Surroundings(read_xml(source))
        folder = self.region(name, settings_)
        self.update(folder, map_.write(self.path(name + '.osm')))
        kept = 0
        for night, edit in enumerate(edits):
            if callable(edit):
                edit(map_)
            else:
                for what in edit:
                    getattr(map_, what)(rng)
            self.update(folder, map_.write_changes(self.path(name + '.osc')))
            with open(os.path.join(folder, 'log', 'runs.jsonl'), encoding='utf-8') as f:
                last = json.loads(f.readlines()[-1])
            if last['state'] == 'unchanged':
                continue
            kept += last['tiles']['kept']
            clean = self.clean(map_, folder, *options_)
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [], (night, edit))
        self.assertTrue(around(self.current(folder)) or areas(self.current(folder)))
        self.assertGreaterEqual(kept, least_kept)
        sound = blockrand('validate', self.current(folder))
        self.assertEqual(sound.code, 0, sound)
        return kept

    def edits(self, map_, rng, nights, at_random=6):
        """Each kind alone or beside another one, then some of them together."""
        kinds = map_.kinds()
        rng.shuffle(kinds)
        return [kinds[i::nights] for i in range(nights)] + [[rng.choice(kinds) for _ in range(at_random)]]

    def quarter(self):
        """A quarter of real data, or the sample."""
        return Surroundings(read_xml(extract('berlin-zionskirchplatz-2020.osm') or SAMPLE))

    def test_every_kind_of_edit(self):
        map_, rng = Surroundings(read_xml(SAMPLE)), random.Random(11)
        self.nights('kinds', map_, rng, [[kind] for kind in map_.kinds()], settings(), options())

    def test_a_quarter(self):
        map_, rng = self.quarter(), random.Random(5)
        # One edit a night leaves tiles to be kept; all kinds in one leave none.
        edits = [['edit_tree'], ['edit_furniture'], ['edit_barrier'], ['edit_surface'], ['edit_steps'], ['edit_street'], map_.kinds()]
        self.nights('quarter', map_, rng, edits, settings(), options())

    def test_on_terrain(self):
        map_, rng = Surroundings(read_xml(SAMPLE)), random.Random(8)
        raster = hill(map_, self.path('hill.asc'))
        self.nights('slope', map_, rng, self.edits(map_, rng, 6), settings(terrain=f'"{raster}"', terrain_height_reference='"sea-level"'), options(1, '--terrain', raster, *SEA_LEVEL))

    def test_in_areas(self):
        map_, rng = self.quarter(), random.Random(6)
        self.nights('divided', map_, rng, [['edit_tree'], ['edit_barrier'], *self.edits(map_, rng, 2)], settings(areas=14), options(1, '--areas', '14'))

    def test_only_what_changed_is_worked_on(self):
        """A tree is moved, a lamp comes: the tile where they stand is worked on, the others are kept."""
        for name, more, of_clean in (('at_once', {}, ()), ('in_areas', {'areas': 14}, ('--areas', '14'))):
            with self.subTest(name):
                map_ = self.quarter()
                house = map_.ways('building')[0]
                corner = map_.objects[(0, house.refs[0])]
                tree = map_.node(corner.lon + 1e-4, corner.lat + 1e-4, {'natural': 'tree'})
                folder = self.region(name, settings(**more))
                self.update(folder, map_.write(self.path(name + '.osm')))
                map_.changes = []
                for edit in (lambda: map_.move(random.Random(1), map_.objects[(0, tree)]), lambda: map_.node(corner.lon, corner.lat + 1e-4, {'highway': 'street_lamp'})):
                    edit()
                    self.update(folder, map_.write_changes(self.path(name + '.osc')))
                    with open(os.path.join(folder, 'log', 'runs.jsonl'), encoding='utf-8') as f:
                        tiles = json.loads(f.readlines()[-1])['tiles']
                    self.assertTrue(1 <= tiles['built'] <= 4, tiles)
                    if more:  # areas are looked into in part, none as a whole
                        runs = [read_json(self.current(folder), 'areas', a, 'run.json') for a in areas(self.current(folder))]
                        self.assertEqual([why for r in runs if (why := r.get('looked_into_all_because'))], [])
                        self.assertTrue(any('looked_into' in r for r in runs))
                    self.assertGreater(tiles['kept'], tiles['built'])
                    clean = self.clean(map_, folder, *options(1, *of_clean))
                    first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
                    self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])

    def test_switched_on_and_off(self):
        """The data of a region whose surroundings were off lack what these are made of: they are divided anew."""
        map_ = Surroundings(read_xml(SAMPLE))
        folder = self.region('switched', settings(areas=14))
        self.update(folder, map_.write(self.path('switched.osm')))
        for word in ('off', 'on', 'ground'):
            with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
                f.write(settings(areas=14).replace('"on"', f'"{word}"'))
            self.update(folder)
            clean = self.clean(map_, folder, '--lod', '1', '--formats', FORMATS, '--surroundings', word, '--no-report', '--areas', '14')
            first, second = (without_runs(hashes(f)) for f in (self.current(folder), clean))
            self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [], word)


class Areas(RegionTest):
    def same(self, source, level, *more):
        """A build at once, and one in areas: the same files of tiles, rows and account. \\returns both"""
        at_once = self.build(source, 'once', *options(1, *more), '--force', '--allow-shrink', '100')
        divided = self.build(source, 'areas', *options(1, *more), '--areas', level, '--force', '--allow-shrink', '100')
        self.assertGreater(len(areas(divided)), 1)
        whole, parts = tile_files(at_once), in_areas(divided)
        self.assertEqual(sorted(p for p in whole.keys() | parts.keys() if whole.get(p) != parts.get(p)), [])
        self.assertTrue(around(at_once))
        rows = rows_around(at_once)
        self.assertTrue(rows)
        self.assertEqual(rows, rows_around(divided))
        one, all_ = (read_json(f, 'build.json')['surroundings'] for f in (at_once, divided))
        self.assertEqual(one, all_)
        # What areas share was told by both.
        told = sum(n for a in areas(divided) for kind in read_json(os.path.join(divided, 'areas', a), 'build.json')['surroundings'].values() for n in kind.values())
        self.assertGreater(told, sum(n for kind in one.values() for n in kind.values()))
        sound = blockrand('validate', divided, '--extract', source)
        self.assertEqual(sound.code, 0, sound)
        return at_once, divided

    def test_the_sample(self):
        at_once, divided = self.same(SAMPLE, '14')
        for n, area in enumerate(areas(divided)):
            alone = self.build(SAMPLE, f'alone{n}', *options(), '--area', area, '--pinned', os.path.join(divided, 'build.json'))
            first, second = (without_runs(hashes(f)) for f in (os.path.join(divided, 'areas', area), alone))
            self.assertEqual(first, second)
        for path in list(around(at_once))[:2]:
            if not path.startswith('tiles'):
                continue
            alone = self.build(SAMPLE, 'tile', *options(), '--tile', path[len('tiles/'):-len('_surroundings.glb')], '--pinned',
                               os.path.join(divided, 'build.json'))
            self.assertEqual(around(alone).get(path), around(at_once)[path])
            shutil.rmtree(alone)

    def test_on_terrain(self):
        map_ = Surroundings(read_xml(SAMPLE))
        rng = random.Random(3)
        for kind in map_.kinds():
            getattr(map_, kind)(rng)
        self.same(map_.write(self.path('slope.osm')), '14', '--terrain', hill(map_, self.path('hill.asc')), *SEA_LEVEL)

    def test_real_places(self):
        for name, level in (('monaco-2021.osm.pbf', '12'), ('limerick-2026.osm.gz', '14')):
            source = extract(name)
            if source is None:
                self.skipTest('the shared data is absent')
            with self.subTest(name):
                self.same(source, level)

    def test_tiles_alone(self):
        """Of a place with hills, wires and water: a tile alone has the same files and rows."""
        map_, rng = Surroundings(read_xml(SAMPLE)), random.Random(21)
        for kind in map_.kinds() * 2:
            getattr(map_, kind)(rng)
        source, raster = map_.write(self.path('alone.osm')), hill(map_, self.path('hill.asc'))
        whole = self.build(source, 'whole', *options(1, '--terrain', raster, *SEA_LEVEL))
        tried = 0
        for path, digest in sorted(around(whole).items()):
            if not path.startswith('tiles'):
                continue
            tile = path[len('tiles/'):-len('_surroundings.glb')]
            alone = self.build(source, 'tile', *options(1, '--terrain', raster, *SEA_LEVEL), '--tile', tile, '--pinned', os.path.join(whole, 'build.json'))
            mine = around(alone)
            for p, h in mine.items():
                self.assertEqual(h, around(whole)[p], p)
            self.assertEqual(mine[path], digest)
            rows = rows_around(whole)
            for layer, its in rows_around(alone).items():
                self.assertLessEqual(set(its), set(rows[layer]), layer)
            shutil.rmtree(alone)
            tried += 1
            if tried == 6:
                break
        self.assertGreater(tried, 1)


if __name__ == '__main__':
    main()
