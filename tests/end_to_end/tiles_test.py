"""One tile alone, in a process of its own that reads only the tile and what lies within its halo, is byte for byte the
tile of the whole build; and the records of each building are the same at every tile level (ARCHITECTURE.md, law 4)."""
import gzip
import json
import os
import shutil
import unittest

from blockrand_run import SAMPLE, BuildTest, blockrand, call, extract, hashes, main, read_json

OPTIONS = ['--lod', '3', '--surroundings', 'off', '--no-report', '--formats']
ALL, GLB = 'gltf,citygml,cityjson', 'gltf'  # towns: GLB alone, for time


def records(path):
    """{id: the building's line of explain/, without what names its tile}."""
    out = {}
    with gzip.open(path, 'rt', encoding='utf-8') as lines:
        for line in lines:
            record = json.loads(line)
            record.pop('tile')
            record.pop('files')
            out[record['id']] = record
    return out


def tile_records(build):
    """{(level, x, y): records}"""
    out = {}
    for name in sorted(os.listdir(os.path.join(build, 'explain'))):
        if name.endswith('.jsonl.gz'):
            tile = tuple(int(n) for n in name.split('.')[0].split('_'))
            out[tile] = records(os.path.join(build, 'explain', name))
    return out


class Tiles(BuildTest):
    def build_whole(self, source, formats=ALL):
        name = os.path.basename(source).split('.')[0]
        out = self.path(f'{name}-{formats}')
        if os.path.exists(out):
            return out
        run = blockrand('build', source, '-o', out, *OPTIONS, formats)
        self.assertEqual(run.code, 0, run)
        return out

    def build_tile(self, source, whole, tile, formats=ALL):
        """Builds one tile; \\returns its folder, or None where the process says that the tile is empty."""
        out = self.path('tile-' + '-'.join(map(str, tile)))
        shutil.rmtree(out, ignore_errors=True)
        run = blockrand('build', source, '-o', out, *OPTIONS, formats, '--tile', '/'.join(map(str, tile)),
                        '--pinned', os.path.join(whole, 'build.json'))
        self.assertEqual(run.code, 0, run)
        return out

    def clip(self, source, whole, tile):
        """The extract cut down by osmium to the tile and its halo: nothing else can be read."""
        if not shutil.which('osmium'):
            return source
        level, x, y = tile
        size = 180 / 2 ** level
        west, south = -180 + x * size, -90 + y * size
        # 3 km, and a little, so that the program's own window decides.
        north = 3100 / 110600
        east = north / 0.5
        box = f'{west - east},{south - north},{west + size + east},{south + size + north}'
        clipped = self.path('clipped.osm.pbf')
        made = call(['osmium', 'extract', '-b', box, '-s', 'smart', '--overwrite', '-o', clipped, source])
        self.assertEqual(made.code, 0, made)
        return clipped

    def compare(self, source, count):
        whole = self.build_whole(source, GLB)
        by_tile = tile_records(whole)
        everything = {i: r for tile in by_tile.values() for i, r in tile.items()}
        tiles = sorted(by_tile, key=lambda t: (-len(by_tile[t]), t))
        chosen = tiles[::max(1, len(tiles) // count)][:count]
        compared = {14: 0, 15: 0}
        for tile in chosen:
            clipped = self.clip(source, whole, tile)
            with self.subTest(source=os.path.basename(source), tile=tile):
                alone = self.build_tile(clipped, whole, tile, GLB)
                name = '_'.join(map(str, tile))
                self.assert_records(by_tile[tile], records(os.path.join(alone, 'explain', name + '.jsonl.gz')))
                start = 'tiles/' + '/'.join(map(str, tile))
                its = {p: h for p, h in hashes(whole, 'tiles').items() if p.startswith((start + '.', start + '_'))}
                self.assertTrue(its)
                self.assertEqual({p: h for p, h in hashes(alone, 'tiles').items() if p in its}, its)
                compared[15] += len(by_tile[tile])
            parent = (14, tile[1] // 2, tile[2] // 2)
            expected = {}
            for child in by_tile:
                if (child[1] // 2, child[2] // 2) == parent[1:]:
                    expected.update(by_tile[child])
            with self.subTest(source=os.path.basename(source), tile=parent):
                alone = self.build_tile(self.clip(source, whole, parent), whole, parent, GLB)
                name = '_'.join(map(str, parent))
                self.assert_records(expected, records(os.path.join(alone, 'explain', name + '.jsonl.gz')))
                compared[14] += len(expected)
        print(f'{os.path.basename(source)}: {len(everything)} buildings; compared {compared[15]} at level 15, '
              f'{compared[14]} at level 14, in {len(chosen)} tiles each')

    def assert_records(self, expected, got):
        self.assertEqual(sorted(expected), sorted(got))
        different = [i for i in expected if expected[i] != got[i]]
        for i in different[:3]:
            for key in expected[i]:
                if expected[i][key] != got[i].get(key):
                    print(i, key, '\n  whole:', json.dumps(expected[i][key])[:1500], '\n  alone:', json.dumps(got[i].get(key))[:1500])
        self.assertEqual(different, [], f'{len(different)} of {len(expected)} differ')

    def test_counts_of_a_tile_are_its_own(self):
        whole = self.build_whole(SAMPLE)
        total = dict.fromkeys(('buildings_in', 'parts_in', 'models', 'represented', 'reported', 'bodies'), 0)
        for tile in tile_records(whole):
            counts = read_json(self.build_tile(SAMPLE, whole, tile), 'build.json')['counts']
            for key in total:
                total[key] += counts[key]
        counts = read_json(whole, 'build.json')['counts']
        self.assertEqual(total, {key: counts[key] for key in total})

    def test_an_empty_tile_is_an_empty_build(self):
        whole = self.build_whole(SAMPLE)
        out = self.build_tile(SAMPLE, whole, (15, 3, 16000))
        self.assertEqual(read_json(out, 'build.json')['counts']['buildings_in'], 0)

    def test_sample(self):
        self.compare(SAMPLE, 2)

    def test_files_of_a_tile(self):
        """Facades too: the same bytes in every file."""
        whole = self.build_whole(SAMPLE)
        for tile in tile_records(whole):
            alone, name = self.build_tile(SAMPLE, whole, tile), '_'.join(map(str, tile))
            for path in ('tiles/' + '/'.join(map(str, tile)) + '.glb', f'citygml/{name}.gml', f'cityjson/{name}.city.jsonl'):
                with open(os.path.join(whole, path), 'rb') as a, open(os.path.join(alone, path), 'rb') as b:
                    self.assertEqual(a.read(), b.read(), path)

    def test_real(self):
        for name, count in (('liechtenstein-2022-12.osm.pbf', 3), ('lauf-2020-clipped.osm.pbf', 2),
                            ('berlin-mitte-2014.osm.pbf', 2), ('dortmund-innenstadt.osm.gz', 2)):
            source = extract(name)
            if source:
                self.compare(source, count)

    @unittest.skipUnless(os.environ.get('BLOCKRAND_CITY'), 'a whole city takes minutes')
    def test_city(self):
        source = extract('berlin-2014-06.osm.pbf')
        if source:
            self.compare(source, 8)


if __name__ == '__main__':
    main()
