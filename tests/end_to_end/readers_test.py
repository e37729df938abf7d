"""GDAL and QGIS open CityGML, GeoPackage and QGIS project of a build as they come, without an option: every building has a
geometry, every value its name, every layer its place. docs/reading_the_results.md tells people what this holds.

    readers_test.py [--pictures FOLDER]    keeps the pictures of the project there
"""
import json
import os
import shutil
import sqlite3
import sys
import zipfile

from blockrand_run import SAMPLE, SOURCE, BuildTest, blockrand, call, main, pictures_folder, read_json, sha256
from geopackage_test import python_with
from importers_test import colours_of_png
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


# Opens a project as QGIS does and draws what it shows first, then each layer of the panel alone.
QGIS_PROJECT = """
import json, os, sys
from qgis.core import QgsApplication, QgsMapRendererSequentialJob, QgsMapSettings, QgsProject
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtXml import QDomDocument
app = QgsApplication([], False)
app.initQgis()
path, pictures = sys.argv[1:]
project, canvas = QgsProject.instance(), QgsMapSettings()
def read_canvas(document):
    canvas.readXml(document.elementsByTagName('mapcanvas').at(0))
project.readProject.connect(read_canvas)
assert project.read(path), project.error()
def draw(layers, extent, name):
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setDestinationCrs(project.crs())
    settings.setExtent(extent)
    settings.setOutputSize(QSize(900, 700))
    settings.setBackgroundColor(QColor('white'))
    job = QgsMapRendererSequentialJob(settings)
    job.start()
    job.waitForFinished()
    assert not job.errors(), [e.message for e in job.errors()]
    assert job.renderedImage().save(os.path.join(pictures, name + '.png'))
root = project.layerTreeRoot()
seen = {'crs': project.crs().authid(), 'canvas_crs': canvas.destinationCrs().authid(),
        'extent': [getattr(canvas.extent(), f)() for f in ('xMinimum', 'yMinimum', 'xMaximum', 'yMaximum')],
        'title': project.title(), 'about': project.metadata().abstract(), 'layers': []}
for node in root.findLayers():
    layer = node.layer()
    seen['layers'].append({
        'id': layer.id(), 'name': node.name(), 'shown': node.isVisible(), 'valid': layer.isValid(), 'rows': layer.featureCount(),
        'crs': layer.crs().authid(), 'table': layer.source().split('layername=')[1], 'path': layer.source().split('|')[0],
        'labels': bool(layer.labelsEnabled() and layer.labeling()), 'classes': len(layer.renderer().legendSymbolItems())})
    draw([layer], canvas.extent(), layer.id())
draw([n.layer() for n in root.findLayers() if n.isVisible()], canvas.extent(), 'project')
# What a planner does next: tick another layer.
node = root.findLayer('blocks_floor_area_ratio')
node.setItemVisibilityChecked(True)
seen['ticked'] = node.isVisible()
print(json.dumps(seen), flush=True)
os._exit(0)  # QGIS is known to crash when it is taken down
"""


def highest_solid(element):
    """(lod, element) of the solid that GDAL shows: the last one, of the last part where there are several."""
    solids = [(lod, s) for body in [element, *element.iterfind('.//bldg:BuildingPart', NAMES)] for lod in (1, 2, 3)
              for s in body.iterfind(f'bldg:lod{lod}Solid', NAMES)]
    return solids[-1] if solids else (0, None)


PICTURES = None  # folder that keeps the pictures


