"""model.glb where people open it: Blender, f3d, assimp and three.js read it and find every house by its name.

    importers_test.py [--pictures FOLDER]    keeps the pictures there

What is not installed is passed over with a word.
"""
import json
import os
import re
import shutil
import struct
import sys
import unittest
import zlib

import validators
from blockrand_run import SAMPLE, BuildTest, Setup, call, extract, main, pictures_folder, read_json
from model_files import Glb

PICTURES = None  # folder that keeps the pictures

# Tells what Blender has after importing a file. Debian's Blender 3.4 asks numpy for a name that Debian's numpy has no more.
IN_BLENDER = '''
import json, sys, time
import numpy
if not hasattr(numpy, 'bool'):
    numpy.bool = bool
import bpy
file, out = sys.argv[sys.argv.index('--') + 1:]
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
before = time.process_time()
bpy.ops.import_scene.gltf(filepath=file)
seconds = time.process_time() - before
bpy.context.view_layer.update()
things = []
for o in bpy.data.objects:
    mesh = o.data if o.type == 'MESH' else None
    corners = [o.matrix_world @ v.co for v in mesh.vertices] if mesh else []
    things.append({'name': o.name, 'parent': o.parent.name if o.parent else None, 'id': o.get('id'),
                   'faces': len(mesh.polygons) if mesh else 0, 'smooth': sum(p.use_smooth for p in mesh.polygons) if mesh else 0,
                   'materials': [m.name for m in mesh.materials] if mesh else [],
                   'box': [[f(c[i] for c in corners) for i in range(3)] for f in (min, max)] if corners else None})
with open(out, 'w') as f:
    json.dump({'seconds': seconds, 'objects': things}, f)
'''


def houses_of(glb):
    """[(node of the house, nodes of its parts)]"""
    nodes = glb.json['nodes']
    houses = [nodes[number] for number in glb.json['scenes'][0]['nodes']]
    return [(house, [nodes[child] for child in house['children']]) for house in houses]


def triangles_of(glb, mesh):
    return sum(glb.json['accessors'][p['indices']]['count'] // 3 for p in glb.json['meshes'][mesh]['primitives'])


def colours_of_png(path):
    """How many different colours a picture has, by three bits a channel, and which share of it is not the commonest one."""
    with open(path, 'rb') as f:
        data = f.read()
    width, height, depth, kind = struct.unpack('>IIBB', data[16:26])
    channels = {2: 3, 6: 4}[kind]
    assert depth == 8, depth
    packed, at = b'', 8
    while at < len(data):
        size, name = struct.unpack('>I4s', data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if name == b'IDAT' else b''
        at += size + 12
    raw, stride = zlib.decompress(packed), width * channels
    counts, above = {}, bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        filter_type, line = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride if filter_type else 0):
            left, up = line[i - channels] if i >= channels else 0, above[i]
            corner = above[i - channels] if i >= channels else 0
            guess = left + up - corner
            paeth = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[filter_type]) & 255
        above = line
        for i in range(0, stride, channels):
            colour = line[i] >> 5, line[i + 1] >> 5, line[i + 2] >> 5
            counts[colour] = counts.get(colour, 0) + 1
    return len(counts), 1 - max(counts.values()) / (width * height)


class Model(BuildTest):
    """The sample with facades as one file."""
    source, options = SAMPLE, ('--lod', '3', '--surroundings', 'off')

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.needs()
        cls.out = cls().build(cls.source, 'out', *cls.options, '--formats', 'gltf', '--single-glb', '--no-report', '--no-explain')
        cls.file = os.path.join(cls.out, 'model.glb')
        cls.glb = Glb(cls.file)
        cls.houses = houses_of(cls.glb)

    @classmethod
    def needs(cls):
        """Raises SkipTest where the program is not there."""
        raise unittest.SkipTest('a base class')

    def picture(self, name):
        return os.path.join(PICTURES, name) if PICTURES else self.path(name)

    def drawn(self, path):
        colours, share = colours_of_png(path)
        self.assertGreater(colours, 12, 'walls, roofs and windows have different colours')
        self.assertTrue(0.02 < share < 0.99, share)


