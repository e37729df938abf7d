"""What each option of `build` changes, `info`, help and version: on the sample, validated like any build."""
import gzip
import json
import os

import validators
from blockrand_run import SAMPLE, BuildTest, blockrand, files_of, main, read_json, sha256
from model_files import NAMES, Glb, attributes, buildings, citygml_trees, points, tile_contents

BLDG = '{%s}' % NAMES['bldg']


def count_elements(folder, name):
    return sum(len(root.findall(f'.//{BLDG}{name}')) for _, root in citygml_trees(folder))


class Options(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.plain = cls().build(SAMPLE, 'plain')

    def valid(self, folder):
        self.counts_add_up(folder)
        self.hashes_match(folder)
        self.assertEqual(validators.problems(folder), '')

    # ---- level of detail

    def test_lod_0(self):
        out = self.build(SAMPLE, 'lod0', '--lod', '0')
        self.valid(out)
        counts = read_json(out, 'build.json')['counts']
        self.assertEqual(counts['models'], counts['models_lod0'])
        self.assertEqual(counts['models'], read_json(self.plain, 'build.json')['counts']['models'])
        self.assertGreater(count_elements(out, 'lod0FootPrint'), 100)
        self.assertEqual((count_elements(out, 'lod1Solid'), count_elements(out, 'lod2Solid')), (0, 0))

    def test_lod_1(self):
        out = self.build(SAMPLE, 'lod1', '--lod', '1')
        self.valid(out)
        counts = read_json(out, 'build.json')['counts']
        self.assertEqual(counts['models'], counts['models_lod1'])
        self.assertEqual(count_elements(out, 'lod1Solid'), counts['solids_lod1'])
        self.assertEqual(count_elements(out, 'lod2Solid') + count_elements(out, 'boundedBy'), 0)

    # ---- formats

    def test_gltf_alone(self):
        out = self.build(SAMPLE, 'gltf', '--formats', 'gltf')
        self.valid(out)
        self.assertFalse(os.path.exists(os.path.join(out, 'citygml')))
        self.same_files(out, self.plain, 'tiles', 'tileset.json')

    def test_citygml_alone(self):
        out = self.build(SAMPLE, 'citygml', '--formats', 'citygml')
        self.valid(out)
        self.assertEqual([f for f in files_of(out) if f.endswith('.glb') or f == 'tileset.json'], [])
        self.same_files(out, self.plain, 'citygml')

    def test_all_formats_are_the_default(self):
        self.same_files(self.build(SAMPLE, 'all', '--formats', 'gltf,citygml,cityjson,gpkg'), self.plain)

    def test_gzip(self):
        out = self.build(SAMPLE, 'gzip', '--gzip')
        self.valid(out)
        self.assertEqual([f for f in files_of(out, '.gml')], [])
        texts = [{name.removesuffix('.gz'): [e.tag for e in root.iter()] for name, root in citygml_trees(f)}
                 for f in (out, self.plain)]
        self.assertEqual(*texts)
        with open(os.path.join(out, files_of(out, '.gml.gz')[0]), 'rb') as f:
            head = f.read(10)
        self.assertEqual(head[4:8], b'\0\0\0\0', 'gzip would carry the time of the clock')

    def test_precompress(self):
        out = self.build(SAMPLE, 'served', '--lod', '3', '--formats', 'gltf', '--precompress')
        self.valid(out)
        served = [f for f in files_of(out) if f == 'tileset.json' or f.endswith('.glb')]
        self.assertGreater(len(served), 3)
        self.assertEqual(sorted(f + '.gz' for f in served), sorted(f for f in files_of(out, '.gz') if not f.startswith('explain/')))
        sizes = [0, 0]
        for name in served:
            with open(os.path.join(out, name), 'rb') as f:
                plain = f.read()
            with open(os.path.join(out, name + '.gz'), 'rb') as f:
                packed = f.read()
            self.assertEqual(gzip.decompress(packed), plain, name)
            sizes = [sizes[0] + len(plain), sizes[1] + len(packed)]
        self.assertLess(sizes[1], sizes[0] / 2)
        # What the .gz holds is checked, and that it is there.
        blob = next(f for f in served if f.endswith('.glb')) + '.gz'
        with open(os.path.join(out, blob), 'wb') as f:
            f.write(gzip.compress(b'another file'))
        run = blockrand('validate', out, '--progress', 'none')
        self.assertEqual(run.code, 2, run)
        self.assertIn('GZIP_DIFFERS', run.out)

    def test_what_no_format_reads_is_told(self):
        """An option that changes no file of the formats that are asked for is named, and one that does is not."""
        asked = ('--precompress', '--gzip', '--citygml-detail', 'full', '--objects', 'tile', '--compress', 'none', '--evidence')
        for formats, more, told in (('gpkg', (), ('precompress', 'gzip', 'citygml-detail', 'objects', 'compress', 'evidence')),
                                    ('gltf', ('--lod', '3', '--single-glb'), ('gzip', 'citygml-detail')),
                                    ('citygml', ('--lod', '2'), ('precompress', 'citygml-detail', 'objects', 'compress')),
                                    ('gpkg', ('--areas', '12'), ('precompress', 'gzip', 'citygml-detail', 'objects', 'compress', 'evidence'))):
            for command in (('build', SAMPLE, '-o', self.path('unread')), ('build', SAMPLE, '-o', self.path('unread'), '--dry-run')):
                run = blockrand(*command, *asked, '--formats', formats, *more, '--no-report', '--progress', 'none',
                                '--force')
                self.assertEqual(run.code, 0, run)
                named = [line.split('--')[1].split(' ')[0] for line in (run.out + run.err).splitlines() if 'changes nothing here' in line]
                self.assertEqual(sorted(named), sorted(told), (formats, command))

    def test_single_glb(self):
        out = self.build(SAMPLE, 'single', '--single-glb')
        self.valid(out)
        whole = Glb(os.path.join(out, 'model.glb'))
        parts = [i for _, path in tile_contents(out) for i in Glb(path).texts('id')]
        self.assertEqual(sorted(whole.texts('id')), sorted(parts))
        self.assertIn('local_to_ecef', whole.json['asset']['extras']['georeference'])
        self.same_files(out, self.plain, 'tiles', 'tileset.json', 'citygml')

    def test_attributes(self):
        """With all attributes only the property tables differ; what people see is a part of it, rounded."""
        everything = self.build(SAMPLE, 'attributes', '--attributes', 'all', '--single-glb')
        self.valid(everything)
        self.same_files(everything, self.plain, 'tileset.json', 'citygml', 'cityjson', 'buildings.qgz')
        rounding = {'height': 10, 'eaves_height': 10, 'roof_height': 10, 'storeys': 10, 'roof_pitch': 1}
        for (_, path), (_, plain) in zip(tile_contents(everything), tile_contents(self.plain)):
            whole, people = Glb(path), Glb(plain)
            columns = list(people.columns())
            self.assertEqual(columns[0], 'address')
            self.assertEqual(columns[-4:], ['sources', 'lod', 'id', 'building'] if 'fallbacks' not in columns
                             else ['fallbacks', 'lod', 'id', 'building'])
            self.assertLess(columns.index('style'), columns.index('storeys'))
            self.assertEqual(list(whole.columns()), sorted(whole.columns()))
            self.assertLessEqual({'tags', 'height_source', 'height_confidence', 'osm_id'}, set(whole.columns()))
            self.assertEqual({c for c in columns if c.endswith('_source')} | ({'tags'} & set(columns)), set())
            for name in ('address', 'use', 'style', 'wall_colour', 'id', 'building'):
                if name in columns:
                    self.assertEqual(people.texts(name), whole.texts(name), name)
            for name, steps in rounding.items():
                self.assertEqual(list(people.numbers(name)), [round(v * steps) / steps for v in whole.numbers(name)], name)
            for text in people.texts('sources'):
                self.assertRegex(text, r'^(\w+: \w+(, \w+)*)(; \w+: \w+(, \w+)*)*$')
        self.assertEqual(list(Glb(os.path.join(everything, 'model.glb')).columns())[0], 'address')
        self.assertIn('tags', Glb(os.path.join(everything, 'model.glb')).columns())

    # ---- where

    def test_bbox(self):
        out = self.build(SAMPLE, 'bbox', '--bbox', '11.0290,51.4690,11.0320,51.4710')
        self.valid(out)
        some, all_of_them = (read_json(f, 'build.json')['counts']['models'] for f in (out, self.plain))
        self.assertTrue(10 < some < all_of_them - 10, (some, all_of_them))
        self.assertLess(set(buildings(out)), set(buildings(self.plain)))

    def test_crs(self):
        out = self.build(SAMPLE, 'crs', '--crs', 'EPSG:31468')
        self.valid(out)
        self.assertEqual(read_json(out, 'build.json')['crs']['code'], 'EPSG:31468')
        name, root = next(citygml_trees(out))
        self.assertIn('31468', root.find('.//gml:Envelope', NAMES).get('srsName'), name)
        x, y, _ = next(points(root))
        # Gauß-Krüger zone 4: false easting 4,500 km, central meridian 12° E.
        self.assertTrue(4_430_000 < x < 4_436_000 and 5_700_000 < y < 5_710_000, (x, y))

    def test_ground_height(self):
        out = self.build(SAMPLE, 'ground', '--ground-height', '123.5')
        self.valid(out)
        lowest = min(p[2] for _, root in citygml_trees(out) for p in points(root))
        self.assertEqual(lowest, 123.5)
        # EGM96 at the sample lies about 45 m above the ellipsoid: 3D Tiles must stand that much higher.
        heights = [Glb(path).json['asset']['extras']['georeference']['origin']['height'] for _, path in tile_contents(out)]
        for h in heights:
            self.assertTrue(123.5 + 43 < h < 123.5 + 48, heights)
        self.assertNotIn('no --ground-height', self.last.err)

    def test_terrain(self):
        """A slope in an ESRI ASCII grid: the base of each building is the lowest ground under it."""
        rows = ['ncols 40', 'nrows 30', 'xllcorner 11.025', 'yllcorner 51.465', 'cellsize 0.0005', 'NODATA_value -9999']
        rows += [' '.join(f'{200 + 2 * column:.1f}' for column in range(40)) for _ in range(30)]
        raster = self.place('slope.asc', '\n'.join(rows) + '\n')
        self.place('slope.prj', 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
                                'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
        out = self.build(SAMPLE, 'terrain', '--terrain', raster, '--terrain-height-reference', 'sea-level')
        self.valid(out)
        bases = {i: min(p[2] for p in points(b)) for i, b in buildings(out).items()}
        self.assertGreater(max(bases.values()) - min(bases.values()), 20, 'buildings follow the slope')
        self.assertTrue(all(200 <= z <= 280 for z in bases.values()))
        sources = read_json(out, 'build.json')['statistics']['sources']['ground_height']
        self.assertEqual(list(sources), ['terrain'])
        self.assertIn('terrain', [i['role'] for i in read_json(out, 'build.json')['inputs']])

    # ---- the rest

    def test_strict(self):
        """Objects of the sample that cannot be built are below any quality: exit code 3, yet the build is there."""
        target = self.path('strict')
        run = blockrand('build', SAMPLE, '-o', target, '--strict', '--lod', '2', '--progress', 'none')
        below = [r for r in read_json(target, 'report.json')['fallbacks'] if r['code'] in ('LOD1_ONLY', 'REST_FAILED')]
        self.assertEqual(run.code, 3 if below else 0, run)
        self.same_files(target, self.plain)

    def test_config_file(self):
        config = self.place('town.toml', '[build]\nlod = 1\nformats = ["citygml"]\ngzip = true\n')
        out = self.build(SAMPLE, 'config', '--config', config)
        self.assertEqual(read_json(out, 'build.json')['configuration']['lod'], 1)
        self.assertTrue(files_of(out, '.gml.gz'))
        self.assertFalse(os.path.exists(os.path.join(out, 'tileset.json')))
        stronger = self.build(SAMPLE, 'stronger', '--config', config, '--lod', '0', '--no-gzip')
        self.assertEqual(read_json(stronger, 'build.json')['configuration']['lod'], 0)
        self.assertEqual(files_of(stronger, '.gml.gz'), [])

    def test_printed_config_is_a_config(self):
        printed = blockrand('help', 'options', '--toml')
        self.assertEqual(printed.code, 0, printed)
        self.same_files(self.build(SAMPLE, 'printed', '--config', self.place('all.toml', printed.out), '--lod', '2'), self.plain)

    def test_force_replaces_a_build(self):
        out = self.build(SAMPLE, 'force', '--lod', '0')
        self.build(SAMPLE, 'force', '--force')
        self.same_files(out, self.plain)

    def test_progress_plain(self):
        run = blockrand('build', SAMPLE, '-o', self.path('progress'), '--lod', '2', '--progress', 'plain')
        self.assertEqual(run.code, 0, run)
        self.assertIn('tiles', run.err)
        self.assertNotIn('\r', run.err)

    def test_log_format_json(self):
        run = blockrand('build', SAMPLE, '-o', self.path('json'), '--lod', '2', '--log-format', 'json', '--progress', 'plain')
        self.assertEqual(run.code, 0, run)
        lines = [json.loads(line) for line in run.err.splitlines()]
        self.assertIn('warning', {line['level'] for line in lines})
        self.assertEqual(json.loads(run.out)['models'], read_json(self.plain, 'build.json')['counts']['models'])

    def test_seed_is_recorded(self):
        out = self.build(SAMPLE, 'seed', '--seed', '7')
        self.assertEqual(read_json(out, 'build.json')['configuration']['seed'], 7)

    def test_parents_are_made(self):
        self.build(SAMPLE, os.path.join('deep', 'deeper', 'out'), '--lod', '0')

    def test_spaces_and_umlauts_in_paths(self):
        folder = self.path('Häuser am Bach')
        os.mkdir(folder)
        source = os.path.join(folder, 'mein viertel.osm')
        with open(SAMPLE, 'rb') as a, open(source, 'wb') as b:
            b.write(a.read())
        out = self.build(source, os.path.join('Häuser am Bach', 'aus gabe'))
        self.same_files(out, self.plain, 'tiles', 'citygml', 'tileset.json')

    # ---- info, help, version

    def test_info(self):
        run = blockrand('info', SAMPLE)
        self.assertEqual(run.code, 0, run)
        counts = read_json(self.plain, 'build.json')['counts']
        self.assertIn(str(counts['buildings_in']), run.out)

    def test_info_json(self):
        run = blockrand('info', SAMPLE, '--json')
        self.assertEqual(run.code, 0, run)
        said = json.loads(run.out)
        flat = json.dumps(said)
        counts = read_json(self.plain, 'build.json')['counts']
        numbers = set()

        def collect(value):
            if isinstance(value, dict):
                for v in value.values():
                    collect(v)
            elif isinstance(value, list):
                for v in value:
                    collect(v)
            else:
                numbers.add(value)
        collect(said)
        self.assertIn(counts['buildings_in'], numbers, flat[:2000])
        self.assertIn(counts['parts_in'], numbers, flat[:2000])
        self.assertIn('EPSG:25832', flat)

    def test_help(self):
        for arguments in (['--help'], ['build', '--help'], ['info', '--help'], ['help'], ['help', 'build'],
                          ['help', 'options'], ['help', 'codes']):
            run = blockrand(*arguments)
            self.assertEqual(run.code, 0, run)
            self.assertGreater(len(run.out), 200, run)
            self.assertEqual(run.err, '', run)
        for command in ('build', 'info'):
            self.assertIn('Examples:', blockrand(command, '--help').out)

    def test_version(self):
        run = blockrand('--version')
        self.assertEqual(run.code, 0, run)
        self.assertRegex(run.out, r'^blockrand \d+\.\d+\.\d+\n')
        self.assertEqual(run.out.split()[1], read_json(self.plain, 'build.json')['program']['version'])

    def test_program_works_from_any_folder(self):
        """Configs are found by the program's place, not by the working directory."""
        out = self.build(SAMPLE, 'elsewhere', cwd='/')
        self.same_files(out, self.plain)
        self.assertEqual(sha256(os.path.join(out, 'report.json')), sha256(os.path.join(self.plain, 'report.json')))


if __name__ == '__main__':
    main()
