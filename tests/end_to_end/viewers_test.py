"""Seen by others: programs that share no code with ours open what a build wrote, and find everything in its place.

    3D Tiles     NASA's 3d-tiles-renderer and CesiumJS in headless Chromium
    GLB          assimp
    CityGML      libcitygml: Debian's citygmltest, and a program of our own around the library

    viewers_test.py [--pictures FOLDER]    keeps the screenshots there
"""
import json
import os
import re
import shutil
import sqlite3
import statistics
import sys
import unittest

import validators
from blockrand_run import SAMPLE, BuildTest, Setup, call, extract, files_of, first_present, main, pictures_folder, read_json
from geodesy import Proj, metres_between
from model_files import NAMES, GML_ID, Glb, buildings, citygml_trees, tile_contents
from osm_files import Node, Way, read_xml
from real_extracts_test import opl_objects, opl_tags

PICTURES = None  # folder that keeps the screenshots
# Buildings are compared with where they are mapped: repair, which moves corners to where they belong, is left out.
AS_MAPPED = ['--no-repair-simplify', '--no-repair-share-walls', '--no-repair-square', '--no-repair-settle-coverings',
             '--no-repair-resolve-overlaps']
# libcitygml 2.4.3 takes the child of an externalReference for the reference itself (mended upstream later), and does not
# know this one of CityGML 2.0: it says so and goes on behind it.
LIBCITYGML_GAPS = {'Expected start tag <core:externalreference> but got <core:informationsystem>',
                   'Skipping element with unexpected start tag <core:externalobject>',
                   'Found start tag of unknown node <bldg:lod0FootPrint>'}


def primitives(glb):
    return [p for mesh in glb.json['meshes'] for p in mesh['primitives']]