class ByBlender(Model):
    @classmethod
    def needs(cls):
        if not shutil.which('blender'):
            raise unittest.SkipTest('blender is not installed')

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        script, seen = os.path.join(cls.folder, 'look.py'), os.path.join(cls.folder, 'seen.json')
        with open(script, 'w', encoding='utf-8') as f:
            f.write(IN_BLENDER)
        # Debian's Blender takes the modules of the first python3 in the path, which must be Debian's as well.
        run = call(['blender', '-b', '--factory-startup', '--python-exit-code', '9', '--python', script, '--', cls.file, seen],
                   env={'PATH': '/usr/bin:/bin'})
        if "No module named 'numpy'" in run.out + run.err:
            raise unittest.SkipTest('blender finds no numpy (package python3-numpy)')
        if run.code != 0:
            raise AssertionError(str(run))
        cls.seen = read_json(seen)

    def test_every_house_and_part_is_an_object(self):
        print(f"{len(self.houses)} houses: {self.seen['seconds']:.1f} CPU s in Blender")
        by_id = {}
        for thing in self.seen['objects']:
            by_id.setdefault((thing['id'], thing['parent'] is None), []).append(thing)
        self.assertTrue(all(len(same) == 1 for same in by_id.values()))
        self.assertEqual(len(self.seen['objects']), len(self.houses) + sum(len(parts) for _, parts in self.houses))
        for house, parts in self.houses:
            (parent,) = by_id[house['extras']['id'], True]
            # Of two objects with one name Blender calls the second one "name.001".
            self.assertEqual(re.sub(r'\.\d{3}$', '', parent['name']), house['name'])
            for part in parts:
                (child,) = by_id[part['extras']['id'], False]
                self.assertEqual(child['parent'], parent['name'])
                # Blender drops triangles that it finds twice.
                self.assertAlmostEqual(child['faces'], triangles_of(self.glb, part['mesh']), delta=0.001 * child['faces'])
                self.assertGreaterEqual(child['faces'], 8)
                self.assertEqual(child['smooth'], 0)
                names = [self.glb.json['materials'][p['material']]['name'] for p in self.glb.json['meshes'][part['mesh']]['primitives']]
                self.assertEqual(sorted(child['materials']), sorted(set(names)))

    def test_it_stands_where_it_should(self):
        """Blender's axes are x east, y north, z up."""
        boxes = {thing['id']: thing['box'] for thing in self.seen['objects'] if thing['box']}
        ids, low, high = self.glb.texts('id'), {}, {}
        for row, place in self.glb.vertices():
            key = ids[row]
            low[key] = tuple(map(min, low.get(key, place), place))
            high[key] = tuple(map(max, high.get(key, place), place))
        self.assertEqual(set(boxes), set(low))
        for key, box in boxes.items():
            for axis in range(3):
                self.assertAlmostEqual(box[0][axis], low[key][axis], delta=1e-3)
                self.assertAlmostEqual(box[1][axis], high[key][axis], delta=1e-3)


class QuarterByBlender(ByBlender):
    """Four hundred Berlin houses."""
    @classmethod
    def needs(cls):
        super().needs()
        cls.source = extract('berlin-zionskirchplatz-2020.osm')
        if not cls.source:
            raise unittest.SkipTest('berlin-zionskirchplatz-2020.osm is not in the shared data')

    test_it_stands_where_it_should = None  # the sample tells, with fewer vertices


class ByF3d(Model):
    @classmethod
    def needs(cls):
        for tool, package in (('f3d', 'f3d'), ('xvfb-run', 'xvfb')):
            if not shutil.which(tool):
                raise unittest.SkipTest(f'{tool} is not installed (package {package})')

    def test_it_draws(self):
        picture = self.picture('f3d.png')
        run = call(['xvfb-run', '-a', 'f3d', self.file, '--dry-run', '--verbose', f'--output={picture}', '--resolution=640,400',
                    '--camera-elevation-angle=35'])
        self.assertEqual(run.code, 0, run)
        self.assertNotIn('ERR', run.out + run.err)
        # A block of text for each primitive.
        count = sum(len(mesh['primitives']) for mesh in self.glb.json['meshes'])
        polygons = [int(n) for n in re.findall(r'Number of polygons: (\d+)', run.out)]
        self.assertEqual((len(polygons), sum(polygons)),
                         (count, sum(triangles_of(self.glb, mesh) for mesh in range(len(self.glb.json['meshes'])))))
        self.drawn(picture)


