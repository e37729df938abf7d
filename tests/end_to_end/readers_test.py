"""GDAL and QGIS open CityGML and GeoPackage of a build as they come, without an option: every building has a geometry, every
value its name. docs/reading_the_results.md tells people what this holds."""
import json
import os
import shutil

from blockrand_run import SAMPLE, BuildTest, blockrand, call, main, read_json
from geopackage_test import python_with
from model_files import NAMES, GML_ID, attributes, buildings, citygml_trees, points

GDAL = """
import json, sys
from osgeo import ogr
ogr.UseExceptions()
seen = {}
for path in sys.argv[1:]:
    data = ogr.Open(path)
    layer = data.GetLayerByName('Building')
    fields = [layer.GetLayerDefn().GetFieldDefn(i).GetName() for i in range(layer.GetLayerDefn().GetFieldCount())]
    for feature in layer:
        shape = feature.GetGeometryRef()
        empty = shape is None or shape.IsEmpty()
        seen[feature.GetField('gml_id')] = [0 if empty else shape.GetGeometryCount(), [] if empty else shape.GetEnvelope3D(),
                                            {f: feature.GetField(f) for f in fields if feature.IsFieldSet(f)}]
print(json.dumps(seen))
"""

QGIS = """
import json, sys
from qgis.core import QgsApplication, QgsVectorLayer
app = QgsApplication([], False)
app.initQgis()
seen = {}
for path in sys.argv[1:]:
    layer = QgsVectorLayer(path + '|layername=Building', 'Building', 'ogr')
    assert layer.isValid(), path
    for feature in layer.getFeatures():
        shape = feature.geometry()
        seen[feature['gml_id']] = 0 if shape.isNull() or shape.isEmpty() else shape.constGet().partCount()
print(json.dumps(seen))
"""


def highest_solid(element):
    """(lod, element) of the solid that GDAL shows: the last one, of the last part where there are several."""
    solids = [(lod, s) for body in [element, *element.iterfind('.//bldg:BuildingPart', NAMES)] for lod in (1, 2, 3)
              for s in body.iterfind(f'bldg:lod{lod}Solid', NAMES)]
    return solids[-1] if solids else (0, None)


