"""Masonry fitted to walls: the row of samples/masonry, measured on the written CityJSON by arithmetic of this test's own."""
import collections
import glob
import json
import math
import os
import re
import shutil

from blockrand_run import SOURCE, BuildTest, blockrand, main, read_json

ROW = os.path.join(SOURCE, 'samples', 'masonry')
BRICK, ASHLAR, CYCLOPEAN = 'w1', 'w2', 'w3'
RELIEF = (0.004, 0.031)  # m before the wall: mortar at 6 mm, stones up to 3 cm; points lie on a grid of 1/1024 m


def read_row(out):
    """Header and {id: feature} of the CityJSONSeq files."""
    header, found = None, {}
    for path in sorted(glob.glob(os.path.join(out, 'cityjson', '*.jsonl'))):
        with open(path, encoding='utf-8') as f:
            lines = [json.loads(line) for line in f]
        header = lines[0]
        found.update({feature['id']: feature for feature in lines[1:]})
    return header, found


def is_masonry(name, thing):
    return thing['type'] == 'BuildingInstallation' and thing['attributes'].get('function') == 'masonry'


class House:
    def __init__(self, feature, header):
        self.feature = feature
        scale, shift = header['transform']['scale'], header['transform']['translate']
        self.points = [tuple(v[i] * scale[i] + shift[i] for i in range(3)) for v in feature['vertices']]
        self.templates = header.get('geometry-templates', {'templates': [], 'vertices-templates': []})
        self.building = feature['CityObjects'][feature['id']]
        self.ground = self.building['attributes']['ground_height']

    def pieces(self):
        """Polygons of the stones, in metres of the build, by the placement that they belong to."""
        for name, thing in self.feature['CityObjects'].items():
            if not is_masonry(name, thing):
                continue
            for geometry in thing['geometry']:
                template = self.templates['templates'][geometry['template']]
                origin, matrix = self.points[geometry['boundaries'][0]], geometry['transformationMatrix']
                place = lambda v: tuple(origin[r] + sum(matrix[4 * r + c] * v[c] for c in range(3)) + matrix[4 * r + 3]
                                        for r in range(3))
                vertices = self.templates['vertices-templates']
                yield [[place(vertices[i]) for i in face[0]] for face in template['boundaries']]

    def walls(self):
        """(a point, outward normal) of the upright faces of the LoD3 solid that are no reveals: those of the outline."""
        ring = next(g for g in self.building['geometry'] if g.get('lod') == '0')['boundaries'][0][0]
        ring = [self.points[i] for i in ring]
        area = sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(ring, ring[1:] + ring[:1]))
        for p, q in zip(ring, ring[1:] + ring[:1]):
            length = math.dist(p[:2], q[:2])
            sign = 1 if area > 0 else -1
            yield p, (sign * (q[1] - p[1]) / length, sign * (p[0] - q[0]) / length), length


def fronts(polygons, wall):
    """Polygons that lie flat before a wall, as (distance, polygon)."""
    (x, y, _), (nx, ny), _ = wall
    for polygon in polygons:
        far = [(p[0] - x) * nx + (p[1] - y) * ny for p in polygon]
        along = [(p[1] - y) * nx - (p[0] - x) * ny for p in polygon]
        # Sides of stones at the corner lie across: they are as wide as stones stand out.
        if max(far) - min(far) < 0.002 and abs(far[0]) < 0.05 and max(along) - min(along) > 0.035:
            yield sum(far) / len(far), polygon


