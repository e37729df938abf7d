"""Builds of real extracts against hand-built models of the same places: everything is read, all that overlaps is matched,
and the format of the build does not matter. What the numbers say is printed, not judged: the extracts are older than the
models, or younger."""
import sqlite3
import struct
import unittest

from blockrand_run import extract, main
from compare_run import CompareTest, headline, reference, table

# What a file format cannot carry (glTF: classes of surfaces and solids), what sampling decides to the last place only
# where classes decide what is left out, and counts of what is written.
SAMPLED_SHARES = 0.005
EXACT = {'footprint_iou': 1e-4, 'area_ratio': 1e-4, 'offset_east': 1e-3, 'offset_north': 1e-3, 'outline_distance': 1e-3,
         'eaves_error': 1e-3, 'ridge_error': 1e-3, 'volume_ratio': 1e-4, 'roof_type_agrees': 0, 'roof_pitch_error': 0.01,
         'storeys_error': 0, 'triangles_reference': 0}


def polygons(blob):
    """Rings of a GeoPackage polygon or multipolygon: [[[(x, y)]]]."""
    envelope = (0, 32, 48, 48, 64)[blob[3] >> 1 & 7]
    data, at = blob[8 + envelope:], 0

    def read(pattern):
        nonlocal at
        values = struct.unpack_from(pattern, data, at)
        at += struct.calcsize(pattern)
        return values

    def geometry():
        order = '<' if read('B')[0] else '>'
        kind, = read(order + 'I')
        if kind == 3:
            return [[[read(order + '2d') for _ in range(*read(order + 'I'))] for _ in range(*read(order + 'I'))]]
        assert kind == 6, kind
        return [p for _ in range(*read(order + 'I')) for p in geometry()]
    return geometry()


def inside(x, y, shape):
    return sum(((a[1] > y) != (b[1] > y)) and x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
               for polygon in shape for ring in polygon for a, b in zip(ring, ring[1:])) % 2 == 1


def extent(shape):
    points = [p for polygon in shape for p in polygon[0]]
    xs, ys = zip(*points)
    return min(xs), min(ys), max(xs), max(ys)


def footprints(geopackage, layer):
    """[(id, what became of it, rings)]"""
    with sqlite3.connect(geopackage) as db:
        column = db.execute('SELECT column_name FROM gpkg_geometry_columns WHERE table_name = ?', (layer,)).fetchone()[0]
        state = next(row[1] for row in db.execute(f'PRAGMA table_info({layer})') if row[1] in ('state', 'status', 'became'))
        return [(id, became, polygons(blob))
                for id, became, blob in db.execute(f'SELECT id, {state}, {column} FROM {layer}') if blob]


def covered_share(shape, others, steps=24):
    """Share of a grid of places in a footprint that lie in the others, to a few percent."""
    x0, y0, x1, y1 = extent(shape)
    near = [o for o in others if (e := extent(o)) and e[0] <= x1 and e[2] >= x0 and e[1] <= y1 and e[3] >= y0]
    places = [(x0 + (i + 0.5) / steps * (x1 - x0), y0 + (j + 0.5) / steps * (y1 - y0))
              for i in range(steps) for j in range(steps)]
    places = [p for p in places if inside(*p, shape)]
    return sum(any(inside(*p, o) for o in near) for p in places) / max(1, len(places))