class SharedMeshesByF3d(ByF3d):
    """With --instancing nodes: a part of the sample, since every window is something to draw by itself."""
    options = ('--lod', '3', '--surroundings', 'off', '--instancing', 'nodes', '--bbox', '11.0290,51.4690,11.0305,51.4700')

    def test_it_draws(self):
        picture = self.picture('f3d_nodes.png')
        run = call(['xvfb-run', '-a', 'f3d', self.file, '--dry-run', f'--output={picture}', '--resolution=640,400',
                    '--camera-elevation-angle=35'])
        self.assertEqual(run.code, 0, run)
        self.drawn(picture)


class ByAssimp(Model):
    @classmethod
    def needs(cls):
        if not shutil.which('assimp'):
            raise unittest.SkipTest('assimp is not installed (package assimp-utils)')

    def test_counts_and_names(self):
        run = call(['assimp', 'info', self.file])
        self.assertEqual(run.code, 0, run)
        self.assertNotIn('ERROR', run.out + run.err)
        said = {k: int(n) for k, n in re.findall(r'(?m)^(Nodes|Meshes|Faces|Materials): +(\d+)', run.out)}
        # assimp puts a node above all others, and joins materials that differ by name alone and meshes that are nearly equal: two
        # houses of the sample differ by 3 mm.
        looks = [json.dumps({k: v for k, v in m.items() if k != 'name'}, sort_keys=True) for m in self.glb.json['materials']]
        faces = [(tuple(round(c, 1) for at in self.glb.accessor(p['attributes']['POSITION']) for c in at),
                  self.glb.accessor(p['indices']), looks[p['material']])
                 for mesh in self.glb.json['meshes'] for p in mesh['primitives']]
        distinct = {(at, tuple(indices), look): len(indices) // 3 for at, indices, look in faces}
        self.assertEqual(said['Nodes'], len(self.glb.json['nodes']) + 1)
        self.assertTrue(len(distinct) <= said['Meshes'] <= len(faces), (len(distinct), said, len(faces)))
        self.assertGreater(len(distinct), 0.9 * len(faces), 'else the bounds say nothing')
        all_faces = sum(len(indices) // 3 for _, indices, _ in faces)
        self.assertTrue(sum(distinct.values()) <= said['Faces'] <= all_faces, (sum(distinct.values()), said, all_faces))
        self.assertTrue(0.7 * len(self.glb.json['materials']) < said['Materials'] <= len(self.glb.json['materials']), said)
        for house, _ in self.houses[:50]:
            self.assertIn(house['name'][:30], run.out)


class ByThree(Model):
    @classmethod
    def needs(cls):
        if not shutil.which('node') and not shutil.which('nodejs'):
            raise unittest.SkipTest('node is not installed')
        if not Setup.node_modules:
            raise unittest.SkipTest('no node_modules: npm install with tests/validators/package.json')

    def test_the_browser_shows_every_house(self):
        picture = self.picture('three.png')
        run = call([shutil.which('node') or shutil.which('nodejs'), os.path.join(validators.VALIDATORS, 'model_viewer.mjs'), self.file,
                    os.path.abspath(Setup.node_modules), picture], timeout=850)
        if run.code == 77:
            self.skipTest(run.err.strip())
        self.assertEqual(run.code, 0, run)
        seen = json.loads(run.out)
        self.assertEqual(seen['messages'], [])
        self.assertEqual(seen['houses'], [[house['extras']['id'], house['name'], len(parts)] for house, parts in self.houses])
        self.assertEqual(seen['meshes'], sum(len(mesh['primitives']) for mesh in self.glb.json['meshes']))
        self.assertEqual(seen['triangles'], sum(triangles_of(self.glb, mesh) for mesh in range(len(self.glb.json['meshes']))))
        self.assertEqual(seen['empty'], 0)
        self.assertEqual(seen['smooth'], 0, 'without normals everything is shaded flat')
        self.drawn(picture)


del Model  # nothing to run by itself

if __name__ == '__main__':
    PICTURES, others = pictures_folder(sys.argv[1:])
    main(others)