def triangles(glb):
    return sum(glb.json['accessors'][p['indices']]['count'] // 3 for p in primitives(glb))


def osm_boxes(ways, nodes):
    """{id: (west, south, east, north)} of closed building ways all of whose nodes are there."""
    boxes = {}
    for number, refs in ways:
        if len(refs) >= 4 and refs[0] == refs[-1] and all(r in nodes for r in refs):
            lon, lat = zip(*(nodes[r] for r in refs))
            boxes[f'w{number}'] = min(lon), min(lat), max(lon), max(lat)
    return boxes


def boxes_of_xml(source):
    objects = read_xml(source)
    return osm_boxes([(o.id, o.refs) for o in objects if isinstance(o, Way) and o.tags.get('building', 'no') != 'no'],
                     {o.id: (o.lon, o.lat) for o in objects if isinstance(o, Node)})


def boxes_by_osmium(source):
    nodes, ways = {}, []
    for kind, number, fields in opl_objects(source, 'w/building'):
        if kind == 'n' and fields.get('x'):
            nodes[number] = float(fields['x']), float(fields['y'])
        elif kind == 'w' and opl_tags(fields.get('T', '')).get('building', 'no') != 'no':
            ways.append((number, [int(r[1:].split('x')[0]) for r in fields.get('N', '').split(',') if r]))
    return osm_boxes(ways, nodes)


# ---- 3D Tiles

def look(test, folder, picture, viewer):
    """What a viewer in the browser saw of a build."""
    tool = shutil.which('node') or shutil.which('nodejs')
    if not tool:
        test.skipTest('node is not installed')
    if not Setup.node_modules:
        test.skipTest('no node_modules: npm install with tests/validators/package.json')
    run = call([tool, os.path.join(validators.VALIDATORS, 'tiles_viewer.mjs'), os.path.abspath(folder),
                os.path.abspath(Setup.node_modules), picture, viewer], timeout=850)
    if run.code == 77:
        test.skipTest(run.err.strip())
    test.assertEqual(run.code, 0, run)
    return json.loads(run.out)


class InBrowser:
    """A tileset in the browser; one class per extract below."""
    ground = None    # --ground-height of the build
    compared = 0     # buildings at least whose place is compared

    @classmethod
    def source(cls):
        raise NotImplementedError

    @classmethod
    def mapped(cls):
        """osm_boxes of the extract."""
        raise NotImplementedError

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        source = cls.source()
        ground = ['--ground-height', str(cls.ground)] if cls.ground is not None else []
        cls.out = cls().build(source, 'out', '--formats', 'gltf', '--no-report', '--no-explain', *AS_MAPPED, *ground)
        cls.seen = cls().look(cls.out, PICTURES and os.path.join(PICTURES, cls.__name__ + '.png'))

    def look(self, folder, picture=None):
        return look(self, folder, picture or self.path('picture.png'), 'three')

    def test_everything_is_loaded(self):
        contents = [Glb(path) for _, path in tile_contents(self.out)]
        self.assertEqual((self.seen['errors'], self.seen['missing']), ([], []))
        self.assertEqual(self.seen['tiles'], len(contents))
        self.assertEqual(self.seen['triangles'], sum(map(triangles, contents)))
        self.assertEqual(self.seen['meshes'], sum(len(primitives(glb)) for glb in contents))
        self.assertGreater(self.seen['triangles'], 1000)

    def test_nothing_is_complained_about(self):
        """Among the complaints would be vertices outside of their tile's bounding volume."""
        self.assertEqual([m for m in self.seen['messages'] if 'versions at 1.1 or higher have limited support' not in m], [])

    def test_every_vertex_is_told_by_the_metadata(self):
        self.assertEqual(self.seen['untold'], 0)
        ids = {i for _, path in tile_contents(self.out) for i in Glb(path).texts('id')}
        self.assertEqual(set(self.seen['features']), ids)
        self.assertEqual(len(ids), read_json(self.out, 'build.json')['counts']['bodies'])

    def distances(self, seen):
        """Metres between what is shown and what is mapped, of every building that is one body and that nothing happened to:
        the larger one of the distances between south-western and north-eastern corners of the two boxes."""
        report = read_json(self.out, 'report.json')
        mended = {row['id'] for row in report['objects'] + report['notices'] + report['fallbacks']}
        found = {}
        for object_id, box in self.mapped().items():
            feature = seen['features'].get(object_id)
            if feature and feature['building'] == object_id and object_id not in mended:
                west, south, _, east, north, _ = feature['box']
                found[object_id] = max(metres_between((west, south), box[:2]), metres_between((east, north), box[2:]))
        return found

    def test_it_stands_where_it_is_mapped(self):
        off = self.distances(self.seen)
        self.assertGreaterEqual(len(off), self.compared)
        worst = max(off, key=off.get)
        print(f'{len(off)} buildings: median {statistics.median(off.values()) * 1000:.2f} mm, '
              f'worst {off[worst] * 1000:.2f} mm ({worst})')
        # The grid is 1/1024 m, single precision well below that.
        self.assertLess(off[worst], 0.005, worst)
        self.assertGreater(off[worst], 0, 'rounding leaves something: else nothing was compared')

    def test_it_stands_on_the_ground(self):
        """Ellipsoidal heights: the ground is the given height above sea level over EGM96's geoid, or the ellipsoid."""
        lows = {f['building']: f['box'][2] for f in self.seen['features'].values()}
        base = statistics.median(lows.values())
        if self.ground is None:
            self.assertAlmostEqual(base, 0, delta=0.001)
        else:
            west, south, _, _, _, _ = next(iter(self.seen['features'].values()))['box']
            try:
                geoid = Proj('EPSG:4326+5773', 'EPSG:4979')(west, south, 0.0)[2]
            except OSError as absent:
                raise unittest.SkipTest(str(absent))
            self.assertTrue(20 < geoid < 70, geoid)  # central Europe; 0 would be PROJ without its grid
            self.assertAlmostEqual(base, self.ground + geoid, delta=0.05)
        for object_id, feature in self.seen['features'].items():
            low, high = feature['box'][2] - base, feature['box'][5] - base
            self.assertTrue(-0.05 < low < high < 450, (object_id, low, high))

    def test_the_picture_shows_it(self):
        self.assertTrue(0.05 < self.seen['drawn'] < 0.95, self.seen['drawn'])
        self.assertGreater(self.seen['colours'], 200)


class SampleInBrowser(InBrowser, BuildTest):
    ground, compared = 150, 100

    @classmethod
    def source(cls):
        return SAMPLE

    @classmethod
    def mapped(cls):
        return boxes_of_xml(SAMPLE)

    def damaged(self, name, change):
        """A copy of the build with another tileset.json, as the viewer sees it."""
        folder = self.path(name)
        shutil.copytree(self.out, folder)
        tileset = read_json(folder, 'tileset.json')
        tiles, waiting = [], [tileset['root']]
        while waiting:
            tile = waiting.pop()
            waiting += tile.get('children', [])
            if 'content' in tile:
                tiles.append(tile)
        change(folder, tiles)
        with open(os.path.join(folder, 'tileset.json'), 'w', encoding='utf-8') as f:
            json.dump(tileset, f)
        return self.look(folder)

    def test_a_missing_tile_is_seen(self):
        seen = self.damaged('missing', lambda folder, tiles: os.remove(os.path.join(folder, tiles[0]['content']['uri'])))
        self.assertTrue(seen['errors'] and seen['missing'], seen)

    def test_a_wrong_transform_is_seen(self):
        def move(_, tiles):
            for tile in tiles:
                tile['transform'][12] += 3.0
        off = self.distances(self.damaged('moved', move))
        self.assertGreater(statistics.median(off.values()), 1.0)

    def test_a_wrong_volume_is_seen(self):
        def shrink(_, tiles):
            for axis in (3, 7, 11):
                tiles[0]['boundingVolume']['box'][axis] *= 0.9
        self.assertGreater(len(self.damaged('shrunk', shrink)['messages']), len(self.seen['messages']))


class BerlinInBrowser(InBrowser, BuildTest):
    """A city's centre: 66 tiles."""
    compared = 4000

    @classmethod
    def source(cls):
        found = extract('berlin-mitte-2014.osm.pbf')
        if not found:
            raise unittest.SkipTest('berlin-mitte-2014.osm.pbf is not in the shared data')
        if not shutil.which('osmium'):
            raise unittest.SkipTest('osmium-tool is not installed')
        return found

    @classmethod
    def mapped(cls):
        return boxes_by_osmium(cls.source())


class InCesium(BuildTest):
    """The sample in CesiumJS, without globe, imagery and network."""
    options = ()

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        test = cls()
        cls.out = test.build(SAMPLE, 'out', '--formats', 'gltf,gpkg', '--no-report', '--no-explain', '--ground-height', '150',
                             *cls.options)
        cls.seen = look(test, cls.out, os.path.join(PICTURES or cls.folder, cls.__name__ + '.png'), 'cesium')

    def test_everything_is_loaded(self):
        """Each tile at its finest, each body a feature."""
        self.assertEqual((self.seen['errors'], self.seen['missing'], self.seen['messages']), ([], [], []))
        finest = [path for _, path in tile_contents(self.out) if not re.search(r'_lod\d\.glb$', path)]
        self.assertEqual(self.seen['tiles'], len(finest))
        self.assertEqual(set(self.seen['features']), {i for path in finest for i in Glb(path).texts('id')})
        self.assertEqual(len(self.seen['features']), read_json(self.out, 'build.json')['counts']['bodies'])

    def test_features_tell_what_the_geopackage_tells(self):
        db = sqlite3.connect(os.path.join(self.out, 'buildings.gpkg'))
        db.row_factory = sqlite3.Row
        rows = {row['id']: row for row in db.execute('SELECT * FROM parts')}
        db.close()
        self.assertEqual(set(rows), set(self.seen['features']))
        told = 0
        for object_id, feature in self.seen['features'].items():
            row = rows[object_id]
            self.assertEqual(feature['building'], row['building'])
            for name in ('use', 'era', 'style', 'substyle', 'construction_date', 'wall_colour', 'roof_colour', 'built_roof', 'lod'):
                self.assertEqual(feature.get(name), row[name], f'{object_id} {name}')
                told += row[name] is not None
            for name, step in (('storeys', 0.1), ('height', 0.1), ('eaves_height', 0.1), ('roof_height', 0.1), ('roof_pitch', 1),
                               ('style_confidence', 0.01)):
                if row[name] is None:
                    self.assertIsNone(feature.get(name), f'{object_id} {name}')
                    continue
                self.assertAlmostEqual(feature[name], row[name], delta=step / 2 + 1e-9, msg=f'{object_id} {name}')
                self.assertLess(len(str(feature[name])), 7, 'rounded')
            sources = {name: group.split(': ')[0] for group in feature['sources'].split('; ') for name in group.split(': ')[1].split(', ')}
            for name, source in sources.items():
                self.assertEqual(source, row[name + '_source'], f'{object_id} {name}')
        self.assertGreater(told, 5 * len(rows))

    def test_a_click_reads_from_top_to_bottom(self):
        self.assertTrue(self.seen['picked'], 'nothing was hit in the middle of the picture')
        names = [name for name, _ in self.seen['picked']]
        order = ['address', 'name', 'use', 'ground_floor_use', 'construction_date', 'era', 'style', 'style_confidence', 'substyle',
                 'storeys', 'roof_storeys', 'height', 'eaves_height', 'built_roof', 'roof_height', 'roof_pitch', 'roof_material',
                 'roof_colour', 'wall_material', 'wall_colour', 'sources', 'fallbacks', 'lod', 'id', 'building']
        self.assertEqual(names, [name for name in order if name in names])
        self.assertGreater(len(names), 18)
        picked = {name: value for name, value in self.seen['picked'] if value is not None}
        self.assertEqual(self.seen['features'][picked['id']], picked)

    def test_it_stands_in_its_place(self):
        """The bounding sphere holds all mapped places, and is hardly larger."""
        lon, lat, height, radius = self.seen['sphere']
        boxes = boxes_of_xml(SAMPLE)
        shown = [boxes[f['building']] for f in self.seen['features'].values() if f['building'] in boxes]
        self.assertGreater(len(shown), 0.7 * len(self.seen['features']))
        farthest = max(metres_between((lon, lat), corner) for box in shown for corner in (box[:2], box[2:]))
        self.assertTrue(0.7 * radius < farthest < radius + 1, (farthest, radius))
        self.assertTrue(150 + 43 < height < 150 + 48 + 40, 'EGM96 lies about 45 m above the ellipsoid')

    def test_the_picture_shows_it(self):
        self.assertTrue(0.05 < self.seen['drawn'] < 0.95, self.seen['drawn'])
        self.assertGreater(self.seen['colours'], 100)


class FacadesInCesium(InCesium):
    """Windows are instances (EXT_mesh_gpu_instancing) with features of their own. Some houses: software draws."""
    options = ('--lod', '3', '--surroundings', 'off', '--bbox', '11.0290,51.4690,11.0305,51.4700')

    def test_a_missing_tile_is_seen(self):
        folder = self.path('missing')
        shutil.copytree(self.out, folder)
        os.remove(min(os.path.join(folder, f) for f in files_of(folder, '.glb')))
        seen = look(self, folder, self.path('missing.png'), 'cesium')
        self.assertTrue(seen['errors'] and seen['missing'], seen)


# ---- GLB

class ByAssimp(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if not shutil.which('assimp'):
            raise unittest.SkipTest('assimp is not installed (package assimp-utils)')
        cls.out = cls().build(SAMPLE, 'out', '--formats', 'gltf', '--no-report', '--no-explain', '--single-glb', '--compress', 'none')
        cls.files = [os.path.join(cls.out, f) for f in files_of(cls.out, '.glb')]

    def test_counts_and_extent(self):
        self.assertGreaterEqual(len(self.files), 4)
        for path in self.files:
            glb = Glb(path)
            run = call(['assimp', 'info', path, '--raw'])
            self.assertEqual(run.code, 0, run)
            self.assertNotIn('ERROR', run.out + run.err)
            said = {k: [float(n) for n in v.strip(' ()').split()] for k, v in
                    re.findall(r'(?m)^(Meshes|Vertices|Faces|(?:Minimum|Maximum) point):? +([\d.() +e-]+)$', run.out)}
            # Each primitive's accessor of positions, and where its origin lies.
            positions = [(glb.json['accessors'][p['attributes']['POSITION']], origin)
                         for _, origin, mesh in glb.placed_meshes() for p in mesh['primitives']]
            self.assertEqual(said['Meshes'], [len(positions)], path)
            self.assertEqual(said['Vertices'], [sum(a['count'] for a, _ in positions)], path)
            self.assertEqual(said['Faces'], [triangles(glb)], path)
            for axis in range(3):
                self.assertAlmostEqual(said['Minimum point'][axis], min(a['min'][axis] + o[axis] for a, o in positions), delta=1e-3)
                self.assertAlmostEqual(said['Maximum point'][axis], max(a['max'][axis] + o[axis] for a, o in positions), delta=1e-3)

    def test_every_vertex_and_colour_arrives(self):
        """Written again by assimp as PLY, which knows no colours of materials. (Its normals are left out: assimp 5.2 takes the bytes of KHR_mesh_quantization
        for floats, though it reads positions and colours rightly.)"""
        path = next(f for f in self.files if f != os.path.join(self.out, 'model.glb'))
        glb = Glb(path)
        run = call(['assimp', 'export', path, self.path('model.ply')])
        self.assertEqual(run.code, 0, run)
        with open(self.path('model.ply'), encoding='ascii') as f:
            head, _, body = f.read().partition('end_header\n')
        columns = re.findall(r'(?m)^property \w+ (\w+)$', head)
        count = int(re.search(r'element vertex (\d+)', head)[1])
        rows = [dict(zip(columns, map(float, line.split()))) for line in body.split('\n')[:count]]
        wanted = []
        for primitive in primitives(glb):
            places = glb.accessor(primitive['attributes']['POSITION'])
            own = primitive['attributes'].get('COLOR_0')
            wanted += zip(places, glb.accessor(own) if own is not None else [()] * len(places))
        self.assertEqual(len(rows), len(wanted))
        for row, (place, colour) in zip(rows, wanted):
            for axis, value in zip('xyz', place):
                self.assertAlmostEqual(row[axis], value, delta=1e-3)
            for channel, value in zip(('red', 'green', 'blue'), colour):
                self.assertAlmostEqual(row[channel], 255 * value, delta=1.0)


# ---- CityGML

class CityGml(BuildTest):
    options = ()

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'out', '--formats', 'citygml,gltf', '--no-report', '--no-explain', *cls.options)
        cls.files = [os.path.join(cls.out, f) for f in files_of(cls.out, '.gml')]

    def kinds(self, messages):
        """What was said, without the places."""
        return {re.split(r' at  line |\. Skip| at line ', m)[0] for m in messages}

    def test_citygmltest_parses_every_file(self):
        if not shutil.which('citygmltest'):
            self.skipTest('citygmltest is not installed (package libcitygml-bin)')
        for path in self.files:
            run = call(['citygmltest', '-log', path])
            self.assertEqual(run.code, 0, run)
            self.assertRegex(run.out, r'\nDone in .*\n(.*\n)*Done\.')
            errors = re.findall(r'(?:ERROR|WARNING) \[[^\]]*\] (.*)', run.out + run.err)
            self.assertLessEqual(self.kinds(errors), LIBCITYGML_GAPS, run)

    def test_citygmltest_refuses_a_broken_file(self):
        if not shutil.which('citygmltest'):
            self.skipTest('citygmltest is not installed (package libcitygml-bin)')
        with open(self.files[0], 'rb') as f:
            half = f.read()[:20000]
        self.assertNotEqual(call(['citygmltest', self.place('half.gml', half)]).code, 0)

    def seen_by_libcitygml(self):
        viewer = first_present(os.path.join(os.path.dirname(os.path.abspath(Setup.program)), 'tests', 'citygml_viewer'))
        if not viewer:
            self.skipTest('citygml_viewer is not built: it needs libcitygml-dev')
        run = call([viewer, *self.files])
        self.assertEqual(run.code, 0, run)
        seen = [json.loads(line) for line in run.out.split('\n') if line]
        self.assertEqual([s['file'] for s in seen], self.files)
        return seen

    def test_libcitygml_finds_everything(self):
        seen = self.seen_by_libcitygml()
        for s, (_, root) in zip(seen, citygml_trees(self.out)):
            own = {e.get(GML_ID) for e in root.iterfind('core:cityObjectMember/bldg:Building', NAMES)}
            self.assertLessEqual(self.kinds(s['messages']), LIBCITYGML_GAPS, s['file'])
            self.assertEqual(set(s['buildings']), own)
            for kind in ('Building', 'BuildingPart', 'RoofSurface', 'WallSurface', 'GroundSurface'):
                self.assertEqual(s['objects'].get(kind, 0), len(root.findall(f'.//bldg:{kind}', NAMES)), kind)
            self.assertEqual(s['srs'], root.find('.//gml:Envelope', NAMES).get('srsName'))
            self.assertEqual(len(s['themes']), 1)
            self.assertNotIn('none', s['colours'], 'a polygon of LoD2 without colour')
            self.assertGreater(s['triangles'], s['polygons']['2'])
        self.assertEqual(sum(len(s['buildings']) for s in seen), len(buildings(self.out)))
        self.assertEqual(sum(len(s['buildings']) for s in seen), read_json(self.out, 'build.json')['counts']['buildings'])
        # The same colours as in the GLBs, where they stand in linear light.
        shown = set()
        for _, path in tile_contents(self.out):
            glb = Glb(path)
            for primitive in primitives(glb):
                for r, g, b in set(glb.colours(primitive)):
                    shown.add('#' + ''.join(f'{self.srgb(v):02x}' for v in (r, g, b)))
        self.assertEqual({c for s in seen for c in s['colours']}, shown)

    def test_libcitygml_reads_place_and_names(self):
        names = 0
        for s, (_, root) in zip(self.seen_by_libcitygml(), citygml_trees(self.out)):
            self.assertEqual(s['srs'], root.find('.//gml:Envelope', NAMES).get('srsName'))
            told = {e.get(GML_ID): e.findtext('gml:name', None, NAMES)
                    for kind in ('Building', 'BuildingPart') for e in root.iterfind(f'.//bldg:{kind}', NAMES)}
            self.assertEqual(s['names'], {i: name for i, name in told.items() if name})
            names += len(s['names'])
        self.assertGreater(names, 5)

    @staticmethod
    def srgb(linear):
        """IEC 61966-2-1, to 8 bits."""
        return round(255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055))


