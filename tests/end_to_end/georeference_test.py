"""Where things stand: OSM nodes against the CityGML and GLB files, by PROJ and by formulas of our own.

No code of the program is used on the way back: GLB vertices go through the tileset's transform to Earth-centred
coordinates and from there to longitude and latitude.
"""
import math
import unittest

from blockrand_run import SAMPLE, BuildTest, main, read_json
from geodesy import Proj, geodetic, metres_between, utm
from model_files import NAMES, Glb, buildings, citygml_trees, placed, points, tile_contents
from osm_files import Node, Way, read_xml

WANTED = 200       # positions at least
CORNER = 10.0      # degrees: flatter nodes may be left out of walls
# Corners as mapped: what repair moves says nothing about where things stand.
AS_MAPPED = ('--no-repair-square', '--no-repair-share-walls', '--no-repair-simplify')
GRID = 0.5 / 1024  # m: coordinates are rounded to 1/1024 m on each axis


def corner_nodes():
    """{way id: [(lon, lat)]}: the corners of every building way of the sample that no repair touches."""
    nodes, ways = {}, []
    for o in read_xml(SAMPLE):
        if isinstance(o, Node):
            nodes[o.id] = (o.lon, o.lat)
        elif isinstance(o, Way) and o.tags.get('building', 'no') != 'no' and not o.tags.get('note', '').startswith('planted'):
            ways.append(o)
    found = {}
    for way in ways:
        if way.refs[0] != way.refs[-1]:
            continue
        ring = [nodes[r] for r in way.refs[:-1]]
        corners = []
        for a, b, c in zip(ring[-1:] + ring[:-1], ring, ring[1:] + ring[:1]):
            scale = math.cos(math.radians(b[1]))
            u, v = ((b[0] - a[0]) * scale, b[1] - a[1]), ((c[0] - b[0]) * scale, c[1] - b[1])
            turn = math.degrees(abs(math.atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1])))
            if turn > CORNER:
                corners.append(b)
        found[f'w{way.id}'] = corners
    return found


