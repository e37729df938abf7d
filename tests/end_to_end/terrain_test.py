"""On a slope: bases follow the ground, plinths close the gap, nothing floats and nothing drowns.

The truth is the function that the raster was sampled from, or the raster's own numbers read as text: never the importer.
"""
import math
import os
import random
import shutil
import unittest

from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, call, extract, files_of, main, read_json, sha256
from geodesy import Proj, utm
from model_files import GML_ID, NAMES, Glb, attributes, citygml_trees, tile_contents
from osm_files import Node, Way, write_xml

STEP = 1 / 1024          # m, of the model's grid
UTM32_PRJ = ('PROJCS["ETRS_1989_UTM_Zone_32N",GEOGCS["GCS_ETRS_1989",DATUM["D_ETRS_1989",SPHEROID["GRS_1980",6378137,'
             '298.257222101]],PRIMEM["Greenwich",0],UNIT["Degree",0.017453292519943295]],PROJECTION["Transverse_Mercator"],'
             'PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],'
             'PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["Meter",1]]')
UTM33_PRJ = UTM32_PRJ.replace('32N', '33N').replace('"central_meridian",9', '"central_meridian",15')
DEGREES_PRJ = ('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
               'UNIT["degree",0.0174532925199433]]')


class Hill:
    """A tilted plane with a hump, m, over UTM coordinates."""

    def __init__(self, x, y, base, east, north, height, width):
        self.x, self.y, self.base, self.east, self.north = x, y, base, east, north
        self.height, self.width = height, width

    def __call__(self, x, y):
        dx, dy = x - self.x, y - self.y
        hump = self.height * math.exp(-(dx * dx + dy * dy) / (2 * self.width ** 2))
        return self.base + self.east * dx + self.north * dy + hump

    def bilinear_error(self, *cells):
        """What bilinear interpolation between samples errs at most: h²/8 of the second derivative, along both axes."""
        return sum(h * h for h in cells) / 8 * self.height / self.width ** 2


class Grid:
    """An ESRI ASCII grid that was read as text: bilinear between pixel centres."""

    def __init__(self, rows, west, north, cell):
        self.rows, self.west, self.north, self.cell = rows, west, north, cell

    def __call__(self, x, y):
        c, r = (x - self.west) / self.cell - 0.5, (self.north - y) / self.cell - 0.5
        i, j = int(c), int(r)
        u, v = c - i, r - j
        above, below = self.rows[j], self.rows[j + 1]
        return (above[i] * (1 - u) + above[i + 1] * u) * (1 - v) + (below[i] * (1 - u) + below[i + 1] * u) * v


def samples(rings, step, spacing):
    """Points along the rings, and in them (even-odd) on a grid through whole multiples of `spacing`."""
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
            n = max(1, math.ceil(math.hypot(bx - ax, by - ay) / step))
            for k in range(n):
                yield ax + (bx - ax) * k / n, ay + (by - ay) * k / n
    low = math.ceil(min(y for r in rings for _, y in r) / spacing)
    high = math.floor(max(y for r in rings for _, y in r) / spacing)
    for row in range(low, high + 1):
        y, crossings = row * spacing, []
        for ring in rings:
            for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
                if (ay > y) != (by > y):
                    crossings.append(ax + (y - ay) / (by - ay) * (bx - ax))
        crossings.sort()
        for a, b in zip(crossings[::2], crossings[1::2]):
            for column in range(math.ceil(a / spacing), math.floor(b / spacing) + 1):
                yield column * spacing, y


def rings_of(polygon):
    """Rings of (x, y, z) without the repeated last point, of a gml:Polygon."""
    for pos in polygon.iterfind('.//gml:posList', NAMES):
        n = [float(t) for t in pos.text.split()]
        yield list(zip(n[0::3], n[1::3], n[2::3]))[:-1]