class CityGmlOfFacades(CityGml):
    """LoD3: windows and doors as objects with a solid's faces, elements as implicit geometry."""
    options = ('--lod', '3', '--surroundings', 'off')
    test_libcitygml_finds_everything = None  # colours of LoD2

    def test_libcitygml_finds_every_object(self):
        objects = 0
        for s, (_, root) in zip(self.seen_by_libcitygml(), citygml_trees(self.out)):
            self.assertLessEqual(self.kinds(s['messages']), LIBCITYGML_GAPS, s['file'])
            kinds = ('Building', 'BuildingPart', 'BuildingInstallation', 'Window', 'Door', 'RoofSurface', 'WallSurface', 'GroundSurface',
                     'OuterCeilingSurface', 'OuterFloorSurface')
            self.assertEqual(s['objects'], {kind: n for kind in kinds if (n := len(root.findall(f'.//bldg:{kind}', NAMES)))})
            # Faces of a surface and of a window are references into the solid; an installation is a body or an element.
            for kind in ('Window', 'Door', 'RoofSurface', 'WallSurface', 'GroundSurface'):
                self.assertEqual(s['filled'].get(kind, 0), s['objects'].get(kind, 0), f'{kind} without a face')
            installations = s['filled'].get('BuildingInstallation', 0) + s['implicits'].get('BuildingInstallation', 0)
            self.assertEqual(installations, s['objects'].get('BuildingInstallation', 0), 'installations without a face')
            solid = [b for kind in ('Building', 'BuildingPart') for b in root.iterfind(f'.//bldg:{kind}', NAMES)
                     if any(b.find(f'bldg:lod{lod}Solid', NAMES) is not None for lod in (1, 2, 3))]
            self.assertEqual(s['filled'].get('Building', 0) + s['filled'].get('BuildingPart', 0), len(solid))
            self.assertEqual(sum(s['implicits'].values()), len(root.findall('.//core:ImplicitGeometry', NAMES)))
            self.assertGreater(s["polygons"]["3"], 3 * s["polygons"]["2"])
            objects += sum(s['objects'].values())
        counts = read_json(self.out, 'build.json')['counts']
        self.assertEqual(sum(len(e.findall('.//bldg:Window', NAMES)) for _, e in citygml_trees(self.out)), counts['windows'])
        self.assertGreater(objects, counts['windows'] + counts['doors'] + counts['bodies'])


if __name__ == '__main__':
    PICTURES, others = pictures_folder(sys.argv[1:])
    main(others)
