"""The GeoPackage of a build, as others read it: GDAL's ogrinfo, GDAL's own checker of the standard, and SQL.

Skips where ogrinfo is absent (Debian: gdal-bin)."""
import gzip
import json
import os
import re
import shutil
import sqlite3
import struct
import sys
import unittest

from blockrand_run import SAMPLE, BuildTest, blockrand, call, extract, main, read_json, sha256
from osm_files import METRE, Node, Relation, Way, house, write_xml

OGRINFO = shutil.which('ogrinfo')
LAYERS = {'buildings': 'Multi Polygon', 'parts': 'Polygon', 'facade_edges': 'Line String', 'blocks': 'Polygon',
          'courtyards': 'Polygon', 'cells': 'Polygon', 'reported': 'Point', 'tiles': 'Polygon',
          'surfaces': '3D Multi Polygon'}
EDGE_KINDS = {'unknown', 'street', 'courtyard', 'side', 'party_wall', 'passage'}
ATTRIBUTES = ('use', 'storeys', 'storey_height', 'height', 'min_height', 'roof_storeys', 'roof_height', 'roof_shape',
              'roof_orientation', 'roof_direction', 'ground_height', 'plinth_height', 'wall_colour', 'roof_colour', 'wall_material',
              'roof_material')
SOURCES = {'override', 'tag', 'implied', 'part', 'imagery', 'terrain', 'geometry', 'neighbours', 'block', 'cell',
           'district', 'region', 'preset', 'default'}

# Opens each layer as a user does: with the style that lies in the file. Prints what it is drawn by, how many features get
# no symbol, and which of the layer's styles QGIS cannot take.
QGIS = """
import json, sys
from qgis.core import QgsApplication, QgsRenderContext, QgsVectorLayer
from qgis.PyQt.QtXml import QDomDocument
app = QgsApplication([], False)
app.initQgis()
seen = {}
for name in sys.argv[2:]:
    layer = QgsVectorLayer(f'{sys.argv[1]}|layername={name}', name, 'ogr')
    loaded = layer.loadDefaultStyle()[1]
    renderer = layer.renderer().clone()
    context = QgsRenderContext()
    renderer.startRender(context, layer.fields())
    bare = 0
    for feature in layer.getFeatures():
        context.expressionContext().setFeature(feature)
        bare += renderer.symbolForFeature(feature, context) is None
    renderer.stopRender(context)
    related, ids, *_ = layer.listStylesInDatabase()
    refused = []
    for style in ids[:related]:
        document = QDomDocument()
        document.setContent(layer.getStyleFromDatabase(style)[0])
        if not layer.importNamedStyle(document)[0]:
            refused.append(style)
    seen[name] = [loaded, renderer.type(), related, bare, refused]
print(json.dumps(seen), flush=True)
import os
os._exit(0)  # QGIS is known to crash when it is taken down
"""


def python_with(module):
    """A python that has the module, or None: Debian's packages are for its own one."""
    for python in (sys.executable, '/usr/bin/python3'):
        if os.path.exists(python) and call([python, '-c', f'import {module}']).code == 0:
            return python
    return None


def layers_of(text):
    """{layer: its part of ogrinfo's summary}."""
    pieces = re.split(r'^Layer name: (\S+)$', text, flags=re.M)
    return dict(zip(pieces[1::2], pieces[2::2]))