class Masonry(BuildTest):
    def row(self, name, masonry='fitted', more=''):
        rules = os.path.join(self.folder, name)
        shutil.copytree(ROW, rules)
        path = os.path.join(rules, 'masonry.toml')
        with open(path, encoding='utf-8') as f:
            text = f.read().replace('masonry = "fitted"', f'masonry = "{masonry}"{more}')
        with open(path, 'w', encoding='utf-8') as f:
            f.write(text)
        return self.build(os.path.join(ROW, 'row.osm'), name + '_out', '--lod', '3', '--surroundings', 'off', '--formats',
                          'cityjson,citygml,gltf', '--districts', path)

    def test_stones_of_the_row(self):
        header, found = read_row(self.row('stones'))
        self.assertEqual(set(found), {BRICK, ASHLAR, CYCLOPEAN})
        for name, feature in found.items():
            house = House(feature, header)
            pieces = [p for placement in house.pieces() for p in placement]
            self.assertGreater(len(pieces), 500, name)
            walls = list(house.walls())
            self.assertEqual(len(walls), 4)
            stones = 0
            levels = collections.Counter()
            for wall in walls:
                for far, polygon in fronts(pieces, wall):
                    self.assertGreater(far, RELIEF[0], name)  # before the solid
                    self.assertLess(far, RELIEF[1], name)
                    if far > 0.009:  # mortar lies at 6 mm
                        stones += 1
                        if len(polygon) == 4:
                            levels[round((min(p[2] for p in polygon) - house.ground), 3)] += 1
            area = sum(w[2] for w in walls) * 6.5 + 2 * 9 * 3 / 2
            openings = 0.25 * area
            # Reichsformat in Flemish bond: 130 x 77 and 260 x 77 mm in turn, 66.6 a m2; ashlar of 0.63 x 0.31, 5.1; cells of 0.62 x
            # 0.54 in a hexagonal grid, 3.4, and quoins.
            per_m2 = {BRICK: 66.6, ASHLAR: 5.1, CYCLOPEAN: 3.4}[name]
            self.assertGreater(stones, 0.75 * per_m2 * (area - openings), name)
            self.assertLess(stones, 1.7 * per_m2 * area, name)
            if name == BRICK:  # courses: 77 mm each, from the ground
                on_course = sum(n for z, n in levels.items() if abs((z - 0.008) / 0.077 - round((z - 0.008) / 0.077)) < 0.04)
                self.assertGreater(on_course, 0.9 * sum(levels.values()))

    def test_the_building_itself_stays_as_it_is(self):
        with_stones, without = self.row('with'), self.row('without', 'none')
        (_, laid), (_, bare) = read_row(with_stones), read_row(without)
        self.assertEqual(set(laid), set(bare))
        for name in laid:
            def lean(feature):
                objects = []
                for key, thing in feature['CityObjects'].items():
                    if is_masonry(key, thing):
                        continue
                    thing = json.loads(json.dumps(thing))
                    thing.pop('children', None)  # installations are numbered: those that come after the stones have other numbers
                    thing.pop('parents', None)
                    for geometry in thing.get('geometry', []):
                        if 'template' in geometry:
                            geometry['template'] = None
                        def resolve(b):
                            return [resolve(x) for x in b] if isinstance(b, list) else feature['vertices'][b]
                        geometry['boundaries'] = resolve(geometry['boundaries'])
                    objects.append(json.dumps(thing, sort_keys=True))
                return sorted(objects)
            self.assertEqual(lean(laid[name]), lean(bare[name]), name)

    def test_the_same_citygml_but_for_the_stones(self):
        texts = []
        for out in (self.row('gml_with'), self.row('gml_without', 'none')):
            path, = glob.glob(os.path.join(out, 'citygml', '*.gml'))
            with open(path, encoding='utf-8') as f:
                text = f.read()
            surfaces = re.findall(r'<bldg:boundedBy>.*?</bldg:boundedBy>', text, re.S)
            texts.append([re.sub(r'>\s+<', '><', s) for s in surfaces])
        self.assertGreater(len(texts[0]), 12)
        self.assertEqual(texts[0], texts[1])

    def test_unknown_words_are_told(self):
        out = self.row('wrong', 'fitted", masonry_format = "gothic')
        said = [row for row in read_json(out, 'report.json')['notices'] + read_json(out, 'report.json').get('fallbacks', [])
                if 'masonry_format' in json.dumps(row)]
        self.assertEqual({row['code'] for row in said}, {'GRAMMAR_ERROR'}, said)

    def test_a_bound_of_triangles_is_kept_and_told(self):
        out = self.row('few', 'fitted", masonry_triangles = 3000, masonry_walls = "outside')
        told = [row for row in json.dumps(read_json(out, 'report.json')).split('{') if 'more than 3000 triangles' in row]
        self.assertTrue(told)


if __name__ == '__main__':
    main()
