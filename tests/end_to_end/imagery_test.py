"""Aerial images: a village whose picture the test paints; the program must see which houses the map has elsewhere."""
import json
import math
import os
import random
import shutil
import sqlite3
import struct
import subprocess
import unittest
import xml.etree.ElementTree as ET
import zipfile

from blockrand_run import SAMPLE, BuildTest, blockrand, files_of, main, read_json
from osm_files import METRE, Node, Relation, Way, ring, write_xml

LON, LAT = 11.3, 51.4
STRETCH = 1 / math.cos(math.radians(LAT))
PIXEL = 0.25  # m
DEGREES_PRJ = ('GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],'
               'PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]')
SIDE = 340  # m, of the picture


def turned(points, angle, x, y):
    c, s = math.cos(angle), math.sin(angle)
    return [(x + px * c - py * s, y + px * s + py * c) for px, py in points]


def village(seed):
    """64 houses as [(x, y)] in m, east and north of the picture's south-west corner; no two alike."""
    r = random.Random(seed)
    houses = []
    for k in range(64):
        w, d, cut = r.uniform(8, 14), r.uniform(7, 12), r.uniform(2, 4)
        plan = [(0, 0), (w, 0), (w, d - cut), (w - cut, d - cut), (w - cut, d), (0, d)] if k % 2 else [(0, 0), (w, 0), (w, d), (0, d)]
        houses.append(turned(plan, r.uniform(0, 1.5), 50 + (k % 8) * 32 + r.uniform(-6, 6), 50 + (k // 8) * 30 + r.uniform(-5, 5)))
    return houses


def extract(houses, levels=lambda k: '1'):
    """`levels`: of house k as it is tagged; None: it is not."""
    objects = []
    for k, house in enumerate(houses):
        corners = [(LON + x * METRE * STRETCH, LAT + y * METRE) for x, y in house]
        tags = {'building': 'house', 'roof:shape': 'flat'}
        if levels(k):
            tags['building:levels'] = levels(k)
        objects += ring(1000 + 10 * k, 100 + k, corners, tags)
    return objects


def query(build, sql):
    db = sqlite3.connect(os.path.join(build, 'buildings.gpkg'))
    try:
        return db.execute(sql).fetchall()
    finally:
        db.close()


def middles(build, layer='buildings'):
    """{id: middle of the footprint's envelope} in metres of the build CRS."""
    found = {}
    for id, blob in query(build, f'SELECT id, geom FROM {layer}'):
        west, east, south, north = struct.unpack('<4d', blob[8:40])
        found[id] = ((west + east) / 2, (south + north) / 2)
    return found


def read_text(build, name):
    with open(os.path.join(build, name), encoding='utf-8') as f:
        return f.read()


class Picture:
    def __init__(self, houses, seed, shadows=()):
        """`shadows`: of each house (east, north) m, where that of its roof's edge ends."""
        r = random.Random(seed)
        self.side = int(SIDE / PIXEL)
        grass = bytes(70 + v % 40 for v in range(256))
        self.pixels = bytearray(r.randbytes(3 * self.side * self.side).translate(grass))
        for house, (east, north) in zip(houses, shadows):
            steps = int(math.hypot(east, north) / PIXEL) + 1
            for k in range(steps + 1):
                self.fill([(x + east * k / steps, y + north * k / steps) for x, y in house], bytes([32, 34, 38]))
        for house in houses:
            self.fill(house, bytes(r.choice([(190, 110, 80), (150, 150, 155), (205, 195, 180), (110, 60, 50)])))

    def fill(self, house, colour):
        """Even-odd, by pixel centres."""
        for row in range(self.side):
            y = SIDE - (row + .5) * PIXEL
            cuts = sorted(ax + (y - ay) * (bx - ax) / (by - ay) for (ax, ay), (bx, by) in zip(house, house[1:] + house[:1]) if (ay > y) != (by > y))
            for a, b in zip(cuts[::2], cuts[1::2]):
                i, j = max(0, math.ceil(a / PIXEL - .5)), min(self.side, math.ceil(b / PIXEL - .5))
                self.pixels[3 * (row * self.side + i):3 * (row * self.side + j)] = colour * (j - i)

    def write(self, path, mirrored=False, east=0.0, north=0.0, haze=0.0):
        """A PPM with world file and .prj; moved by metres, or mirrored; `haze`: share of white over all."""
        pixels = self.pixels.translate(bytes(int(v + haze * (215 - v)) for v in range(256))) if haze else self.pixels
        if mirrored:
            rows = [pixels[3 * self.side * r:3 * self.side * (r + 1)] for r in range(self.side)]
            pixels = b''.join(b''.join(bytes(row[3 * i:3 * i + 3]) for i in reversed(range(self.side))) for row in rows)
        with open(path, 'wb') as f:
            f.write(b'P6\n%d %d\n255\n' % (self.side, self.side) + bytes(pixels))
        step_x, step_y = PIXEL * METRE * STRETCH, PIXEL * METRE
        with open(os.path.splitext(path)[0] + '.wld', 'w') as f:
            f.write(f'{step_x:.12f}\n0\n0\n{-step_y:.12f}\n{LON + east * METRE * STRETCH + step_x / 2:.10f}\n'
                    f'{LAT + (north + SIDE) * METRE - step_y / 2:.10f}\n')
        with open(os.path.splitext(path)[0] + '.prj', 'w') as f:
            f.write(DEGREES_PRJ)
        return path


class Imagery(BuildTest):
    MOVED = {5: (1.8, -1.1), 18: (-2.0, 0.6), 27: (0.4, 2.2), 44: (1.2, 1.5), 58: (-1.5, -1.5)}  # m: where the map has them

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        houses = village(7)
        cls.picture = Picture(houses, 8)
        cls.image = cls.picture.write(os.path.join(cls.folder, 'village.ppm'))
        drawn = [[(x + cls.MOVED.get(k, (0, 0))[0], y + cls.MOVED.get(k, (0, 0))[1]) for x, y in h] for k, h in enumerate(houses)]
        cls.drawn = drawn
        cls.map = write_xml(os.path.join(cls.folder, 'village.osm'), extract(drawn))
        cls.truth = write_xml(os.path.join(cls.folder, 'true.osm'), extract(houses))

    def test_houses_that_the_map_has_elsewhere_are_told_and_the_others_are_not(self):
        out = self.build(self.map, 'report', '--imagery', self.image, '--lod', '1')
        imagery = read_json(out, 'imagery.json')
        self.assertEqual([i['state'] for i in imagery['images']], ['used'])
        seen = {b['id']: b for b in imagery['buildings']}
        self.assertEqual(len(seen), 64)
        for k in range(64):
            receipt = seen[f'w{100 + k}']
            if k not in self.MOVED:
                self.assertNotEqual(receipt['state'], 'corrected', receipt)
                continue
            self.assertEqual(receipt['state'], 'corrected', receipt)
            self.assertGreater(receipt['confidence'], 0.7)
            self.assertGreater(receipt['evidence_after'], receipt['evidence_before'])
            for said, put in zip(receipt['shift_m'], self.MOVED[k]):
                self.assertAlmostEqual(said, -put, delta=0.35, msg=receipt)
        record = read_json(out, 'build.json')
        files = [f['path'] for f in record['inputs'] if f['role'] == 'imagery']
        self.assertEqual([os.path.basename(f) for f in files], ['village.ppm', 'village.prj', 'village.wld'])
        self.assertEqual(files[0], self.image)
        self.assertEqual(record['imagery'][0]['state'], 'used')
        self.hashes_match(out)
        self.assertIn('5 seen elsewhere', self.last.out)
        # The map stays as it is drawn: only told is asked for.
        plain = self.build(self.map, 'plain', '--lod', '1')
        self.assertEqual(middles(out), middles(plain))
        self.assertNotIn('imagery.json', files_of(plain))
        self.assertNotIn('imagery', read_json(plain, 'build.json'))
        self.assertEqual(blockrand('validate', out).code, 0)

    def test_apply_moves_them_and_every_output_says_so(self):
        out = self.build(self.map, 'apply', '--imagery', self.image, '--imagery-correct', 'apply')
        self.assertIn('5 moved', self.last.out)
        self.assertEqual(blockrand('validate', out).code, 0)
        true = self.build(self.truth, 'true')
        there, wanted, mapped = (middles(f) for f in (out, true, self.build(self.map, 'mapped')))
        for k in range(64):
            house = f'w{100 + k}'
            if k in self.MOVED:
                self.assertLess(math.dist(there[house], wanted[house]), 0.35, house)
            else:
                self.assertEqual(there[house], mapped[house])
        self.assertEqual(middles(out, 'footprint_before'), mapped)
        states = dict(query(out, 'SELECT id, state FROM footprint_before'))
        self.assertEqual({i for i, state in states.items() if state == 'moved'}, {f'w{100 + k}' for k in self.MOVED})
        # The receipt stands in every format.
        gml = ''.join(read_text(out, f) for f in files_of(out) if f.endswith('.gml'))
        self.assertEqual(gml.count('<gen:stringAttribute name="imagery_state"><gen:value>moved<'), 5)
        self.assertIn('aerial image village.ppm, licence not stated', gml)
        features = [json.loads(line) for f in files_of(out) if f.endswith('.jsonl') for line in read_text(out, f).splitlines()[1:]]
        told = {i: o['attributes'] for feature in features for i, o in feature['CityObjects'].items() if o['type'] == 'Building'}
        self.assertEqual(told['w105']['imagery_state'], 'moved')
        self.assertAlmostEqual(told['w105']['imagery_shift_east'], -self.MOVED[5][0], delta=0.35)
        explained = blockrand('explain', out, 'w105', '--all')
        self.assertIn('as village.ppm shows it', ' '.join(explained.out.split()))
        receipt = json.loads(blockrand('explain', out, 'w105', '--json').out)['imagery']
        self.assertEqual((receipt['state'], receipt['image']), ('moved', 'village.ppm'))
        # Pictures: one of the tile, and the corrections on a page.
        picture, = [f for f in files_of(out) if f.startswith('imagery/') and f.endswith('.png')]
        width, height = struct.unpack('>2I', open(os.path.join(out, picture), 'rb').read(24)[16:])
        self.assertTrue(1000 < width < 2000 and 1000 < height < 2000, (width, height))
        page = read_text(out, 'imagery.html')
        self.assertEqual(page.count('<figure>'), 5)
        self.assertEqual(page.count('as village.ppm shows it'), 5)
        self.assertIn(f'href="{picture}"', page)
        ET.fromstring(page.split('\n', 1)[1].replace('<!DOCTYPE html>', ''))
        self.assertIn(os.path.join(out, picture), explained.out)
        # Roofs were painted in four colours: what stands is what the image shows.
        colours = dict(query(out, "SELECT id, roof_colour FROM buildings WHERE roof_colour_source = 'imagery'"))
        self.assertGreater(len(colours), 60)
        painted = [(190, 110, 80), (150, 150, 155), (205, 195, 180), (110, 60, 50)]
        for colour in colours.values():
            seen = tuple(int(colour[k:k + 2], 16) for k in (1, 3, 5))
            self.assertLess(min(math.dist(seen, p) for p in painted), 6, colour)
        # The outline as OpenStreetMap has it stays known.
        corner = json.loads(blockrand('explain', out, 'w105', '--json').out)['outline']
        before = json.loads(blockrand('explain', self.path('mapped'), 'w105', '--json').out)['outline']
        self.assertEqual(corner, before)
        # A tile that is built alone takes what the whole found.
        tile, = {f.split('/')[1] for f in files_of(out) if f.startswith('explain/') and f.endswith('.jsonl.gz')}
        alone = self.build(self.map, 'alone', '--tile', tile.split('.')[0].replace('_', '/'), '--pinned', os.path.join(out, 'build.json'))
        self.same_files(out, alone, 'tiles', 'citygml', 'cityjson', 'explain')
        self.assertEqual(blockrand('validate', alone).code, 0)
        self.assertEqual(read_json(alone, 'build.json')['imagery'], read_json(out, 'build.json')['imagery'])
        self.refused(blockrand('build', self.map, '-o', self.path('no'), '--tile', '15/1/1', '--pinned', os.path.join(out, 'build.json'), '--imagery', self.image), 1, 'leave out --imagery', target=self.path('no'))
        os.remove(os.path.join(out, 'imagery.json'))
        self.refused(blockrand('build', self.map, '-o', self.path('no'), '--lod', '2', '--tile', tile.split('.')[0].replace('_', '/'), '--pinned', os.path.join(out, 'build.json')), 2, 'imagery.json', target=self.path('no'))

    def test_explain_cuts_a_chip_out_of_the_image(self):
        out = self.build(self.map, 'chips', '--imagery', self.image, '--lod', '1')
        chip = self.path('chip.png')
        told = blockrand('explain', out, 'w105', '--chip', chip)
        self.assertEqual(told.code, 0, told.err)
        with open(chip, 'rb') as f:
            head = f.read(24)
        self.assertEqual(head[:8], b'\x89PNG\r\n\x1a\n')
        width, height = struct.unpack('>II', head[16:])
        # The house is 8 to 14 m wide, with 8 m about it and the shift, in pixels of at least 0.2 m, enlarged.
        self.assertGreater(min(width, height), 100)
        self.assertLess(max(width, height), 900)
        again = blockrand('explain', out, 'w105', '--chip', chip)
        self.assertEqual(again.code, 1, again.err)
        self.assertIn('is there already', again.err)
        nowhere = blockrand('explain', out, 'w105', '--chip', self.path('nowhere/chip.png'))
        self.assertEqual(nowhere.code, 4, nowhere.err)
        world, = [f for f in files_of(out) if f.endswith('.pgw')]
        with open(os.path.join(out, world), 'w') as f:
            f.write('0.2\n')
        damaged = blockrand('explain', out, 'w105', '--chip', self.path('damaged.png'))
        self.assertEqual(damaged.code, 2, damaged.err)
        self.assertIn('world file', damaged.err)
        plain = self.build(self.map, 'no-image', '--lod', '1')
        without = blockrand('explain', plain, 'w105', '--chip', self.path('other.png'))
        self.assertEqual(without.code, 2, without.err)
        self.assertIn('--imagery', without.err)
        self.assertFalse(os.path.exists(self.path('other.png')))
    def test_a_wall_that_the_map_has_elsewhere_is_shifted(self):
        """Of one house the east wall is drawn 0.8 m too far out, of another one too, of a third 0.7 m too far in; one of them has an entrance."""
        houses = village(7)
        drawn = [list(h) for h in self.drawn]
        off = {3: 0.8, 10: 0.8, 33: -0.7}
        for k, by in off.items():
            (ax, ay), (bx, by_), (cx, cy) = drawn[k][:3]
            length = math.hypot(bx - ax, by_ - ay)
            ux, uy = (bx - ax) / length, (by_ - ay) / length
            for n in (1, 2):
                x, y = drawn[k][n]
                drawn[k][n] = (x + by * ux, y + by * uy)
        objects = extract(drawn)
        (bx, by_), (cx, cy) = drawn[3][1:3]
        door = ((bx + cx) / 2, (by_ + cy) / 2)
        way, = [o for o in objects if isinstance(o, Way) and o.id == 103]
        way.refs.insert(2, 7000)
        source = write_xml(self.path('walls.osm'), objects + [Node(7000, LON + door[0] * METRE * STRETCH, LAT + door[1] * METRE, {'entrance': 'main'})])
        report = self.build(source, 'walls_report', '--imagery', self.image, '--lod', '1')
        seen = {b['id']: b for b in read_json(report, 'imagery.json')['buildings']}
        self.assertEqual({i for i, b in seen.items() if b.get('walls', {}).get('state') == 'refined'}, {f'w{100 + k}' for k in off}, {i: b.get('walls') for i, b in seen.items() if i in ('w103', 'w110', 'w133')})
        mapped = self.build(source, 'walls_mapped', '--lod', '1')
        self.assertEqual(middles(report), middles(mapped))
        out = self.build(source, 'walls_apply', '--imagery', self.image, '--imagery-correct', 'apply')
        self.assertEqual(blockrand('validate', out).code, 0, self.last)
        self.assertIn('walls of 3 shifted', self.last.out)
        there, wanted = middles(out), middles(self.build(self.truth, 'walls_true', '--lod', '1'))
        for k in off:
            self.assertLess(math.dist(there[f'w{100 + k}'], wanted[f'w{100 + k}']), 0.15, k)
            receipt = seen[f'w{100 + k}']['walls']
            self.assertEqual(receipt['shifted'], 1)
            self.assertAlmostEqual(receipt['largest_shift_m'], abs(off[k]), delta=0.15)
        self.assertEqual(middles(out, 'footprint_before'), middles(mapped))
        rows = dict(query(out, "SELECT id, state FROM footprint_before WHERE walls_shifted > 0"))
        self.assertEqual(rows, {f'w{100 + k}': 'reshaped' for k in off})
        self.assertIn('1 wall shifted by', ' '.join(blockrand('explain', out, 'w103', '--all').out.split()))
        self.assertIn('imagery_walls_shifted', ''.join(read_text(out, f) for f in files_of(out) if f.endswith('.gml')))
        self.assertIn('Single walls', read_text(out, 'imagery.html'))
        tile, = {f.split('/')[1] for f in files_of(out) if f.startswith('explain/') and f.endswith('.jsonl.gz')}
        alone = self.build(source, 'walls_alone', '--tile', tile.split('.')[0].replace('_', '/'), '--pinned', os.path.join(out, 'build.json'))
        self.same_files(out, alone, 'tiles', 'citygml', 'cityjson', 'explain')
        # Two threads or one, the same bytes; an override keeps a house; 0 looks for no walls.
        one = self.build(source, 'walls_one', '--imagery', self.image, '--imagery-correct', 'apply', '--jobs', '1')
        self.same_files(out, one, 'tiles', 'citygml', 'cityjson', 'explain', 'imagery.json')
        kept = self.build(source, 'walls_kept', '--imagery', self.image, '--imagery-correct', 'apply', '--lod', '0', '--formats', 'gpkg', '--overrides', self.place('walls.toml', '[w103]\nimagery = "off"\n'))
        self.assertEqual(read_json(kept, 'imagery.json')['buildings'][3]['walls']['state'], 'refused')
        self.assertEqual(middles(kept)['w103'], middles(mapped)['w103'])
        none = self.build(source, 'walls_none', '--imagery', self.image, '--imagery-refine', '0', '--lod', '0', '--formats', 'gpkg')
        self.assertFalse([b for b in read_json(none, 'imagery.json')['buildings'] if 'walls' in b])
        self.assertEqual(read_json(none, 'build.json')['configuration']['imagery_refine'], 0)
        self.refused(blockrand('build', source, '-o', self.path('no'), '--imagery', self.image, '--imagery-refine', '9'), 1, 'imagery-refine', target=self.path('no'))

    def test_shadows_tell_heights_of_houses_that_nobody_counted(self):
        """A third of the houses is tagged: by them the sun is measured, and the others by the sun."""
        storeys = [1 + (k * 7 + k // 8) % 3 for k in range(64)]
        azimuth, per_metre = math.radians(155), 1.1
        length = [per_metre * (3.1 * s + 0.3) for s in storeys]
        houses = village(11)
        picture = Picture(houses, 12, [(-math.sin(azimuth) * n, -math.cos(azimuth) * n) for n in length])
        image = picture.write(self.path('sunny.ppm'))
        source = write_xml(self.path('sunny.osm'), extract(houses, lambda k: str(storeys[k]) if k % 3 == 0 else None))
        out = self.build(source, 'sunny', '--imagery', image, '--lod', '2')
        imagery = read_json(out, 'imagery.json')
        self.assertAlmostEqual(imagery['images'][0]['shadow_sun_azimuth_deg'], 155, delta=10)
        self.assertAlmostEqual(imagery['images'][0]['shadow_per_metre'], per_metre, delta=0.15)
        told = {id: (count, source) for id, count, source in query(out, 'SELECT id, storeys, storeys_source FROM buildings')}
        seen = [k for k in range(64) if k % 3 and told[f'w{100 + k}'][1] == 'imagery']
        self.assertGreater(len(seen), 16, told)
        right = [k for k in seen if told[f'w{100 + k}'][0] == storeys[k]]
        self.assertGreater(len(right), 0.8 * len(seen), [(storeys[k], told[f'w{100 + k}']) for k in seen])
        self.assertEqual({told[f'w{100 + k}'] for k in range(0, 64, 3)}, {(s, 'tag') for s in (1, 2, 3)}, 'tags are stronger')
        words = blockrand('explain', out, f'w{100 + seen[0]}', '--all').out
        self.assertIn('a shadow of', words)
        self.assertEqual(blockrand('validate', out).code, 0)
        tile, = {f.split('/')[1] for f in files_of(out) if f.startswith('explain/') and f.endswith('.jsonl.gz')}
        alone = self.build(source, 'sunny_alone', '--tile', tile.split('.')[0].replace('_', '/'), '--pinned', os.path.join(out, 'build.json'))
        self.same_files(out, alone, 'tiles', 'citygml', 'cityjson', 'explain')

    def test_overrides_keep_houses_where_they_are_mapped(self):
        """One house by its id, another by an area around it."""
        x, y = sum(p[0] for p in self.drawn[18]) / len(self.drawn[18]), sum(p[1] for p in self.drawn[18]) / len(self.drawn[18])
        corners = [(LON + (x + dx) * METRE * STRETCH, LAT + (y + dy) * METRE) for dx, dy in ((-9, -9), (9, -9), (9, 9), (-9, 9))]
        source = write_xml(self.path('kept.osm'), extract(self.drawn) + ring(5000, 900, corners, {'landuse': 'residential'}))
        orders = self.place('o.toml', '[w105]\nimagery = "off"\n[w900]\nimagery = "off"\n')
        out = self.build(source, 'kept', '--imagery', self.image, '--imagery-correct', 'apply', '--overrides', orders, '--lod', '0', '--formats', 'gpkg')
        states = dict(query(out, 'SELECT id, state FROM footprint_before'))
        self.assertEqual([states[f'w{100 + k}'] for k in sorted(self.MOVED)], ['refused', 'refused', 'moved', 'moved', 'moved'])
        self.assertEqual(dict(query(out, 'SELECT id, reason FROM footprint_before'))['w118'], 'an override keeps it where it is mapped')
        self.assertEqual(read_json(out, 'report.json')['objects'], [])
        self.build(source, 'idle', '--overrides', orders, '--lod', '0', '--formats', 'gpkg')
        self.assertIn('imagery = "off" has nothing to act on', self.last.err)
        for text, word in (('[w105]\nimagery = "on"\n', 'no order'), ('[w105.w7]\nimagery = "off"\n', 'whole buildings')):
            self.refused(blockrand('build', source, '-o', self.path('no'), '--overrides', self.place('bad.toml', text)), 2, word, 'bad.toml', target=self.path('no'))

    def test_images_in_the_output_folder_are_not_removed(self):
        out = self.build(self.map, 'kept_image', '--lod', '0', '--formats', 'gpkg')
        image = self.picture.write(os.path.join(out, 'village.ppm'))
        run = blockrand('build', self.map, '-o', out, '--imagery', image, '--force', '--lod', '0', '--formats', 'gpkg')
        self.assertEqual(run.code, 1, run)
        self.assertTrue(os.path.exists(image))

    def test_any_number_of_jobs_says_the_same(self):
        for how in 'report', 'apply':
            one, five = (self.build(self.map, f'{how}{jobs}', '--imagery', self.image, '--imagery-correct', how, '--lod', '1', '--jobs', str(jobs)) for jobs in (1, 5))
            self.same_files(one, five)

    def test_an_image_that_does_not_fit_is_not_used(self):
        for name, how in (('shifted', dict(east=12, north=-9)), ('mirrored', dict(mirrored=True))):
            image = self.picture.write(self.path(f'{name}.ppm'), **how)
            out = self.build(self.map, name, '--imagery', image, '--lod', '0', '--formats', 'gpkg')
            self.assertIn('IMAGE_MISFIT', self.last.err)
            imagery = read_json(out, 'imagery.json')
            self.assertEqual([i['state'] for i in imagery['images']], ['misfit'], imagery['images'])
            self.assertEqual({b['state'] for b in imagery['buildings']}, {'outside'})
            strict = blockrand('build', self.map, '-o', self.path(name + '_strict'), '--imagery', image, '--lod', '0', '--formats', 'gpkg', '--strict')
            self.assertEqual(strict.code, 3, strict)
            self.assertIn('do not fit the map', strict.err)
        shifted = read_json(self.path('shifted'), 'imagery.json')['images'][0]
        self.assertAlmostEqual(shifted['shift_m'][0], 12, delta=1)
        self.assertAlmostEqual(shifted['shift_m'][1], -9, delta=1)

    def test_hazy_clouded_and_old_images_are_told(self):
        hazy = self.picture.write(self.path('hazy.ppm'), haze=0.5)
        config = self.place('old.toml', f'[[image]]\npath = "{hazy}"\ndate = "2016"\n')
        self.build(self.map, 'old', '--config', config, '--lod', '0', '--formats', 'gpkg')
        for words in ('hazy, its darkest places', '64 in it were edited after it was taken (2016)', "8 years older than the map's data (2024-05-01)"):
            self.assertIn(words, self.last.err)
        clouded = Picture(village(7), 8)
        clouded.fill([(30, 30), (140, 30), (140, 160), (30, 160)], bytes([231, 232, 235]))
        self.build(self.map, 'clouded', '--imagery', clouded.write(self.path('clouded.ppm')), '--lod', '0', '--formats', 'gpkg')
        self.assertIn('partly clouded', self.last.err)
        self.assertFalse([b for b in read_json(self.path('clouded'), 'imagery.json')['buildings'] if 'perhaps_gone' in b], 'a cloud is no lawn')
        self.build(self.map, 'clear', '--imagery', self.image, '--lod', '0', '--formats', 'gpkg')
        self.assertNotIn('.ppm', self.last.err)

    def test_what_stands_no_more_is_told_and_built_all_the_same(self):
        """A house that the map has on the lawn between the others."""
        houses = village(7)
        lawn = [(66, 66), (76, 66), (76, 74), (66, 74)]
        grass = Picture(houses, 8)
        for k in range(0, len(grass.pixels), 3):
            if max(grass.pixels[k:k + 3]) < 110:
                grass.pixels[k], grass.pixels[k + 2] = grass.pixels[k] * 3 // 4, grass.pixels[k + 2] * 2 // 3
        source = write_xml(self.path('gone.osm'), extract(houses + [lawn]))
        out = self.build(source, 'gone', '--imagery', grass.write(self.path('grass.ppm')), '--imagery-correct', 'apply', '--lod', '1')
        told = {b['id'] for b in read_json(out, 'imagery.json')['buildings'] if 'perhaps_gone' in b}
        self.assertEqual(told, {'w164'})
        self.assertIn('1 perhaps gone', self.last.out)
        self.assertIn('perhaps gone', blockrand('explain', out, 'w164', '--all').out)
        self.assertIn('Perhaps gone: 1', read_text(out, 'imagery.html'))
        self.assertGreater(query(out, "SELECT perhaps_gone FROM footprint_before WHERE id = 'w164'")[0][0], 0.8)
        self.assertIn('imagery_perhaps_gone', ''.join(read_text(out, f) for f in files_of(out) if f.endswith('.gml')))
        self.assertEqual(read_json(out, 'build.json')['counts']['models'], 65)
        self.assertEqual(blockrand('validate', out).code, 0)

    def test_what_is_painted_and_not_mapped_is_a_candidate(self):
        """Three houses that the map lacks; a drive and a lawn that are none."""
        houses = village(7)
        missing = (11, 20, 46)
        picture = Picture(houses, 8)
        picture.fill([(62, 60), (68, 60), (68, 74), (62, 74)], bytes([60, 125, 50]))
        picture.fill([(0, 32), (SIDE, 32), (SIDE, 37), (0, 37)], bytes([95, 95, 97]))
        image = picture.write(self.path('more.ppm'))
        config = self.place('more.toml', '[[image]]\npath = "more.ppm"\ndate = "2023-06"\nlicence = "CC BY 4.0"\n')
        mapped = [h for k, h in enumerate(houses) if k not in missing]
        source = write_xml(self.path('less.osm'), extract(mapped))
        out = self.build(source, 'less', '--config', config, '--lod', '1')
        imagery = read_json(out, 'imagery.json')
        told = imagery['unmapped']
        self.assertIn(f'; {len(told)} candidates for unmapped buildings', self.last.out)
        self.assertEqual(len(told), len(missing), [(u['outline'], u['probability']) for u in told + imagery['unmapped_unsure']])
        # Where they stand: by the house next to each, in the coordinates of the build.
        there = middles(self.build(write_xml(self.path('all.osm'), extract(houses)), 'all', '--lod', '0', '--formats', 'gpkg', '--no-report'))
        for k in missing:
            place = there[f'w{100 + k}']
            self.assertLess(min(math.dist(place, [sum(p[i] for p in u['outline']) / 4 for i in (0, 1)]) for u in told), 2.5, k)
        rows = query(out, 'SELECT id, probability, area, outline_of, image, image_date, licence FROM unmapped ORDER BY id')
        self.assertEqual([r[0] for r in rows], sorted(u['id'] for u in told))
        self.assertEqual({r[4:] for r in rows}, {('more.ppm', '2023-06', 'CC BY 4.0')})
        self.assertTrue(all(r[1] >= 0.85 and 20 <= r[2] <= 300 for r in rows), rows)
        self.assertIn('Perhaps not mapped: 3', read_text(out, 'imagery.html'))
        self.assertEqual(read_text(out, 'imagery.html').count('CC BY 4.0'), 2, 'in the list of images, and below the page')
        self.assertEqual(read_json(out, 'build.json')['counts']['models'], len(mapped), 'never a building by itself')
        self.assertEqual(blockrand('validate', out).code, 0)
        again = self.build(source, 'less_again', '--config', config, '--lod', '1', '--jobs', '1')
        self.same_files(out, again, 'imagery.json', 'imagery.html', 'buildings.gpkg')
        # Tiles alone have the candidates of the whole between them.
        tiles = sorted({f.split('/')[1] for f in files_of(out) if f.startswith('explain/') and f.endswith('.jsonl.gz')})
        ids = []
        for k, tile in enumerate(tiles):
            alone = self.build(source, f'less_alone_{k}', '--lod', '1', '--tile', tile.split('.')[0].replace('_', '/'), '--pinned', os.path.join(out, 'build.json'))
            ids += [u['id'] for u in read_json(alone, 'imagery.json')['unmapped']]
            self.assertEqual(blockrand('validate', alone).code, 0)
        self.assertEqual(sorted(ids), sorted(u['id'] for u in told))
        # Nothing is missing: no candidate. With outlines not looked for: none either.
        self.assertEqual(read_json(self.build(self.truth, 'none_less', '--imagery', image, '--lod', '0', '--formats', 'gpkg'), 'imagery.json')['unmapped'], [])
        self.assertNotIn('candidate', self.last.out)
        off = self.build(source, 'less_off', '--imagery', image, '--imagery-correct', 'off', '--lod', '0', '--formats', 'gpkg')
        self.assertEqual(read_json(off, 'imagery.json')['unmapped'], [])

    def test_courtyards_are_open_or_built_over(self):
        """Two houses that the map has with a hole: one is painted with lawn in it, the other is roof all over."""
        square = lambda x, y, half: [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)]
        blocks = [(120, 165), (220, 165)]
        others = [h for h in village(7) if all(abs(x - a) > 32 or abs(y - b) > 32 for x, y in h for a, b in blocks)]
        picture = Picture(others, 8)
        for k, (x, y) in enumerate(blocks):
            picture.fill(square(x, y, 16), bytes([178, 104, 82]))
            if k == 0:
                picture.fill(square(x, y, 7), bytes([70, 110, 60]))
        objects = extract(others)
        for k, (x, y) in enumerate(blocks):
            for j, half in enumerate((16, 7)):
                corners = [(LON + a * METRE * STRETCH, LAT + b * METRE) for a, b in square(x, y, half)]
                objects += ring(8000 + 100 * k + 10 * j, 800 + 10 * k + j, corners, {})
        objects += [Relation(900 + k, [('way', 800 + 10 * k, 'outer'), ('way', 801 + 10 * k, 'inner')],
                             {'type': 'multipolygon', 'building': 'house', 'building:levels': '1', 'roof:shape': 'flat'}) for k in range(2)]
        source = write_xml(self.path('court.osm'), objects)
        out = self.build(source, 'court', '--imagery', picture.write(self.path('court.ppm')), '--lod', '1')
        courts = {b['id']: b['courtyards'] for b in read_json(out, 'imagery.json')['buildings'] if 'courtyards' in b}
        self.assertEqual({i: [c['courtyard'] for c in cs] for i, cs in courts.items()}, {'r900': ['open'], 'r901': ['perhaps_built_over']}, courts)
        self.assertAlmostEqual(courts['r900'][0]['area_m2'], 196, delta=2)
        self.assertIn('perhaps built over', ' '.join(blockrand('explain', out, 'r901', '--all').out.split()))
        self.assertIn('courtyard: open', ' '.join(blockrand('explain', out, 'r900', '--all').out.split()))
        self.assertIn('Courtyards perhaps built over: 1', read_text(out, 'imagery.html'))
        gml = ''.join(read_text(out, f) for f in files_of(out) if f.endswith('.gml'))
        self.assertEqual(gml.count('<gen:stringAttribute name="imagery_courtyard">'), 2)
        self.assertEqual(blockrand('validate', out).code, 0)
        tile, = {f.split('/')[1] for f in files_of(out) if f.startswith('explain/') and f.endswith('.jsonl.gz')}
        alone = self.build(source, 'court_alone', '--lod', '1', '--tile', tile.split('.')[0].replace('_', '/'), '--pinned', os.path.join(out, 'build.json'))
        self.same_files(out, alone, 'tiles', 'citygml', 'cityjson', 'explain')

    def test_a_list_in_the_config_has_date_and_licence(self):
        config = self.place('c.toml', '[[image]]\npath = "village.ppm"\ndate = "2023-06"\nlicence = "CC BY 4.0"\nattribution = "The village"\n')
        out = self.build(self.map, 'listed', '--config', config, '--lod', '0', '--formats', 'gpkg')
        for image in (read_json(out, 'imagery.json')['images'][0], read_json(out, 'build.json')['imagery'][0]):
            self.assertEqual((image['date'], image['licence'], image['attribution']), ('2023-06', 'CC BY 4.0', 'The village'))
        for text, word in (('[[image]]\ndate = "2023"\n', 'path'), ('[[image]]\npath = "a.tif"\ndate = "June"\n', 'June'), ('[[image]]\npath = "a.tif"\nlicense = "x"\n', 'license')):
            self.refused(blockrand('build', self.map, '-o', self.path('no'), '--config', self.place('bad.toml', text)), 2, word, 'bad.toml', target=self.path('no'))

    def test_what_cannot_be_used_is_refused_before_anything_is_written(self):
        self.refused(blockrand('build', SAMPLE, '-o', self.path('no'), '--imagery', self.image), 2, 'shows nothing of the extract', 'village.ppm', target=self.path('no'))
        self.refused(blockrand('build', self.map, '-o', self.path('no'), '--imagery', self.path('none.tif')), 2, 'no such image', target=self.path('no'))
        self.refused(blockrand('build', self.map, '-o', self.path('no'), '--imagery', self.map), 2, 'no image', target=self.path('no'))
        self.refused(blockrand('build', self.map, '-o', self.path('no'), '--imagery', self.image, '--imagery-correct', 'aply'), 1, 'aply', target=self.path('no'))
        # One that shows something is enough.
        far = self.picture.write(self.path('far.ppm'), east=5000)
        out = self.build(self.map, 'two', '--imagery', far, '--imagery', self.image, '--lod', '0', '--formats', 'gpkg')
        self.assertIn('far.ppm: shows nothing of the extract', self.last.err)
        self.assertEqual([i['state'] for i in read_json(out, 'imagery.json')['images']], ['undecided', 'used'])

    @unittest.skipUnless(shutil.which('gdal_translate'), 'no gdal_translate')
    def test_odd_files_are_refused_or_read_and_never_break_it(self):
        def made(name, *options, source=self.image):
            subprocess.run(['gdal_translate', '-q', *options, source, self.path(name)], check=True, stderr=subprocess.DEVNULL)
            return self.path(name)
        whole = made('whole.tif', '-a_srs', 'EPSG:4326')
        with open(whole, 'rb') as f:
            start = f.read(300_000)
        with open(self.path('huge_and_empty.tif'), 'wb') as f:
            f.write(b'II*\0')
            f.truncate(10 * 2**30)  # sparse
        for path, word in ((self.place('cut.tif', start), 'cut short'), (made('one.tif', '-outsize', '1', '1', source=whole), 'pixels are'),
                           (made('wide.tif', '-outsize', '200000', '2', source=whole), 'pixels are'), (made('metres.tif', '-a_srs', 'EPSG:3857'), 'shows nothing of the extract'),
                           (made('alpha.tif', '-b', '1', '-colorinterp', 'alpha', source=whole), 'no band of colours'),
                           (self.path('huge_and_empty.tif'), 'no image that gdal can read'), (self.place('text.tif', 'no image'), 'no image')):
            self.refused(blockrand('build', self.map, '-o', self.path('no'), '--imagery', path), 2, word, os.path.basename(path), target=self.path('no'))
        for path, state in ((made('grey.tif', '-b', '1', source=whole), 'used'), (made('sixteen.tif', '-ot', 'UInt16', '-scale', '0', '255', '200', '2800', source=whole), 'used'),
                            (made('blank.tif', '-scale', '0', '255', '7', '7', source=whole), 'undecided')):
            out = self.build(self.map, os.path.basename(path)[:-4], '--imagery', path, '--lod', '0', '--formats', 'gpkg', '--no-report')
            self.assertEqual(read_json(out, 'imagery.json')['images'][0]['state'], state, path)

    def test_images_in_archives_and_mosaics(self):
        with zipfile.ZipFile(self.path('village.zip'), 'w') as z:
            for end in ('ppm', 'prj', 'wld'):
                z.write(self.path('village.' + end), 'village.' + end)
        out = self.build(self.map, 'zipped', '--imagery', '/vsizip/' + self.path('village.zip') + '/village.ppm', '--lod', '0', '--formats', 'gpkg', '--no-report')
        self.assertIn('5 seen elsewhere', self.last.out)
        self.assertEqual(len([f for f in read_json(out, 'build.json')['inputs'] if f['role'] == 'imagery']), 3)

    def test_a_row_moves_as_one_where_images_end_or_meet(self):
        """Four houses wall to wall, mapped beside where they stand; one picture ends behind the last of them, another shows two of them."""
        row = [[(170 + dx + 9 * k, 150 + dy) for dx, dy in ((0, 0), (9, 0), (9, 10 + k), (0, 10 + k))] for k in range(-2, 2)]
        others = [h for h in village(7) if all(abs(x - 170) > 30 or abs(y - 155) > 25 for x, y in h)]
        picture = Picture(others + row, 3)
        drawn = [[(x + 1.5, y + 1.2) for x, y in h] for h in row]
        source = write_xml(self.path('row.osm'), extract(others + drawn))
        end, begin = int(190 / PIXEL), int(165 / PIXEL)
        whole = picture.write(self.path('row.ppm'))
        for name, window in (('west', (0, end)), ('east', (begin, picture.side - begin))):
            subprocess.run(['gdal_translate', '-q', '-a_srs', 'EPSG:4326', '-srcwin', str(window[0]), '0', str(window[1]), str(picture.side), whole, self.path(name + '.tif')], check=True)
        for images in (['west'], ['west', 'east'], ['east', 'west']):
            out = self.build(source, '_'.join(images), *[a for i in images for a in ('--imagery', self.path(i + '.tif'))], '--imagery-correct', 'apply', '--lod', '1')
            receipts = {b['id']: b for b in read_json(out, 'imagery.json')['buildings']}
            said = {(r['state'], tuple(r['shift_m'])) for r in (receipts[f'w{100 + len(others) + k}'] for k in range(4))}
            self.assertEqual(len(said), 1, said)
            self.assertEqual(said.pop()[0], 'corrected')
            self.assertEqual(blockrand('validate', out).code, 0)

    def test_images_that_overlap_speak_for_and_against_each_other(self):
        """A second picture of another year has two of the moved houses elsewhere again, and all others where the first has them."""
        houses = village(7)
        for k, (east, north) in {5: (2.2, 1.4), 27: (-2.4, 0.8)}.items():
            houses[k] = [(x + east, y + north) for x, y in houses[k]]
        second = Picture(houses, 31).write(os.path.join(self.folder, 'other.ppm'))
        config = self.place('two.toml', f'[[image]]\npath = "{self.image}"\ndate = "2019"\n[[image]]\npath = "{second}"\ndate = "2022"\n')
        out = self.build(self.map, 'overlapping', '--config', config, '--lod', '0', '--formats', 'gpkg')
        seen = {b['id']: b for b in read_json(out, 'imagery.json')['buildings']}
        one = {b['id']: b for b in read_json(self.build(self.map, 'one_image', '--imagery', self.image, '--lod', '0', '--formats', 'gpkg'), 'imagery.json')['buildings']}
        for k in (5, 27):
            self.assertEqual(one[f'w{100 + k}']['state'], 'corrected')
            self.assertLess(seen[f'w{100 + k}']['confidence'], one[f'w{100 + k}']['confidence'])
        for k in (18, 44, 58):
            self.assertEqual(seen[f'w{100 + k}']['state'], 'corrected', seen[f'w{100 + k}'])
            self.assertGreater(seen[f'w{100 + k}']['confidence'], one[f'w{100 + k}']['confidence'])

    def test_an_image_that_shows_all_rows_off_alike_moves_none(self):
        shifted = self.picture.write(os.path.join(self.folder, 'shifted.ppm'), east=1.5, north=-1.0)
        out = self.build(self.truth, 'alike', '--imagery', shifted, '--imagery', self.image, '--imagery-correct', 'apply', '--lod', '0', '--formats', 'gpkg')
        moved = [b['id'] for b in read_json(out, 'imagery.json')['buildings'] if b['state'] == 'corrected']
        self.assertEqual(moved, [])
        self.assertEqual(middles(out), middles(self.build(self.truth, 'alike_mapped', '--lod', '0', '--formats', 'gpkg')))

    def test_a_house_mapped_twice_stays_one(self):
        drawn = [h for h in self.drawn]
        twice = [(x + 0.13, y) for x, y in drawn[5]]
        source = write_xml(self.path('twice.osm'), extract(drawn + [twice]))
        plain = self.build(source, 'twice_plain', '--lod', '1')
        models = read_json(plain, 'build.json')['counts']['models']
        moved = self.build(source, 'twice_moved', '--imagery', self.image, '--imagery-correct', 'apply', '--lod', '1')
        self.assertEqual(read_json(moved, 'build.json')['counts']['models'], models)

    def test_off_looks_at_roofs_alone(self):
        out = self.build(self.map, 'off', '--imagery', self.image, '--imagery-correct', 'off', '--lod', '0', '--formats', 'gpkg', '--no-report')
        imagery = read_json(out, 'imagery.json')
        self.assertEqual(imagery['images'][0]['state'], 'used')
        self.assertEqual({(b['state'], b['reason']) for b in imagery['buildings']}, {('undecided', 'outlines were not to be looked for')})
        self.assertTrue(all('roof_colour' in b for b in imagery['buildings']))
        self.assertEqual([f for f in files_of(out) if f.startswith('imagery')], ['imagery.json'])


if __name__ == '__main__':
    main()