def bodies(folder):
    """(building's id, element) of every Building or BuildingPart that has surfaces."""
    for _, root in citygml_trees(folder):
        for building in root.iterfind('core:cityObjectMember/bldg:Building', NAMES):
            for element in [building, *building.iterfind('bldg:consistsOfBuildingPart/bldg:BuildingPart', NAMES)]:
                if element.find('bldg:boundedBy', NAMES) is not None:
                    yield building.get(GML_ID), element


def polygons(body, surface):
    """Surfaces refer to polygons, which stand in the body's solids."""
    known = {p.get(GML_ID): p for p in body.iterfind('.//gml:Polygon', NAMES)}
    for s in body.iterfind(f'bldg:boundedBy/bldg:{surface}', NAMES):
        for member in s.iterfind('.//gml:surfaceMember', NAMES):
            yield known[member.get('{http://www.w3.org/1999/xlink}href')[1:]]


class OnTerrain(BuildTest):
    def raster(self, name, rows, west, south, cell, prj):
        head = f'ncols {len(rows[0])}\nnrows {len(rows)}\nxllcorner {west!r}\nyllcorner {south!r}\ncellsize {cell!r}\n'
        self.place(name + '.prj', prj)
        return self.place(name + '.asc', head + '\n'.join(' '.join(f'{z:.4f}' for z in row) for row in rows) + '\n')

    def sound(self, out):
        run = blockrand('validate', out, '--progress', 'none')
        self.assertEqual(run.code, 0, run)

    def stands_well(self, out, truth, error, step=0.5, spacing=2.0, wanted=50):
        """Every body of a build against the ground. \\param error  m, what the raster may differ from `truth`"""
        tolerance = error + 3 * STEP  # rounding of plan and base
        simplified = {r['id'] for r in read_json(out, 'report.json')['fallbacks']
                      if r['code'] in ('ROOF_SIMPLIFIED', 'PLAN_SIMPLIFIED')}
        lowest, base, raised, figures = {}, {}, set(), {'bodies': 0, 'plinths': 0, 'highest': 0.0, 'walls': 0}
        for owner, body in bodies(out):
            name = body.get(GML_ID)
            said = attributes(body)
            ground, plinth = float(said['ground_height']), float(said['plinth_height'])
            self.assertEqual(said['plinth_height_source'], 'terrain', name)
            floors = [list(rings_of(p)) for p in polygons(body, 'GroundSurface')]
            if not floors:
                raised.add(owner)
                continue
            figures['bodies'] += 1
            # A plan that was simplified for its roof may reach 0.25 m beyond the outline.
            slack = tolerance + (0.25 if name.split('.')[-1].split('_')[-1] in simplified or name in simplified else 0)
            heights = [truth(x, y) for rings in floors
                       for x, y in samples([[p[:2] for p in ring] for ring in rings], step, spacing)]
            for rings in floors:
                for x, y, z in (p for ring in rings for p in ring):
                    self.assertAlmostEqual(z, ground, delta=1e-4, msg=f'{name}: its ground surface is not its base')
            # Nothing floats: the base is nowhere above the ground.
            self.assertLessEqual(ground, min(heights) + slack, f'{name} floats')
            lowest[owner] = min(lowest.get(owner, math.inf), min(heights))
            base[owner] = ground
            # Nothing drowns: the ceiling of the ground floor is nowhere below the ground.
            rise = max(heights) - ground
            self.assertGreaterEqual(plinth, 0, name)
            canopy = body.findtext('bldg:function', '', NAMES) == 'roof'
            whole = float(body.findtext('bldg:measuredHeight', '', NAMES))
            storey = float(said['storey_height'] if 'storey_height' in said else
                           body.findtext('bldg:storeyHeightsAboveGround', '', NAMES).split()[0])
            under_roof = whole - float(said['roof_height']) < 2.2  # all roof: storeys are in it
            ceiling = whole if under_roof or canopy else plinth + storey
            self.assertGreaterEqual(ceiling, rise - slack, f'{name} drowns: plinth {plinth}, storey {storey}, rise {rise:.2f}')
            figures['plinths'] += plinth > 0
            figures['highest'] = max(figures['highest'], plinth)
            # The plinth is closed: a wall stands on every edge of the ground surface and ends above the floor's level.
            walls = {}
            for polygon in polygons(body, 'WallSurface'):
                for ring in rings_of(polygon):
                    top = max(p[2] for p in ring)
                    for a, b in zip(ring, ring[1:] + ring[:1]):
                        if abs(a[2] - ground) < 1e-4 and abs(b[2] - ground) < 1e-4:
                            walls[a[:2], b[:2]] = top
            for rings in floors:
                for ring in rings:
                    for a, b in zip(ring, ring[1:] + ring[:1]):
                        top = walls.get((b[:2], a[:2]))  # the ground surface looks down
                        self.assertIsNotNone(top, f'{name}: no wall reaches down to the base between {a} and {b}')
                        if not under_roof:
                            self.assertGreater(top, ground + plinth, f'{name}: a wall ends below the ground floor')
                        figures['walls'] += 1
        for owner, z in base.items():
            # Nothing is dug in deeper than it needs to be. Bodies without a plan on the ground do not show how low that is.
            if owner not in raised:
                self.assertGreaterEqual(z, lowest[owner] - tolerance - 0.1, f'{owner} is dug in')
        self.assertGreaterEqual(figures['bodies'], wanted)
        print(f'{figures["bodies"]} bodies, {figures["plinths"]} with a plinth, the highest {figures["highest"]:.2f} m, '
              f'{figures["walls"]} walls')
        return figures


