"""`blockrand validate` finds nothing in sound outputs of all kinds, and what does not fit the extract or the report."""
import os
import shutil

from blockrand_run import SAMPLE, Setup, blockrand, extract, files_of, main, read_json
from damage import Damaged
from validate_run import Validated

EMPTY = '<osm version="0.6"><node id="1" lat="51.47" lon="11.03"/></osm>'


class Positions(Validated):
    def test_positions_that_are_off_by_millimetres(self):
        """Without the extract the explanations say where things were mapped: one unit of OSM is 7 mm here."""
        source = self.path('town.osm')
        shutil.copy(SAMPLE, source)
        out = self.build(source, 'out')
        os.remove(source)
        result = self.sound(out)
        self.assertIn('explain/', result['positions']['source'])
        self.assertGreater(result['positions']['corners'], 200)
        d = Damaged(out, self.path('moved'))

        def move(records):
            for r in records:
                r['outline']['lon'] = [v + 1 for v in r['outline']['lon']]
        d.explanations(move)
        d.seal()
        findings = self.validate(d.folder)['findings']
        self.assertEqual({f['code'] for f in findings}, {'POSITION'})
        self.assertGreater(len(findings), 100)

    def test_five_centimetres_of_everything(self):
        """Where repair moved corners, each may be off; all of them in one direction may not."""
        source = self.path('moved_town.osm')
        shutil.copy(SAMPLE, source)
        out = self.build(source, 'bounded', '--formats', 'gltf,citygml')
        os.remove(source)
        for units, codes in ((0, set()), (7, {'POSITION'})):
            with self.subTest(units=units):
                d = Damaged(out, self.path(f'shifted{units}'))

                def move(records):
                    for r in records:
                        r['repair'] = {'vertices': 4, 'moved': 4, 'mean_shift': 0.2, 'max_shift': 0.3,
                                       'overlaps_resolved': 0}
                        r['outline']['lon'] = [v + units for v in r['outline']['lon']]
                for name in sorted(files_of(d.folder)):
                    if name.startswith('explain/') and name.endswith('.jsonl.gz'):
                        d.explanations(move, name)
                d.seal()
                result = self.validate(d.folder)
                self.assertEqual({f['code'] for f in result['findings']}, codes)
                self.assertEqual(result['positions']['corners_moved'], result['positions']['corners'])
                if units:
                    self.assertEqual({f['file'] for f in result['findings']}, {'GLB', 'CityGML'})
                    self.assertIn('the whole model was moved', result['findings'][0]['detail'])
                    self.assertAlmostEqual(result['positions']['median_m'], 0.0485, delta=0.003)

    def test_another_extract(self):
        out = self.build(SAMPLE, 'other')
        wrong = self.place('wrong.osm', EMPTY)
        self.refused(blockrand('validate', out, '--extract', wrong), 1, 'sha-256')
        self.refused(blockrand('validate', out, '--extract', self.path('none.osm')), 2, 'none.osm')


class Overlaps(Validated):
    """A part that begins within the roof of another by the height of its storeys, and ends just above: repair and masses leave it."""
    MAP = """<osm version="0.6">
      <node id="1" lat="51.47000" lon="11.03000"/><node id="2" lat="51.47000" lon="11.03040"/>
      <node id="3" lat="51.47020" lon="11.03040"/><node id="4" lat="51.47020" lon="11.03000"/>
      <node id="5" lat="51.47000" lon="11.03020"/><node id="6" lat="51.47020" lon="11.03020"/>
      <way id="10"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="yes"/></way>
      <way id="11"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/>
        <tag k="building:part" v="yes"/><tag k="height" v="12"/><tag k="roof:shape" v="gabled"/><tag k="roof:height" v="6"/></way>
      <way id="12"><nd ref="1"/><nd ref="5"/><nd ref="6"/><nd ref="4"/><nd ref="1"/>
        <tag k="building:part" v="yes"/><tag k="building:min_level" v="4"/><tag k="height" v="12.2"/></way>
    </osm>"""

    def test_one_that_the_report_tells(self):
        for formats in ('citygml,cityjson', 'gltf'):
            with self.subTest(formats=formats):
                result = self.sound(self.build(self.place('overlap.osm', self.MAP), formats, '--formats', formats))
                self.assertTrue(any('601 overlaps w10.w12' in n for n in result['notes']), result['notes'])

    def test_one_that_the_report_does_not_tell(self):
        out = self.build(self.place('overlap.osm', self.MAP), 'untold', '--formats', 'citygml', '--no-report')
        d = Damaged(out, self.path('untold_damaged'))

        def forget(report):
            report['notices'] = [r for r in report['notices'] if r['code'] != 'OVERLAP_KEPT']
        d.json('report.json', forget)
        d.json('build.json', lambda b: b['issues'].pop('OVERLAP_KEPT'))
        d.seal()
        result = self.validate(d.folder)
        found = [f for f in result['findings'] if f['code'] == 'SOLIDS_OVERLAP']
        self.assertEqual([(f['object'], f['number']) for f in found], [('w10.w11', 601)], result['findings'])


