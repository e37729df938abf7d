"""Models that overrides put in the place of buildings: in all outputs, with source and licence."""
import json
import os
import shutil
import sqlite3
import struct

from blockrand_run import SAMPLE, BuildTest, blockrand, extract, main, read_json, sha256

BOX = ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1), (0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1))
# Counter-clockwise from outside, y up: bottom, top, and the four sides.
SIDES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))


def glb(path, size=(8, 20, 12), sides=SIDES, at=(0, 0, 0)):
    """A box of so many metres in y-up axes, red walls and a grey roof, its middle over the origin."""
    points, colours = [], [[0.8, 0.05, 0.05, 1], [0.2, 0.2, 0.2, 1]]
    groups = [[], []]
    for n, side in enumerate(sides):
        first = len(points)
        for corner in side:
            points.append([(BOX[corner][k] - (0.5 if k != 1 else 0)) * size[k] + at[k] for k in range(3)])
        groups[1 if n == 1 else 0] += [first, first + 1, first + 2, first, first + 2, first + 3]
    position = b''.join(struct.pack('<3f', *p) for p in points)
    index = b''.join(struct.pack('<%dI' % len(g), *g) for g in groups)
    data = position + index
    low = [min(p[k] for p in points) for k in range(3)]
    high = [max(p[k] for p in points) for k in range(3)]
    views = [{'buffer': 0, 'byteLength': len(position)}]
    accessors = [{'bufferView': 0, 'componentType': 5126, 'count': len(points), 'type': 'VEC3', 'min': low, 'max': high}]
    primitives, offset = [], len(position)
    for n, group in enumerate(groups):
        if not group:
            continue
        views.append({'buffer': 0, 'byteOffset': offset, 'byteLength': 4 * len(group)})
        accessors.append({'bufferView': len(views) - 1, 'componentType': 5125, 'count': len(group), 'type': 'SCALAR'})
        primitives.append({'attributes': {'POSITION': 0}, 'indices': len(accessors) - 1, 'material': n})
        offset += 4 * len(group)
    text = json.dumps({'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
                       'meshes': [{'primitives': primitives}], 'accessors': accessors, 'bufferViews': views, 'buffers': [{'byteLength': len(data)}],
                       'materials': [{'pbrMetallicRoughness': {'baseColorFactor': c}} for c in colours]}).encode()
    text += b' ' * (-len(text) % 4)
    with open(path, 'wb') as f:
        f.write(struct.pack('<4sII', b'glTF', 2, 12 + 8 + len(text) + 8 + len(data)))
        f.write(struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(data), b'BIN\0') + data)


ORDER = '''[{id}.model]
file = "{file}"
source = "https://example.org/{file}"
licence = "CC BY 4.0"
author = "A. Mason"
{more}
'''