class Readers(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lod2 = cls().build(SAMPLE, 'lod2', '--formats', 'citygml,gpkg', '--no-report', '--no-explain')
        cls.lod3 = cls().build(SAMPLE, 'lod3', '--lod', '3', '--surroundings', 'off', '--formats', 'citygml', '--no-report', '--no-explain')

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

    def project_seen(self, folder):
        """What QGIS says of the project of a build, and the folder with its pictures. The build stays as it is."""
        python = python_with('qgis.core')
        if not python:
            self.skipTest('qgis.core is absent (Debian: python3-qgis)')
        copy = self.path('project_opened')  # QGIS writes its journal beside
        shutil.rmtree(copy, ignore_errors=True)
        os.makedirs(copy)
        for name in ('buildings.gpkg', 'buildings.qgz'):
            shutil.copy(os.path.join(folder, name), copy)
        pictures = PICTURES or self.path('pictures')
        os.makedirs(pictures, exist_ok=True)
        run = call([python, '-c', QGIS_PROJECT, os.path.join(copy, 'buildings.qgz'), pictures],
                   env={'QT_QPA_PLATFORM': 'offscreen', 'HOME': self.folder})
        self.assertEqual(run.code, 0, run)
        return json.loads(run.out.splitlines()[-1]), pictures, copy

    def test_qgis_opens_the_project(self):
        seen, pictures, copy = self.project_seen(self.lod2)
        build = read_json(self.lod2, 'build.json')
        self.assertEqual((seen['crs'], seen['canvas_crs']), (build['crs']['code'], build['crs']['code']))
        self.assertIn('OpenStreetMap contributors', seen['about'])
        db = sqlite3.connect(os.path.join(self.lod2, 'buildings.gpkg'))
        tables = [t for t, in db.execute("SELECT table_name FROM gpkg_contents WHERE data_type = 'features'")]
        rows = {t: db.execute(f'SELECT count(*) FROM "{t}"').fetchone()[0] for t in tables}
        styles = db.execute('SELECT count(*) FROM layer_styles').fetchone()[0]
        box = db.execute("SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'buildings'").fetchone()
        db.close()
        self.assertEqual(rows['buildings'], build['counts']['buildings'])
        self.assertEqual({layer['table'] for layer in seen['layers']}, set(tables), 'each table is shown')
        self.assertEqual(len(seen['layers']), styles, 'each style is a layer')
        for layer in seen['layers']:
            with self.subTest(layer=layer['id']):
                self.assertTrue(layer['valid'])
                self.assertEqual(layer['rows'], rows[layer['table']])
                self.assertEqual(layer['crs'], build['crs']['code'])
                self.assertEqual(os.path.realpath(layer['path']), os.path.realpath(os.path.join(copy, 'buildings.gpkg')))
                self.assertEqual(layer['labels'], layer['table'] in ('buildings', 'tiles'))
                self.assertGreater(layer['classes'], 0 if layer['table'] == 'tiles' else 2)
                colours, drawn = colours_of_png(os.path.join(pictures, layer['id'] + '.png'))
                self.assertGreater(drawn, 0, 'nothing is drawn')
                self.assertGreaterEqual(colours, 2)
        self.assertEqual([layer['id'] for layer in seen['layers'] if layer['shown']], ['buildings_storeys'])
        self.assertTrue(seen['ticked'], 'a layer that is ticked is shown at once')
        # What is shown first is the buildings, all of them and little else.
        west, south, east, north = seen['extent']
        self.assertTrue(west < box[0] < box[2] < east and south < box[1] < box[3] < north, seen['extent'])
        self.assertLess(max(east - west, north - south), 1.2 * max(box[2] - box[0], box[3] - box[1]))
        colours, drawn = colours_of_png(os.path.join(pictures, 'project.png'))
        self.assertTrue(0.1 < drawn < 0.9, drawn)
        self.assertGreater(colours, 6)

    def test_the_project_is_the_same_every_time(self):
        with zipfile.ZipFile(os.path.join(self.lod2, 'buildings.qgz')) as project:
            (member,) = project.infolist()
            self.assertEqual((member.filename, member.date_time), ('buildings.qgs', (1980, 1, 1, 0, 0, 0)))
            self.assertIsNone(project.testzip())
        again = self.build(SAMPLE, 'again', '--formats', 'gpkg', '--no-report', '--no-explain', '--jobs', '1')
        self.assertEqual(sha256(os.path.join(again, 'buildings.qgz')), sha256(os.path.join(self.lod2, 'buildings.qgz')))
        self.assertFalse(os.path.exists(os.path.join(self.lod3, 'buildings.qgz')), '--formats without gpkg')

    def test_the_template_is_what_its_script_writes(self):
        python = python_with('qgis.core')
        if not python:
            self.skipTest('qgis.core is absent (Debian: python3-qgis)')
        room = os.path.join(SOURCE, 'pipeline', 'outputs', 'geopackage')
        with open(os.path.join(room, 'qgis_project.qgs'), encoding='utf-8') as f:
            template = f.read()
        copy = self.path('for_the_template')
        os.makedirs(copy)
        shutil.copy(os.path.join(self.lod2, 'buildings.gpkg'), copy)
        written = os.path.join(copy, 'written.qgs')
        run = call([python, os.path.join(room, 'qgis_project.py'), os.path.join(copy, 'buildings.gpkg'), written],
                   env={'QT_QPA_PLATFORM': 'offscreen', 'HOME': self.folder})
        self.assertEqual(run.code, 0, run)
        with open(written, encoding='utf-8') as f:
            now = f.read()
        version = template.partition('version="')[2].partition('"')[0]
        if f'version="{version}"' not in now:
            self.skipTest(f'the template was written by QGIS {version}')
        self.assertEqual(now, template, 'run pipeline/outputs/geopackage/qgis_project.py and commit its file')

    def test_damage_of_the_project_is_found(self):
        for name, change in (('renamed', lambda text: text.replace(b'layername=blocks', b'layername=quarters')),
                             ('elsewhere', lambda text: text.replace(b'EPSG:25832', b'EPSG:25833'))):
            with self.subTest(name):
                copy = self.path(name)
                shutil.copytree(self.lod2, copy)
                with zipfile.ZipFile(os.path.join(copy, 'buildings.qgz')) as project:
                    text = project.read('buildings.qgs')
                with zipfile.ZipFile(os.path.join(copy, 'buildings.qgz'), 'w', zipfile.ZIP_DEFLATED) as project:
                    project.writestr('buildings.qgs', change(text))
                run = blockrand('validate', copy, '--progress', 'none', '--json')
                self.assertEqual(run.code, 2, run)
                codes = {f['code'] for f in json.loads(run.out)['findings']}
                self.assertEqual(codes, {'QGIS_PROJECT', 'FILE_CHANGED'})

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
    PICTURES, others = pictures_folder(sys.argv[1:])
    main(others)