class Sound(Validated):
    def test_no_build(self):
        self.refused(blockrand('validate', self.path('nowhere')), 1, 'does not exist')
        self.refused(blockrand('validate', self.folder), 1, 'build.json')
        self.refused(blockrand('validate', SAMPLE), 1, 'is an extract, not a build')

    def test_text(self):
        out = self.build(SAMPLE, 'text')
        run = blockrand('validate', out)
        self.assertEqual(run.code, 0, run)
        self.assertEqual(run.out.splitlines()[-1], 'sound: nothing found')
        os.remove(os.path.join(out, 'report.json'))
        run = blockrand('validate', out)
        self.assertEqual(run.code, 2, run)
        self.assertTrue(run.out.splitlines()[-1].startswith('NOT SOUND: '), run)

    def test_threads_change_nothing(self):
        out = self.build(SAMPLE, 'threads')
        os.remove(os.path.join(out, 'report.json'))
        with open(next(os.path.join(out, f) for f in files_of(out, '.glb')), 'r+b') as f:
            f.truncate(100)
        one, four = (blockrand('validate', out, '--json', '--jobs', n) for n in (1, 4))
        self.assertEqual(one.out, four.out)

    def test_levels_of_detail(self):
        for lod in (0, 1, 2):
            with self.subTest(lod=lod):
                self.sound(self.build(SAMPLE, f'lod{lod}', '--lod', lod))

    def test_single_formats(self):
        for name in ('gltf', 'citygml', 'cityjson', 'gpkg'):
            with self.subTest(format=name):
                result = self.sound(self.build(SAMPLE, name, '--formats', name))
                self.assertEqual('positions' in result, name != 'gpkg')

    def test_compressed(self):
        self.sound(self.build(SAMPLE, 'gzip', '--gzip'))

    def test_single_files(self):
        self.sound(self.build(SAMPLE, 'single', '--single-glb', '--single-cityjson'))

    def test_windows_of_tiles_are_others_scaled(self):
        # A house here has 87 windows whose bands tiles show 3 cm wider than model.glb: 0.4 % of all that is drawn of it.
        source = extract('karlsruhe-suedweststadt-2026.osm.pbf')
        if not source:
            self.skipTest('the extracts of ../shared/data are absent')
        self.sound(self.build(source, 'scaled', '--lod', '3', '--surroundings', 'off', '--single-glb', '--formats', 'gltf', '--no-report', '--no-explain'))

    def test_without_report_and_explanations(self):
        self.sound(self.build(SAMPLE, 'bare', '--no-report', '--no-explain'))

    def test_without_any_record_of_repair(self):
        out = self.build(SAMPLE, 'unrecorded', '--no-explain', '--formats', 'citygml')
        notes = self.sound(out)['notes']
        self.assertTrue(any('neither explanations nor a GeoPackage' in note for note in notes), notes)

    def test_on_a_ground_height(self):
        self.sound(self.build(SAMPLE, 'ground', '--ground-height', '180'))

    def test_on_terrain(self):
        """A slope from 150 to 250 m, as an ESRI grid."""
        rows = [' '.join(f'{150 + 2 * (x + y):.2f}' for x in range(26)) for y in range(26)]
        header = 'ncols 26\nnrows 26\nxllcorner 11.02\nyllcorner 51.46\ncellsize 0.001\nNODATA_value -9999\n'
        terrain = self.place('slope.asc', header + '\n'.join(rows) + '\n')
        self.place('slope.prj', 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
                                'UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]]')
        out = self.build(SAMPLE, 'terrain', '--terrain', terrain, '--terrain-height-reference', 'sea-level')
        self.assertIn('terrain', read_json(out, 'build.json')['statistics']['sources']['ground_height'])
        self.sound(out)

    def test_another_crs(self):
        self.sound(self.build(SAMPLE, 'gk', '--crs', 'EPSG:31468'))

    def test_part_of_an_extract(self):
        self.sound(self.build(SAMPLE, 'part', '--bbox', '11.0300,51.4690,11.0330,51.4710'))

    def test_nothing_to_build(self):
        self.sound(self.build(self.place('empty.osm', EMPTY), 'empty'))

    def test_a_sample_of_tiles(self):
        result = self.sound(self.build(SAMPLE, 'sampled'), '--sample', 2)
        self.assertTrue(any('2th tile' in n for n in result['notes']), result['notes'])

    def test_schemas(self):
        schemas = os.path.join(Setup.shared or '', 'schemas')
        if not os.path.exists(os.path.join(schemas, 'citygml2.xsd')):
            self.skipTest('no CityGML schemas')
        self.sound(self.build(SAMPLE, 'schemas'), '--schemas', schemas)

    def test_a_real_extract(self):
        source = extract('berlin-zionskirchplatz-2020.osm')
        if not source:
            self.skipTest('no real extract')
        result = self.sound(self.build(source, 'real'))
        self.assertEqual(result['positions']['corners'], 1000)
        self.assertLess(result['positions']['worst_crs_m'], 1e-3)
        self.assertLess(result['positions']['worst_glb_m'], 1e-3)


if __name__ == '__main__':
    main()