class Real(CompareTest):
    def of(self, source, *names):
        source, other = extract(source), reference(*names)
        if not source or not other:
            raise unittest.SkipTest('the extracts or the hand-built models of ../shared/data are absent')
        return source, other

    def against(self, name, source, *names):
        """A build as CityGML against the reference; every reference building that the model covers is matched."""
        source, other = self.of(source, *names)
        out = self.build(source, name, '--formats', 'citygml')
        result = self.compare('c_' + name, out, other)
        table(name, {name: result})
        counts = result['counts']
        self.assertEqual(result['reference']['buildings'], counts['matched_reference_buildings'] + counts['missing'])
        self.assertEqual(result['model']['buildings'], counts['matched_model_buildings'] + counts['extra'])
        geopackage = self.path('c_' + name, 'compare.gpkg')
        model = [shape for _, _, shape in footprints(geopackage, 'model')]
        left = {id: round(covered_share(shape, model), 2)
                for id, became, shape in footprints(geopackage, 'reference') if became == 'missing'}
        print('missing and how much the model covers:', left)
        self.assertEqual(len(left), counts['missing'])
        # A grid tells a share to a few percent: what is covered by clearly more than a quarter must be matched.
        self.assertEqual({k: v for k, v in left.items() if v > 0.30}, {}, 'covered, and not matched')
        return result

    def test_ingolstadt(self):
        result = self.against('ingolstadt', 'ingolstadt-altstadt.osm', 'ingolstadt-lod3')
        self.assertEqual((result['counts']['matched_reference_buildings'], result['counts']['missing']), (27, 0))
        self.assertLess(max(abs(result['registration'][k]) for k in ('east', 'north')), 2)
        self.assertEqual(headline(result, 'valid_model'), 1)
        self.assertGreater(headline(result, 'footprint_iou'), 0.5)
        self.assertGreater(result['summary']['distance_mean']['left_out'], 0.1)  # blank courtyard walls, undersides

    def test_berlin_lod2(self):
        result = self.against('berlin-mitte', 'berlin-mitte-2014.osm.pbf', 'berlin-lod2')
        self.assertGreater(result['counts']['matches'], 100)
        self.assertGreater(result['counts']['matched_reference_buildings'], result['counts']['matches'])  # many to many
        self.assertLess(max(abs(result['registration'][k]) for k in ('east', 'north')), 1)
        self.assertEqual(headline(result, 'valid_model'), 1)

    def test_pariser_platz_in_three_formats(self):
        """18 of 18, and what the files of a build are made of does not matter."""
        source, other = self.of('berlin-pariser-platz-2014.osm.pbf', 'berlin-pariser-platz')
        results = {}
        for format in ('citygml', 'cityjson', 'gltf'):
            out = self.build(source, 'pariser-' + format, '--formats', format)
            results[format] = self.compare('c_' + format, out, other)
        table('Pariser Platz', results)
        first = results['citygml']
        self.assertEqual((first['counts']['matched_reference_buildings'], first['counts']['missing']), (18, 0))
        self.assertEqual(headline(first, 'valid_model'), 1)
        for format, result in results.items():
            for count, expected in first['counts'].items():
                # Areas to the coordinates' millimetres, over outlines of kilometres.
                tolerance = 1 if count.endswith('_area') else 0
                self.assertAlmostEqual(result['counts'][count], expected, delta=tolerance, msg=f'{format} {count}')
            self.assertEqual([m['id'] for m in result['matches']], [m['id'] for m in first['matches']])
            for a, b in zip(first['matches'], result['matches']):
                self.assertEqual(a['model']['buildings'], b['model']['buildings'])
            for measure, tolerance in EXACT.items():
                with self.subTest(f'{format}: {measure}'):
                    self.same(first, result, measure, tolerance)
            for measure, summary in first['summary'].items():
                if summary['scope'] == 'surface' and not measure.startswith('semantic'):
                    unit = {'m': 0.02, 'deg': 0.1, '1': SAMPLED_SHARES}[summary['unit']]
                    # Walls that stand back to back are equally near: which of them is found depends on the file's order.
                    if (format, measure) == ('gltf', 'normal_deviation'):
                        unit = 1
                    with self.subTest(f'{format}: {measure}'):
                        self.same(first, result, measure, unit)
        for measure in ('distance_mean', 'distance_rms', 'to_reference_mean', 'to_model_mean'):
            self.same(first, results['cityjson'], measure, 1e-3)

    def test_den_haag_against_itself(self):
        other = reference('cityjson', 'DenHaag_01.json')
        if not other:
            self.skipTest('the hand-built models of ../shared/data/reference are absent')
        result = self.compare('itself', other, other)
        table('Den Haag', {'itself': result})
        self.assertEqual(result['counts']['matches'], 844)
        self.assertEqual((result['counts']['missing'], result['counts']['extra']), (0, 0))
        self.ideal(result, 1e-4, but=('valid_model', 'semantic_model'))  # facts of the file
        for match in result['matches']:
            self.assertEqual(match['model'], match['reference'] | {'area_left_out': match['model']['area_left_out']})
            self.assertAlmostEqual(match['measures']['footprint_iou']['counted'], 1, delta=1e-9)
            self.assertEqual(match['measures']['valid_model'], match['measures']['valid_reference'])

    def test_hand_built_against_themselves(self):
        for names in (('berlin-pariser-platz',), ('ingolstadt-lod3',)):  # Berlin's LoD2: compare_degraded_test.py
            with self.subTest(names[0]):
                other = reference(*names)
                if not other:
                    self.skipTest('the hand-built models of ../shared/data/reference are absent')
                result = self.compare(names[0], other, other)
                self.assertEqual((result['counts']['missing'], result['counts']['extra']), (0, 0))
                self.ideal(result, 1e-4, but=('valid_model', 'semantic_model'))  # facts of the file


if __name__ == '__main__':
    main()