class Readers(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lod2 = cls().build(SAMPLE, 'lod2', '--formats', 'citygml,gpkg', '--no-report', '--no-explain')
        cls.lod3 = cls().build(SAMPLE, 'lod3', '--lod', '3', '--formats', 'citygml', '--no-report', '--no-explain')

    def opened(self, folder, module, program):
        """What a Python program prints of the CityGML files of a build."""
        python = python_with(module)
        if not python:
            self.skipTest(f'{module} is absent (Debian: python3-gdal, python3-qgis)')
        copy = self.path('opened')  # GDAL writes .gfs files beside
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(os.path.join(folder, 'citygml'), copy)
        files = [os.path.join(copy, name) for name in sorted(os.listdir(copy))]
        run = call([python, '-c', program, *files], env={'QT_QPA_PLATFORM': 'offscreen', 'HOME': self.folder})
        self.assertEqual(run.code, 0, run)
        return json.loads(run.out.splitlines()[-1])

    def test_gdal_sees_every_building(self):
        for folder, wanted_lod in ((self.lod2, 2), (self.lod3, 3)):
            with self.subTest(lod=wanted_lod):
                seen, ours = self.opened(folder, 'osgeo.ogr', GDAL), buildings(folder)
                self.assertEqual(set(seen), set(ours))
                self.assertEqual([i for i, (faces, *_) in seen.items() if faces == 0], [], 'buildings without geometry')
                for i, (faces, box, _) in seen.items():
                    lod, solid = highest_solid(ours[i])
                    if lod == 0:
                        continue
                    self.assertLessEqual(lod, wanted_lod)
                    self.assertEqual(faces, len(solid.findall('.//gml:surfaceMember', NAMES)), i)
                    x, y, z = zip(*points(solid))
                    for mine, theirs in zip((min(x), max(x), min(y), max(y), min(z), max(z)), box):
                        self.assertAlmostEqual(mine, theirs, places=3, msg=i)

    def test_gdal_names_every_value(self):
        seen, ours = self.opened(self.lod2, 'osgeo.ogr', GDAL), buildings(self.lod2)
        names = set()
        for i, (*_, fields) in seen.items():
            self.assertFalse({'value', 'value_uom'} & set(fields), i)
            for name, text in attributes(ours[i]).items():
                self.assertIn(name, fields, i)
                names.add(name)
                if name in ('ground_height', 'eaves_height', 'roof_pitch', 'roof_height'):
                    # A list where some building has parts: the driver takes their values for the building's own.
                    values = fields[name] if isinstance(fields[name], list) else [fields[name]]
                    self.assertIn(float(text), values, f'{i} {name}')
        self.assertLessEqual({'ground_height', 'roof_height', 'eaves_height', 'roof_shape', 'roof_shape_source'}, names)

    def test_qgis_sees_every_building(self):
        for folder in (self.lod2, self.lod3):
            seen, ours = self.opened(folder, 'qgis.core', QGIS), buildings(folder)
            self.assertEqual(set(seen), set(ours))
            self.assertEqual([i for i, faces in seen.items() if faces == 0], [])

    def test_no_face_is_written_twice(self):
        for folder in (self.lod2, self.lod3):
            for _, root in citygml_trees(folder):
                for element in root.iterfind('core:cityObjectMember/bldg:Building', NAMES):
                    faces = [tuple(ring.text for ring in p.iterfind('.//gml:posList', NAMES))
                             for lod in (2, 3) for solid in element.iterfind(f'.//bldg:lod{lod}Solid', NAMES)
                             for p in solid.iterfind('.//gml:Polygon', NAMES)]
                    self.assertGreater(len(faces), 4)
                    self.assertEqual(len(set(faces)), len(faces), element.get(GML_ID))
                    for surface in element.iterfind('.//bldg:boundedBy', NAMES):
                        templates = surface.findall('.//core:relativeGMLGeometry//gml:Polygon', NAMES)
                        self.assertEqual(len(surface.findall('.//gml:Polygon', NAMES)), len(templates),
                                         'surfaces refer to polygons')

    def test_nothing_is_said_again_and_again(self):
        """Templates refer to polygons that another one has in the same colour; an appearance names surfaces as a whole."""
        xlink, app = '{http://www.w3.org/1999/xlink}href', '{http://www.opengis.net/citygml/appearance/2.0}'
        shared = 0
        for name, root in citygml_trees(self.lod3):
            seen = set()
            look = {t.text[1:]: material.findtext('gml:name', '', NAMES) for material in root.iter(app + 'X3DMaterial')
                      for t in material.iter(app + 'target')}
            for template in root.iterfind('.//core:relativeGMLGeometry/gml:MultiSurface', NAMES):
                for group in template.findall('gml:surfaceMember/gml:CompositeSurface', NAMES) or [template]:
                    shared += len([m for m in group.findall('gml:surfaceMember', NAMES) if m.get(xlink)])
                    for ring in group.iterfind('gml:surfaceMember/gml:Polygon/gml:exterior/gml:LinearRing/gml:posList', NAMES):
                        key = look[group.get(GML_ID)], ring.text
                        self.assertFalse(key in seen, f'{name} {group.get(GML_ID)}: {key}')
                        seen.add(key)
            polygons = len(root.findall('.//gml:Polygon', NAMES))
            self.assertLess(len(look), 0.7 * polygons, name)
        self.assertGreater(shared, 100)

    def test_side_files_are_no_findings(self):
        if not shutil.which('ogrinfo'):
            self.skipTest('ogrinfo is absent (Debian: gdal-bin)')
        copy = self.path('with_side_files')
        shutil.copytree(self.lod2, copy)
        gml = next(name for name in sorted(read_json(copy, 'build.json')['files']) if name.endswith('.gml'))
        self.assertEqual(call(['ogrinfo', '-ro', '-so', '-al', os.path.join(copy, gml)]).code, 0)
        gfs = gml[:-4] + '.gfs'
        self.assertTrue(os.path.exists(os.path.join(copy, gfs)), 'ogrinfo has left its file')
        run = blockrand('validate', copy, '--progress', 'none', '--json')
        self.assertEqual(run.code, 0, run)
        result = json.loads(run.out)
        self.assertEqual((result['sound'], result['findings']), (True, []))
        self.assertTrue(any(gfs in note for note in result['notes']), result['notes'])
        self.place('with_side_files/citygml/notes.txt', 'mine')
        self.assertEqual([f['code'] for f in json.loads(blockrand('validate', copy, '--progress', 'none', '--json').out)['findings']],
                         ['FILE_UNLISTED'])


if __name__ == '__main__':
    main()