class Landmarks(BuildTest):
    def some(self, data):
        '''Ids of a building with parts, if there is one, and of two others.'''
        out = self.build(data, 'plain', '--lod', '1', '--formats', 'gpkg')
        db = sqlite3.connect(os.path.join(out, 'buildings.gpkg'))
        ids = [row[0] for row in db.execute("select id from buildings where state = 'modelled' order by parts desc, footprint_area desc limit 3")]
        shutil.rmtree(out)
        return ids

    def text(self, out, folder):
        return ''.join(open(os.path.join(out, folder, name), encoding='utf-8').read() for name in sorted(os.listdir(os.path.join(out, folder))))

    def valid(self, out):
        run = blockrand('validate', out, '--progress', 'none')
        self.assertEqual(run.code, 0, run.err[-3000:] + run.out[-3000:])

    def test_all_outputs_have_the_model(self):
        for data in (SAMPLE, extract('berlin-zionskirchplatz-2020.osm')):
            if not data or not os.path.exists(data):
                continue
            first, second, third = self.some(data)
            glb(self.path('tower.glb'))
            glb(self.path('open.glb'), sides=SIDES[1:])
            orders = self.place('models.toml', ORDER.format(id=first, file='tower.glb', more='turn = 30') +
                                ORDER.format(id=second, file='open.glb', more='scale = 0.5\nlift = 1'))
            for lod in ('2', '3'):
                out = self.build(data, os.path.basename(data) + lod, '--lod', lod, '--formats', '3dtiles,citygml,cityjson,gpkg', '--overrides', orders)
                self.valid(out)
                db = sqlite3.connect(os.path.join(out, 'buildings.gpkg'))
                rows = {r[0]: r[1:] for r in db.execute('select id, origin, replaced_by, height, height_source, parts, fallbacks from buildings')}
                told = 'tower.glb; A. Mason; CC BY 4.0; https://example.org/tower.glb'
                self.assertEqual(rows[first], ('replaced', told, 20.0, 'override', 1, None))
                self.assertEqual(rows[second][0], 'replaced')
                self.assertAlmostEqual(rows[second][2], 11.0)  # ten metres and one of air
                self.assertEqual(rows[second][5], 'MODEL_NOT_CLOSED')
                self.assertEqual(rows[third][0], 'mapped')
                self.assertEqual(sum(r[0] == 'replaced' for r in rows.values()), 2)
                for folder in ('citygml', 'cityjson'):
                    text = self.text(out, folder)
                    self.assertIn(told, text)
                    self.assertIn('replaced', text)
                city = self.text(out, 'citygml')
                self.assertIn(f'<bldg:lod2Solid><Solid gml:id="{first}_lod2">', city)
                self.assertIn(f'<bldg:lod2MultiSurface><MultiSurface gml:id="{second}_lod2">', city)
                # Turned clockwise: its eight metres to the east run south of east now.
                solid = city[city.index(f'gml:id="{first}_lod2"'):]
                numbers = [list(map(float, ring[:ring.index('<')].split())) for ring in solid[:solid.index('</Solid>')].split('<posList>')[1:]]
                edges = {(round(r[i + 3] - r[i], 1), round(r[i + 4] - r[i + 1], 1)) for r in numbers for i in range(0, len(r) - 3, 3)}
                self.assertIn((6.9, -4.0), edges)
                report = read_json(out, 'report.json')
                self.assertEqual({r['id'] for r in report['notices'] if r['code'] == 'BUILDING_REPLACED'}, {first, second})
                self.assertIn('CC BY 4.0', json.dumps(report))
                told_model = ' '.join(blockrand('explain', out, first).out.split())
                self.assertIn(told, told_model)
                record = read_json(out, 'build.json')
                self.assertEqual({i['path'] for i in record['inputs'] if i['role'] == 'model'}, {'tower.glb', 'open.glb'})
                # A tile alone is that of the whole.
                tile = db.execute('select tile from buildings where id = ?', (first,)).fetchone()[0]
                alone = self.build(data, 'alone', '--lod', lod, '--formats', '3dtiles,citygml,cityjson', '--overrides', orders, '--tile', tile,
                                   '--pinned', os.path.join(out, 'build.json'))
                name = tile.replace('/', '_')
                for file in (os.path.join('citygml', name + '.gml'), os.path.join('cityjson', name + '.city.jsonl'), os.path.join('tiles', tile + '.glb')):
                    self.assertEqual(sha256(os.path.join(alone, file)), sha256(os.path.join(out, file)), file)
                shutil.rmtree(alone)
                again = self.build(data, 'same', '--lod', lod, '--formats', '3dtiles,citygml,cityjson,gpkg', '--overrides', orders, '-j', '1')
                self.same_files(out, again)
                shutil.rmtree(again)

    def test_kept_work_knows_the_model(self):
        first = self.some(SAMPLE)[0]
        glb(self.path('tower.glb'))
        orders, cache = self.place('kept.toml', ORDER.format(id=first, file='tower.glb', more='')), self.path('cache')
        before = self.build(SAMPLE, 'kept', '--lod', '2', '--overrides', orders, '--cache', cache)
        glb(self.path('tower.glb'), size=(8, 30, 12))
        after = self.build(SAMPLE, 'changed', '--lod', '2', '--overrides', orders, '--cache', cache)
        self.same_files(after, self.build(SAMPLE, 'clean', '--lod', '2', '--overrides', orders))
        self.assertNotEqual(self.text(before, 'citygml'), self.text(after, 'citygml'))

    def test_a_model_that_lies_where_it_says(self):
        '''CityGML of a build of ours, put in the place of the same house: it comes out where it was.'''
        first = self.some(SAMPLE)[2]  # a house of one body
        own = self.build(SAMPLE, 'own', '--lod', '2', '--formats', 'citygml')
        text = self.text(own, 'citygml')
        begin = text.index(f'<core:cityObjectMember><bldg:Building gml:id="{first}">')
        end = text.index('</core:cityObjectMember>', begin) + len('</core:cityObjectMember>')
        head = text[:text.index('<core:cityObjectMember>')]
        self.place('own.gml', head + text[begin:end] + '</core:CityModel>')
        orders = self.place('gml.toml', ORDER.format(id=first, file='own.gml', more=''))
        out = self.build(SAMPLE, 'again', '--lod', '2', '--formats', 'citygml', '--overrides', orders)
        self.valid(out)

        def corners(text):
            part = text[text.index(f'gml:id="{first}"'):]
            part = part[:part.index('</core:cityObjectMember>')]
            part = part[part.index('_lod2"'):]
            out = set()
            for piece in part.split('<posList>')[1:]:
                numbers = piece[:piece.index('<')].split()
                out |= {tuple(numbers[i:i + 3]) for i in range(0, len(numbers), 3)}
            return out
        self.assertEqual(corners(self.text(out, 'citygml')), corners(text))
        wrong = self.place('wrong.toml', ORDER.format(id=first, file='own.gml', more='turn = 3'))
        run = blockrand('build', SAMPLE, '-o', self.path('wrong'), '--overrides', wrong)
        self.assertEqual(run.code, 2, run)
        self.assertIn('place of its own', run.err)

    def test_what_cannot_be_read_is_refused_before_anything_is_written(self):
        first = self.some(SAMPLE)[0]
        glb(self.path('tower.glb'))
        with open(self.path('tower.glb'), 'rb') as f:
            whole = f.read()
        with open(self.path('cut.glb'), 'wb') as f:
            f.write(whole[:len(whole) // 2])
        for file, more, said in (('missing.glb', '', 'missing.glb'), ('cut.glb', '', 'cut.glb'), ('tower.glb', 'scale = 0', 'scale'),
                                 ('tower.glb', 'at = [200, 0]', 'no place'), ('tower.glb', 'size = 3', 'size')):
            orders = self.place('bad.toml', ORDER.format(id=first, file=file, more=more))
            run = blockrand('build', SAMPLE, '-o', self.path('bad'), '--overrides', orders)
            self.assertEqual(run.code, 2, (file, more, run))
            self.assertIn(said, run.err)
            self.assertFalse(os.path.exists(self.path('bad')))
        for text, said in ((f'[{first}.model]\nfile = "tower.glb"\nsource = "x"\n', 'licence'), (f'[{first}.model]\nfile = "tower.glb"\nlicence = "x"\n', 'source'),
                           (ORDER.format(id=first, file='tower.glb', more='') + f'[{first}]\npreset = "slab"\n', 'preset')):
            run = blockrand('build', SAMPLE, '-o', self.path('bad'), '--overrides', self.place('bad.toml', text))
            self.assertEqual(run.code, 2, run)
            self.assertIn(said, run.err)


if __name__ == '__main__':
    main()