class Georeference(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'out', *AS_MAPPED)
        report = read_json(cls.out, 'report.json')
        mended = {r['id'] for r in report['objects'] + report['notices'] + report['fallbacks']}
        cls.corners = {i: c for i, c in corner_nodes().items() if i not in mended}

    def nearest(self, place, candidates, distance):
        self.assertTrue(candidates)
        return min(distance(place, c) for c in candidates)

    def test_own_formula_is_projs(self):
        try:
            proj = Proj('EPSG:4326', 'EPSG:25832')
        except OSError as absent:
            raise unittest.SkipTest(str(absent))
        for lon, lat in ((11.03, 51.47), (9.0, 0.1), (6.1, 47.3), (12.0, 54.9), (11.9, 70.0)):
            self.assertLess(math.dist(proj(lon, lat)[:2], utm(lon, lat, 32)), 5e-5, (lon, lat))

    def citygml_against(self, project):
        checked, worst = 0, 0.0
        models = buildings(self.out)
        for object_id, corners in self.corners.items():
            ground = [(x, y) for x, y, _ in points(models[object_id])]
            for lon, lat in corners:
                off = self.nearest(project(lon, lat)[:2], ground, math.dist)
                # Rounded to the grid on both axes and then to four decimals.
                self.assertLess(off, 1e-3, f'{object_id}: node at {lon} {lat} is {off:.6f} m off')
                worst, checked = max(worst, off), checked + 1
        self.assertGreaterEqual(checked, WANTED)
        self.assertGreater(worst, 0, 'rounding leaves something: else nothing was compared')
        print(f'{checked} corners, worst {worst * 1000:.3f} mm')

    def test_citygml_by_proj(self):
        try:
            self.citygml_against(Proj('EPSG:4326', 'EPSG:25832'))
        except OSError as absent:
            raise unittest.SkipTest(str(absent))

    def test_citygml_by_formula(self):
        self.citygml_against(lambda lon, lat: utm(lon, lat, 32))

    def test_citygml_says_its_crs(self):
        for name, root in citygml_trees(self.out):
            envelope = root.find('.//gml:Envelope', NAMES)
            self.assertIn('EPSG::25832', envelope.get('srsName'), name)
            self.assertEqual(envelope.get('srsDimension'), '3', name)

    def glb_against(self, folder, contents, height):
        checked, worst = 0, 0.0
        places = {}
        for matrix, path in contents:
            glb = Glb(path)
            rows = glb.texts('building')
            for row, p in set(glb.vertices()):
                places.setdefault(rows[row], []).append(geodetic(*placed(matrix, p)))
        for object_id, corners in self.corners.items():
            ground = min(h for _, _, h in places[object_id])
            if height is not None:
                # A building on the ground stands within 2 mm of it; some begin higher (passages, bridges).
                standing = [h for _, _, h in places[object_id] if abs(h - height(*corners[0])) < 0.002]
                if ground < height(*corners[0]) + 1:
                    self.assertTrue(standing, f'{object_id} stands at {ground:.4f} m')
            for corner in corners:
                off = self.nearest(corner, places[object_id], metres_between)
                self.assertLess(off, 2e-3, f'{object_id}: node at {corner} is {off:.6f} m off')
                worst, checked = max(worst, off), checked + 1
        self.assertGreaterEqual(checked, WANTED)
        print(f'{checked} corners, worst {worst * 1000:.3f} mm')

    def test_tiles(self):
        self.glb_against(self.out, tile_contents(self.out), lambda lon, lat: 0.0)

    def test_tiles_on_a_ground_height(self):
        """Heights above sea level become ellipsoidal by EGM96, as PROJ has it."""
        out = self.build(SAMPLE, 'ground', *AS_MAPPED, '--ground-height', '180')
        try:
            geoid = Proj('EPSG:4326+5773', 'EPSG:4979')
        except OSError as absent:
            raise unittest.SkipTest(str(absent))
        height = lambda lon, lat: geoid(lon, lat, 180.0)[2]
        if not 220 < height(11.03, 51.47) < 232:
            raise unittest.SkipTest('PROJ has no EGM96 grid')
        self.glb_against(out, tile_contents(out), height)

    def test_single_glb(self):
        out = self.build(SAMPLE, 'single', *AS_MAPPED, '--single-glb')
        path = f'{out}/model.glb'
        matrix = Glb(path).json['asset']['extras']['georeference']['local_to_ecef']
        self.glb_against(out, [(matrix, path)], lambda lon, lat: 0.0)

    def test_each_tile_says_where_it_stands(self):
        for matrix, path in tile_contents(self.out):
            said = Glb(path).json['asset']['extras']['georeference']
            self.assertEqual(said['crs'], 'EPSG:25832')
            self.assertTrue(said['height_reference'])
            self.assertEqual(said['local_to_ecef'], matrix)
            lon, lat, h = geodetic(*matrix[12:15])
            self.assertLess(metres_between((lon, lat), (said['origin']['longitude'], said['origin']['latitude'])), 1e-6)
            self.assertAlmostEqual(h, said['origin']['height'], delta=1e-6)

    def test_another_crs(self):
        """Gauß-Krüger on the Bessel ellipsoid needs a datum shift: PROJ's, named with its accuracy in build.json."""
        try:
            proj = Proj('EPSG:4326', 'EPSG:31468')
        except OSError as absent:
            raise unittest.SkipTest(str(absent))
        out = self.build(SAMPLE, 'gk', '--crs', 'EPSG:31468')
        crs = read_json(out, 'build.json')['crs']
        self.assertGreater(crs['accuracy_m'], 0)
        models = buildings(out)
        object_id, corners = next(iter(self.corners.items()))
        ground = [(x, y) for x, y, _ in points(models[object_id])]
        # Which of several datum shifts PROJ takes depends on the area asked for: within the stated accuracies.
        self.assertLess(self.nearest(proj(*corners[0])[:2], ground, math.dist), 2 * crs['accuracy_m'] + 1)


if __name__ == '__main__':
    main()