class Slopes(OnTerrain):
    def test_sample(self):
        """A raster in degrees under a build in metres: the sample climbs a quarter and a hump."""
        hill = Hill(641200, 5704100, 180, 0.15, -0.20, 12, 60)
        cell = 4e-5
        rows = [[hill(*utm(11.020 + (c + 0.5) * cell, 51.478 - (r + 0.5) * cell, 32)) for c in range(600)] for r in range(400)]
        path = self.raster('hill', rows, 11.020, 51.462, cell, DEGREES_PRJ)
        out = self.build(SAMPLE, 'sample', '--terrain', path, '--terrain-height-reference', 'sea-level')
        build = read_json(out, 'build.json')
        self.assertEqual(list(build['statistics']['sources']['ground_height']), ['terrain'])
        self.assertEqual(build['crs']['code'], 'EPSG:25832')
        error = hill.bilinear_error(cell * 111300, cell * 70000) + 1e-4
        figures = self.stands_well(out, hill, error, wanted=60)
        self.assertGreater(figures['plinths'], 40)
        self.sound(out)
        # A tile alone asks the same terrain and gives the same bytes; so do other numbers of threads.
        terrain = ('--terrain', path, '--terrain-height-reference', 'sea-level')
        name = sorted(files_of(os.path.join(out, 'citygml')), key=lambda n: os.path.getsize(os.path.join(out, 'citygml', n)))[-1]
        tile = name.split('.')[0].replace('_', '/')
        alone = self.build(SAMPLE, 'alone', '--tile', tile, '--pinned', os.path.join(out, 'build.json'), *terrain)
        for part in (f'citygml/{name}', f'tiles/{tile}.glb'):
            self.assertEqual(sha256(os.path.join(out, part)), sha256(os.path.join(alone, part)), part)
        self.same_files(out, self.build(SAMPLE, 'one', '--jobs', 1, *terrain))
        target = self.path('other')
        run = blockrand('build', SAMPLE, '-o', target, '--lod', '2', '--tile', tile, '--pinned', os.path.join(out, 'build.json'),
                        '--terrain', path, '--terrain-height-reference', 'ellipsoid')
        self.refused(run, 1, 'terrain_height_reference', target=target)

    def test_monaco(self):
        source = extract('monaco-2021.osm.pbf')
        if not source:
            self.skipTest('monaco-2021.osm.pbf is not here')
        west, south, cell, columns, lines = 370600, 4841400, 5, 1100, 1000
        hill = Hill(372700, 4843900, 60, -0.18, 0.22, 40, 200)
        rows = [[hill(west + (c + 0.5) * cell, south + (lines - r - 0.5) * cell) for c in range(columns)] for r in range(lines)]
        path = self.raster('riviera', rows, west, south, cell, UTM32_PRJ)
        out = self.build(source, 'monaco', '--terrain', path, '--terrain-height-reference', 'sea-level')
        missing = [r for r in read_json(out, 'report.json')['notices'] if r['code'] == 'TERRAIN_MISSING']
        self.assertEqual(missing, [])
        self.stands_well(out, hill, hill.bilinear_error(cell, cell) + 1e-4, step=1.0, wanted=1000)
        self.sound(out)

    def test_edge_of_the_raster(self):
        """Half of the sample lies beyond the raster: houses there stand at the ground height as if there were no terrain, and the report tells."""
        bare = self.build(SAMPLE, 'bare', '--ground-height', '150')
        plinths = {(owner, body.get(GML_ID)): attributes(body)['plinth_height'] for owner, body in bodies(bare)}
        rows = [[200.0 + 0.5 * c for c in range(40)] for _ in range(40)]
        path = self.raster('half', rows, 11.0330 - 40 * 2e-4, 51.466, 2e-4, DEGREES_PRJ)
        out = self.build(SAMPLE, 'half', '--terrain', path, '--terrain-height-reference', 'sea-level', '--ground-height', '150')
        missing = {r['id'] for r in read_json(out, 'report.json')['notices'] if r['code'] == 'TERRAIN_MISSING'}
        self.assertGreater(len(missing), 5)
        known = 0
        for owner, body in bodies(out):
            ground = float(attributes(body)['ground_height'])
            if owner in missing:
                self.assertEqual(ground, 150, owner)
                self.assertEqual(attributes(body)['plinth_height'], plinths[owner, body.get(GML_ID)], owner)
            else:
                self.assertTrue(200 <= ground < 220, f'{owner} {ground}')
                known += 1
        self.assertGreater(known, 5)
        self.sound(out)