class GeoPackage(BuildTest):
    """Of the sample; below, the same of real extracts."""
    source = SAMPLE

    @classmethod
    def setUpClass(cls):
        if not OGRINFO:
            raise unittest.SkipTest('ogrinfo is absent (Debian: gdal-bin)')
        if not cls.source:
            raise unittest.SkipTest('the extract is absent')
        super().setUpClass()
        cls.out = cls().build(cls.source, 'out', '--jobs', '4')
        cls.file = os.path.join(cls.out, 'buildings.gpkg')
        cls.build_json = read_json(cls.out, 'build.json')
        cls.report = read_json(cls.out, 'report.json')

    def query(self, sql, *arguments):
        db = sqlite3.connect(f'file:{self.file}?mode=ro&immutable=1', uri=True)
        try:
            return db.execute(sql, arguments).fetchall()
        finally:
            db.close()

    def ogrinfo(self, *arguments):
        run = call([OGRINFO, '-ro', *arguments])
        self.assertEqual(run.code, 0, run)
        for word in ('ERROR', 'Warning', 'FAILURE'):
            self.assertNotIn(word, run.out + run.err, run)
        return run.out

    # ---- as others see it

    def test_ogrinfo_reads_every_layer(self):
        layers = layers_of(self.ogrinfo('-so', '-al', self.file))
        self.assertEqual({name: re.search(r'^Geometry: (.*)$', layers[name], re.M)[1] for name in LAYERS}, LAYERS)
        counts = {name: int(re.search(r'^Feature Count: (\d+)$', text, re.M)[1]) for name, text in layers.items()}
        expected = self.build_json['counts']
        self.assertEqual(counts['buildings'], expected['buildings'])
        self.assertEqual(counts['parts'], expected['bodies'])
        self.assertEqual(counts['reported'], expected['represented'] + expected['reported'])
        self.assertGreater(counts['tiles'], 0)
        code = self.build_json['crs']['code'].split(':')[1]
        for name in LAYERS:
            self.assertRegex(layers[name], rf'ID\["EPSG",{code}\]\]', 'another reference system than in build.json')
        for layer in ('buildings', 'parts'):
            fields = dict(re.findall(r'^(\w+): (\w+)(?:\(\w+\))? \(', layers[layer], re.M))
            for x in ATTRIBUTES:
                self.assertIn(fields.get(x), ('Real', 'String'), f'{layer}.{x}')
                self.assertEqual(fields.get(x + '_source'), 'String', f'{layer}.{x}_source')
                self.assertEqual(fields.get(x + '_confidence'), 'Real', f'{layer}.{x}_confidence')

    def test_spatial_index_leads_to_its_building(self):
        rows = self.query('SELECT id, geom FROM buildings ORDER BY fid')
        for object_id, geometry in (rows[0], rows[len(rows) // 2], rows[-1]):
            west, east, south, north = struct.unpack_from('<4d', geometry, 8)
            found = self.ogrinfo('-q', '-geom=NO', '-spat', *map(repr, (west, south, east, north)), self.file, 'buildings')
            self.assertIn(object_id, re.findall(r'^  id \(String\) = (\S+)$', found, re.M))

    def test_keeps_the_standard(self):
        """GDAL's checker, which shares no code with its writer."""
        python = python_with('osgeo_utils.samples.validate_gpkg')
        if not python:
            self.skipTest('osgeo_utils is absent (Debian: python3-gdal)')
        run = call([python, '-m', 'osgeo_utils.samples.validate_gpkg', '--extra', '--warning-as-error', '-k', self.file])
        self.assertEqual((run.code, run.out.strip()), (0, ''), run)

    def test_opens_coloured_in_qgis(self):
        python = python_with('qgis.core')
        if not python:
            self.skipTest('QGIS is absent (Debian: python3-qgis)')
        copy = self.path('for_qgis.gpkg')  # QGIS writes its journal beside what it opens
        shutil.copy(self.file, copy)
        run = call([python, '-c', QGIS, copy, *LAYERS], env={'QT_QPA_PLATFORM': 'offscreen', 'HOME': self.folder})
        self.assertEqual(run.code, 0, run)
        self.assertEqual(json.loads(run.out.splitlines()[-1]), {
            'buildings': [True, 'graduatedSymbol', 7, 0, []], 'parts': [True, 'categorizedSymbol', 2, 0, []],
            'facade_edges': [True, 'categorizedSymbol', 1, 0, []], 'blocks': [True, 'graduatedSymbol', 2, 0, []],
            'courtyards': [True, 'categorizedSymbol', 1, 0, []], 'cells': [True, 'graduatedSymbol', 2, 0, []],
            'surfaces': [True, 'categorizedSymbol', 1, 0, []],
            'reported': [True, 'categorizedSymbol', 1, 0, []], 'tiles': [True, 'singleSymbol', 1, 0, []]})

    # ---- against the other documents of the build

    def test_reported_objects_are_those_of_the_report(self):
        rows = self.query('SELECT id, kind, state, coalesce(code, ""), coalesce(detail, ""), coalesce(related, "") FROM reported')
        self.assertEqual(sorted(rows), sorted(
            (o['id'], o['kind'], o['state'], o.get('code', ''), o.get('detail', ''), o.get('related', ''))
            for o in self.report['objects']))
        meanings = self.query('SELECT DISTINCT code, meaning FROM reported WHERE code IS NOT NULL')
        self.assertEqual(dict(meanings), {code: self.report['codes'][code] for code, _ in meanings})

    def test_modelled_objects_are_counted(self):
        """The objects that bodies were made from, without those reported, are the models of build.json."""
        models = self.query("SELECT count(DISTINCT osm_type || osm_number) FROM parts p WHERE NOT EXISTS (SELECT 1 FROM "
                            "reported r WHERE r.osm_type = p.osm_type AND r.osm_number = p.osm_number)")[0][0]
        self.assertEqual(models, self.build_json['counts']['models'])
        self.assertEqual(self.query('SELECT count(*) FROM buildings b WHERE parts != (SELECT count(*) FROM parts p WHERE '
                                    'p.building = b.id AND p.tile = b.tile)')[0][0], 0)

    def test_sources_are_counted(self):
        """Where values come from, attribute by attribute, is what build.json says of the bodies."""
        for x in ATTRIBUTES:
            rows = self.query(f'SELECT {x}_source, count(*) FROM parts WHERE {x}_source IS NOT NULL GROUP BY 1')
            self.assertEqual(dict(rows), self.build_json['statistics']['sources'].get(x, {}), x)
            self.assertLessEqual({source for source, _ in rows}, SOURCES)
            self.assertEqual(self.query(f'SELECT count(*) FROM parts WHERE NOT {x}_confidence BETWEEN 0 AND 1')[0][0], 0)

    def test_sums_are_those_of_the_build(self):
        statistics = self.build_json['statistics']
        area, volume = self.query('SELECT sum(footprint_area), sum(volume) FROM buildings')[0]
        self.assertAlmostEqual(area, statistics['footprint_area_m2'], delta=1e-6 * area + 0.1)
        self.assertAlmostEqual(volume, statistics['volume_m3'], delta=1e-6 * volume + 0.1)
        self.assertEqual(dict(self.query('SELECT built_roof, count(*) FROM parts GROUP BY 1')), statistics['roofs'])

    def test_tiles_have_their_files(self):
        rows = self.query('SELECT id, uri, bytes, buildings, parts FROM tiles')
        for tile, uri, size, buildings, parts in rows:
            with self.subTest(tile=tile):
                self.assertEqual(os.path.getsize(os.path.join(self.out, uri)), size)
                self.assertEqual(self.build_json['files'][uri]['bytes'], size)
                self.assertEqual(self.query('SELECT count(*) FROM buildings WHERE tile = ?', tile), [(buildings,)])
                self.assertEqual(self.query('SELECT count(*) FROM parts WHERE tile = ?', tile), [(parts,)])
        self.assertEqual({uri for _, uri, *_ in rows}, {f for f in self.build_json['files'] if f.endswith('.glb')})

    # ---- what repair and context found

    def test_edges_are_those_that_explain_tells(self):
        told = {}
        for name in os.listdir(os.path.join(self.out, 'explain')):
            if name.endswith('.jsonl.gz'):
                with gzip.open(os.path.join(self.out, 'explain', name), 'rt', encoding='utf-8') as file:
                    for line in map(json.loads, file):
                        if line['bodies']:
                            told.update({e['id']: (line['id'], e['kind'], e['length'], e.get('neighbour'), e.get('street'),
                                                   ' '.join(p['id'] for p in e.get('points', [])) or None)
                                         for e in line.get('edges', [])})
        rows = self.query('SELECT id, building, kind, length, neighbour, street, points FROM facade_edges')
        self.assertEqual({row[0]: row[1:] for row in rows}, told)
        self.assertLessEqual({row[2] for row in rows}, EDGE_KINDS)

    def test_every_entrance_and_address_stands_at_one_wall(self):
        """At one stretch of one building."""
        rows = self.query('SELECT points, entrances, house_numbers FROM facade_edges WHERE points IS NOT NULL')
        points = [p for row in rows for p in row[0].split()]
        self.assertEqual(len(points), len(set(points)))
        for row in rows:
            self.assertLessEqual(row[1], len(row[0].split()))
        self.assertEqual(self.query("SELECT count(*) FROM facade_edges WHERE entrances > 0 AND points IS NULL"), [(0,)])

    def test_buildings_stand_in_their_blocks_and_courtyards(self):
        blocks = {b for b, in self.query('SELECT id FROM blocks')}
        self.assertLessEqual({b for b, in self.query('SELECT block FROM buildings WHERE block IS NOT NULL')}, blocks)
        yards = {c for c, in self.query('SELECT id FROM courtyards')}
        self.assertLessEqual({c for row in self.query('SELECT courtyards FROM buildings WHERE courtyards IS NOT NULL')
                              for c in row[0].split()}, yards)

    # ---- the file itself

    def test_time_is_that_of_the_data(self):
        times = {t for t, in self.query('SELECT last_change FROM gpkg_contents UNION SELECT update_time FROM layer_styles')}
        data_time = self.build_json['data_time'] or '1970-01-01T00:00:00Z'
        self.assertEqual(times, {data_time.replace('Z', '.000Z')})

    def test_same_bytes_with_one_thread(self):
        again = self.build(self.source, 'again', '--jobs', '1')
        self.assertEqual(sha256(os.path.join(again, 'buildings.gpkg')), sha256(self.file))

    def test_nothing_lies_beside_it(self):
        self.assertEqual([f for f in os.listdir(self.out) if f.startswith('buildings.gpkg')], ['buildings.gpkg'])


def three_rings():
    """One building of three rings, each in a block of its own: it belongs to none, its courtyards to theirs."""
    lon, lat, wide = 11.0, 51.5, 1.606
    objects = []

    def way(number, points, tags, close=False):
        ids = [100 * number + i for i in range(len(points))]
        objects.extend(Node(i, lon + x * METRE * wide, lat + y * METRE) for i, (x, y) in zip(ids, points))
        objects.append(Way(number, ids + ids[:1] if close else ids, tags))

    def square(number, low, high, x):
        way(number, [(x + low, low), (x + high, low), (x + high, high), (x + low, high)], {}, close=True)
    grid = {(i, j): Node(1 + 2 * i + j, lon + 100 * i * METRE * wide, lat + 100 * j * METRE) for i in range(4) for j in (0, 1)}
    objects.extend(grid.values())
    lines = [[(i, j) for i in range(4)] for j in (0, 1)] + [[(i, 0), (i, 1)] for i in range(4)]
    for k, line in enumerate(lines):
        objects.append(Way(50 + k, [grid[at].id for at in line], {'highway': 'residential', 'name': f'Street {k}'}))
    for i in range(3):
        square(60 + 2 * i, 30, 70, 100 * i)
        square(61 + 2 * i, 40, 60, 100 * i)
    objects.append(Relation(1, [('way', 60 + k, 'inner' if k % 2 else 'outer') for k in range(6)],
                            {'type': 'multipolygon', 'building': 'yes'}))
    for k, (x, y) in enumerate(((-200, -200), (500, -200), (500, 300), (-200, 300))):
        objects += house(k, lon + x * METRE * wide, lat + y * METRE, stretch=wide)
    return objects


class SeveralPolygons(BuildTest):
    def test_a_courtyard_is_found_once_where_its_walls_stand(self):
        out = self.build(write_xml(self.path('rings.osm'), three_rings()), 'out')
        db = sqlite3.connect(os.path.join(out, 'buildings.gpkg'))
        blocks = db.execute('SELECT id, buildings, courtyards FROM blocks ORDER BY id').fetchall()
        self.assertEqual([row[1:] for row in blocks], [(0, 1)] * 3)
        self.assertEqual(sorted(db.execute('SELECT block FROM courtyards').fetchall()), [(row[0],) for row in blocks])
        self.assertEqual(db.execute("SELECT block FROM buildings WHERE id = 'r1'").fetchall(), [(None,)])
        db.close()
        run = blockrand('validate', out)
        self.assertEqual(run.code, 0, run)


class WithoutGeoPackage(BuildTest):
    def test_a_build_can_do_without(self):
        out = self.build(SAMPLE, 'out', '--formats', 'gltf')
        self.assertFalse(os.path.exists(os.path.join(out, 'buildings.gpkg')))


class RealExtract(GeoPackage):
    """Well tagged, with parts."""

    @classmethod
    def setUpClass(cls):
        cls.source = extract('berlin-zionskirchplatz-2020.osm')
        super().setUpClass()


if __name__ == '__main__':
    main()
