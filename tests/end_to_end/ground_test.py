"""The ground as aerial images show it: a picture for each tile on a mesh that its neighbours meet."""
import os
import shutil
import zlib

import validators
from blockrand_run import BuildTest, blockrand, files_of, main, read_json, sha256
from imagery_test import LAT, LON, SIDE, STRETCH, Picture, extract as drawn, village
from model_files import Glb
from osm_files import METRE, ring, write_xml

LICENCE, GIVER = 'CC BY 4.0', 'Land survey of the test'


def grounds(folder):
    return [name for name in files_of(folder, '_ground.glb') if name.startswith('tiles')]


def png_pixels(path):
    """(width, rows of RGB bytes) of an 8-bit PNG without interlacing."""
    with open(path, 'rb') as f:
        data = f.read()
    at, body, width = 8, b'', 0
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], 'big'), data[at + 4:at + 8]
        chunk = data[at + 8:at + 8 + size]
        if kind == b'IHDR':
            width, height = int.from_bytes(chunk[:4], 'big'), int.from_bytes(chunk[4:8], 'big')
            assert chunk[8:13] == b'\x08\x02\0\0\0', chunk
        elif kind == b'IDAT':
            body += chunk
        at += 12 + size
    raw, stride, rows, above = zlib.decompress(body), 3 * width, [], bytes(3 * width)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = line[i - 3] if i >= 3 else 0, above[i], above[i - 3] if i >= 3 else 0
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        rows.append(bytes(line))
        above = bytes(line)
    return width, rows


class Ground(BuildTest):
    def setUp(self):
        houses = village(5)
        self.map = self.path('map.osm')
        # A house outside of the picture: its tile, or a part of it, has none.
        far = [(LON + x * METRE * STRETCH, LAT + y * METRE) for x, y in ((1200, 20), (1212, 20), (1212, 30), (1200, 30))]
        write_xml(self.map, drawn(houses) + ring(9000, 900, far, {'building': 'house'}))
        self.image = self.path('village.ppm')
        picture = Picture(houses, 3)
        # A mark that no house covers: 4 m, in the picture's south-west.
        picture.fill([(10, 10), (14, 10), (14, 14), (10, 14)], bytes([250, 10, 240]))
        picture.write(self.image)
        self.config = self.place('images.toml', f'[[image]]\npath = "{self.image}"\nlicence = "{LICENCE}"\nattribution = "{GIVER}"\n')
        self.options = ('--config', self.config, '--lod', '2', '--formats', 'gltf,citygml', '--no-report')

    def test_the_image_lies_on_the_ground(self):
        out = self.build(self.map, 'out', *self.options, '--ground', 'imagery', '--single-glb')
        self.assertIn('no image shows', self.last.out)
        self.assertIn('pixels of 0.25', ' '.join((self.last.out + self.last.err).split()))
        self.assertEqual(validators.problems(out), '')
        plain = self.build(self.map, 'plain', *self.options)
        self.assertEqual([name for name in files_of(plain) if 'ground' in name], [])
        for name in files_of(plain, '.gml', '.glb'):
            self.assertEqual(sha256(os.path.join(plain, name)), sha256(os.path.join(out, name)), name)
        bare = shown = 0
        for name in grounds(out):
            glb = Glb(os.path.join(out, name))
            self.assertIn(LICENCE, glb.json['asset']['copyright'])
            self.assertIn(GIVER, glb.json['asset']['copyright'])
            for mesh in glb.json['meshes']:
                for p in mesh['primitives']:
                    cells = glb.json['accessors'][p['indices']]['count'] // 6
                    if 'baseColorTexture' in glb.json['materials'][p['material']]['pbrMetallicRoughness']:
                        shown += cells
                    else:
                        bare += cells
        # Cells of 12.5 m that touch the picture, about.
        self.assertAlmostEqual(shown, (SIDE / 12.5) ** 2, delta=4 * SIDE / 12.5 + 8)
        self.assertGreater(bare, shown)
        self.assertIn(GIVER, str(read_json(out, 'tileset.json')['asset']))
        # Somewhere in the pictures is the mark, and it is as large as it was painted.
        marked = 0
        for name in files_of(out, '_ground.png'):
            width, rows = png_pixels(os.path.join(out, name))
            self.assertLessEqual(max(width, len(rows)), 1024)
            marked += sum(row[i] > 200 and row[i + 1] < 80 and row[i + 2] > 190 for row in rows for i in range(0, 3 * width, 3))
        self.assertGreater(marked, 4)
        self.assertLess(marked, 60)
        model = Glb(os.path.join(out, 'ground.glb')).json
        for image in model['images']:
            self.assertTrue(os.path.exists(os.path.join(out, image['uri'])), image)
        # A picture that is gone is noticed.
        os.remove(os.path.join(out, files_of(out, '_ground.webp')[0]))
        self.assertNotEqual(blockrand('validate', out).code, 0)

    def test_tiles_meet_and_are_the_same_alone(self):
        out = self.build(self.map, 'whole', *self.options, '--ground', 'imagery', '--ground-pixel', '1')
        self.assertGreater(len(grounds(out)), 1)
        for name in grounds(out):
            tile = name[len('tiles/'):-len('_ground.glb')]
            alone = self.build(self.map, 'alone', *self.options, '--ground', 'imagery', '--ground-pixel', '1', '--tile', tile,
                               '--pinned', os.path.join(out, 'build.json'))
            for file in files_of(alone, '.glb', '.webp', '.png'):
                self.assertEqual(sha256(os.path.join(out, file)), sha256(os.path.join(alone, file)), file)
            shutil.rmtree(alone)
        two = self.build(self.map, 'two', *self.options, '--ground', 'imagery', '--ground-pixel', '1', '--jobs', '1')
        self.same_files(out, two, 'tiles')

    def test_it_replaces_the_ground_around(self):
        lands = self.build(self.map, 'lands', *self.options, '--surroundings', 'on')
        both = self.build(self.map, 'both', *self.options, '--surroundings', 'on', '--ground', 'imagery')
        size = lambda folder: sum(os.path.getsize(os.path.join(folder, n)) for n in files_of(folder, '_surroundings.glb'))
        self.assertGreater(size(lands), 0)
        self.assertLess(size(both), size(lands))
        self.assertEqual(validators.problems(both), '')
        for name in files_of(lands, '.gml'):
            self.assertEqual(sha256(os.path.join(lands, name)), sha256(os.path.join(both, name)), name)

    def test_what_cannot_be_is_refused(self):
        target = self.path('refused')
        self.refused(blockrand('build', self.map, '-o', target, '--ground', 'imagery'), 1, '--imagery', target=target)
        self.refused(blockrand('build', self.map, '-o', target, '--ground', 'golden'), 1, 'golden', 'imagery', target=target)
        self.refused(blockrand('build', self.map, '-o', target, '--imagery', self.image, '--ground', 'imagery', '--areas', '2'), 1, '--imagery', target=target)


if __name__ == '__main__':
    main()