class Vienna(OnTerrain):
    """Some hundreds of houses that nobody built, on the 1 m terrain of Schönbrunn, moved to where UTM is the CRS."""
    WEST, SOUTH = 600000, 5338000  # of the moved raster: near Vienna

    def test_houses(self):
        source = os.path.join(Setup.shared or '', 'data', 'imagery', 'wien-schoenbrunn', '44_2_dgm.tif')
        if not os.path.exists(source) or not shutil.which('gdal_translate'):
            self.skipTest('no terrain of Vienna, or no gdal_translate')
        text = self.path('text.asc')
        run = call(['gdal_translate', '-q', '-of', 'AAIGrid', '-co', 'DECIMAL_PRECISION=4', source, text])
        self.assertEqual(run.code, 0, run)
        with open(text, encoding='ascii') as f:
            lines = [line.split() for line in f]
        rows = [[float(v) for v in line] for line in lines if len(line) > 100]
        self.assertEqual((len(rows), len(rows[0])), (520, 520))
        self.assertGreater(min(map(min, rows)), -100, 'no gaps in it')
        path = self.raster('vienna', rows, self.WEST, self.SOUTH, 1, UTM33_PRJ)
        grid = Grid(rows, self.WEST, self.SOUTH + 520, 1.0)
        try:
            to_degrees = Proj('EPSG:25833', 'EPSG:4326')
        except OSError as absent:
            self.skipTest(str(absent))
        houses = write_xml(self.path('houses.osm'), list(self.town(to_degrees)))
        out = self.build(houses, 'vienna', '--crs', 'EPSG:25833', '--terrain', path, '--terrain-height-reference', 'ellipsoid')
        # Pixel centres lie at halves: a grid of halves has all of them.
        figures = self.stands_well(out, grid, 1e-4, step=0.1, spacing=0.5, wanted=300)
        self.assertGreater(figures['plinths'], 200)
        self.sound(out)

    def town(self, to_degrees):
        chance = random.Random(20230)
        number = 1

        def place(x, y):
            lon, lat, _ = to_degrees(x, y)
            return lon, lat

        def nodes(points):
            nonlocal number
            made = []
            for x, y in points:
                made.append(Node(number, *place(x, y)))
                number += 1
            return made
        spacing = 26
        for i in range(19):
            for j in range(19):
                x, y = self.WEST + 26 + spacing * i, self.SOUTH + 26 + spacing * j
                turn, w, d = chance.uniform(0, math.pi), chance.uniform(7, 16), chance.uniform(6, 12)
                kind = chance.choice(('rectangle', 'rectangle', 'L', 'U'))
                shape = {'rectangle': [(0, 0), (w, 0), (w, d), (0, d)],
                         'L': [(0, 0), (w, 0), (w, d / 2), (w / 2, d / 2), (w / 2, d), (0, d)],
                         'U': [(0, 0), (w, 0), (w, d), (w * .7, d), (w * .7, d * .4), (w * .3, d * .4), (w * .3, d), (0, d)]}[kind]
                c, s = math.cos(turn), math.sin(turn)
                corners = nodes([(x + c * (a - w / 2) - s * (b - d / 2), y + s * (a - w / 2) + c * (b - d / 2)) for a, b in shape])
                tags = {'building': chance.choice(('house', 'apartments', 'yes', 'garage'))}
                if chance.random() < 0.4:
                    tags['building:levels'] = str(chance.randint(1, 5))
                if chance.random() < 0.3:
                    tags['height'] = f'{chance.uniform(3, 15):.1f}'
                if chance.random() < 0.5:
                    tags['roof:shape'] = chance.choice(('flat', 'gabled', 'hipped', 'pyramidal'))
                yield from corners
                refs = [n.id for n in corners]
                yield Way(100000 + 100 * i + j, refs + refs[:1], tags)
            if i % 2 == 0:
                street = nodes([(self.WEST + 26 + spacing * (i + 0.5), self.SOUTH + 10), (self.WEST + 26 + spacing * (i + 0.5), self.SOUTH + 510)])
                yield from street
                yield Way(200000 + i, [n.id for n in street], {'highway': 'residential', 'name': f'Gasse {i}'})


class Reference(OnTerrain):
    """What the heights of a raster are above must be known, and reaches every output."""

    def flat(self, prj=DEGREES_PRJ):
        return self.raster('flat', [[100.0] * 20] * 20, 11.02, 51.46, 1e-3, prj)

    def origin(self, out):
        return [Glb(path).json['asset']['extras']['georeference'] for _, path in tile_contents(out)]

    def test_unsaid_is_refused(self):
        target = self.path('unsaid')
        run = blockrand('build', SAMPLE, '-o', target, '--terrain', self.flat())
        self.refused(run, 1, 'flat.asc', 'does not say', '--terrain-height-reference', 'sea-level', 'ellipsoid', 'EPSG:', target=target)

    def test_nonsense_is_refused(self):
        for text in ('tide', 'EPSG:25832', 'EPSG:1', '7837'):
            with self.subTest(text=text):
                target = self.path('nonsense')
                run = blockrand('build', SAMPLE, '-o', target, '--terrain', self.flat(), '--terrain-height-reference', text)
                self.refused(run, 1, text, 'vertical coordinate system', target=target)
        target = self.path('alone')
        self.refused(blockrand('build', SAMPLE, '-o', target, '--terrain-height-reference', 'ellipsoid'), 1, 'needs --terrain', target=target)

    def build_with(self, reference, name, terrain=None):
        how = ('--terrain-height-reference', reference) if reference else ()
        out = self.build(SAMPLE, name, '--terrain', terrain or self.flat(), *how, '--formats', 'gltf,citygml')
        self.sound(out)
        _, root = next(citygml_trees(out))
        return out, read_json(out, 'build.json')['crs'], root.find('.//gml:Envelope', NAMES).get('srsName'), self.origin(out)

    def test_sea_level(self):
        _, crs, srs, said = self.build_with('sea-level', 'sea')
        self.assertEqual((crs['vertical_crs'], srs), ('', 'urn:ogc:def:crs:EPSG::25832'))
        self.assertEqual(crs['to_ellipsoid']['from'], 'EPSG:5773')
        for g in said:  # EGM96 lies about 45 m above the ellipsoid here
            self.assertTrue(143 < g['origin']['height'] < 148, g)
            self.assertIn('EGM96', g['height_reference'])

    def test_ellipsoid(self):
        _, crs, srs, said = self.build_with('ellipsoid', 'ellipsoid')
        self.assertEqual((crs['vertical_crs'], srs, crs['to_ellipsoid']), ('', 'urn:ogc:def:crs:EPSG::25832', None))
        for g in said:
            self.assertEqual(g['origin']['height'], 100, g)
            self.assertNotIn('raised', g['height_reference'])

    def test_a_vertical_crs(self):
        """DHHN2016, for which PROJ has a grid or not: where not, EGM96 stands in, and that is said."""
        _, crs, srs, said = self.build_with('epsg:7837', 'dhhn')
        self.assertEqual(crs['vertical_crs'], 'EPSG:7837')
        self.assertEqual(srs, 'urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837')
        self.assertIn('DHHN2016', crs['height_reference'])
        if 'EGM96' in crs['to_ellipsoid']['by']:
            self.assertIsNone(crs['to_ellipsoid']['accuracy_m'])
            self.assertIn('in place of DHHN2016', self.last.err)
        for g in said:
            self.assertTrue(143 < g['origin']['height'] < 148, g)

    def test_a_local_zero_level(self):
        """Vienna's heights begin 156.68 m above the Adriatic: without a grid PROJ still knows the shift."""
        _, crs, _, said = self.build_with('EPSG:8881', 'vienna')
        self.assertEqual(crs['vertical_crs'], 'EPSG:8881')
        for g in said:
            self.assertTrue(143 + 155 < g['origin']['height'] < 148 + 158, g)

    def test_values_that_are_no_heights(self):
        """Marks for "unknown" that a raster does not declare count as missing, and are told once."""
        for value in (1e38, -1e38, -32768.0, 12000.0):
            with self.subTest(value=value):
                rows = [[100.0] * 20 for _ in range(20)]
                rows[7] = [value] * 20
                terrain = self.raster('holes', rows, 11.02, 51.46, 1e-3, DEGREES_PRJ)
                _, _, _, said = self.build_with('ellipsoid', f'holes{value:g}', terrain)
                self.assertIn('which is no height on Earth', self.last.err)
                self.assertRegex(self.last.err, r'pixel \d+,7 ')
                self.assertTrue(all(g['origin']['height'] == 100 for g in said), said)

    def test_what_the_raster_says(self):
        if not shutil.which('gdal_translate'):
            self.skipTest('no gdal_translate')
        named, above = self.path('named.tif'), self.path('above.tif')
        for target, srs in ((named, 'EPSG:4326+5773'), (above, 'EPSG:4979')):
            run = call(['gdal_translate', '-q', '-a_srs', srs, self.flat(), target])
            self.assertEqual(run.code, 0, run)
        _, crs, _, said = self.build_with(None, 'named', named)
        self.assertEqual(crs['vertical_crs'], 'EPSG:5773')
        self.assertNotIn('by its own words', self.last.err)
        _, crs, _, said = self.build_with('ellipsoid', 'contradicted', named)
        self.assertIn('by its own words', self.last.err)
        self.assertEqual(crs['vertical_crs'], '')
        self.assertTrue(all(g['origin']['height'] == 100 for g in said), said)
        _, crs, _, said = self.build_with(None, 'above', above)
        self.assertTrue(all(g['origin']['height'] == 100 for g in said), said)


if __name__ == '__main__':
    main()
