"""What cannot be read is refused with a reason, wrong calls are explained, and nothing half-written stays behind."""
import bz2
import gzip
import os
import shutil
import unittest

import validators
from blockrand_run import SAMPLE, BuildTest, blockrand, hashes, main, read_json, stray_siblings
from model_files import citygml_trees
from osm_files import Node, blob, house, number_field, pbf_bytes, primitive_block, read_xml, town, write_pbf, write_xml


class BadExtracts(BuildTest):
    """Exit code 2, the file's name in the message, no output."""

    def refuse(self, source, *words):
        out = self.path('refused', 'deep', 'out')
        run = blockrand('build', source, '-o', out, '--lod', '2', '--progress', 'none')
        self.refused(run, 2, os.path.basename(source), *words, target=out)
        self.assertFalse(os.path.exists(self.path('refused')), 'a folder made for the output stays behind')
        return run

    def test_zero_bytes(self):
        for name in ('zero.osm', 'zero.osm.pbf', 'zero.osm.gz', 'zero.osm.bz2'):
            with self.subTest(name):
                self.refuse(self.place(name, b''))

    def test_missing_file(self):
        self.refuse(self.path('nobody.osm.pbf'))
        self.assertEqual(blockrand('info', self.path('nobody.osm')).code, 2)

    def test_folder_instead_of_file(self):
        for name in ('folder', 'folder.osm', 'folder.osm.pbf'):
            with self.subTest(name):
                os.mkdir(self.path(name))
                self.refuse(self.path(name))

    def test_change_files(self):
        """What was done between two states of the map is no map; under any name, packed or not."""
        change = (b'<?xml version="1.0"?>\n<!-- <osm> -->\n<osmChange version="0.6"><create>'
                  b'<node id="1" version="1" lat="51.5" lon="11"/></create></osmChange>\n')
        for name, data in (('c.osm', change), ('c.osm.gz', gzip.compress(change)), ('c.osm.bz2', bz2.compress(change))):
            with self.subTest(name):
                self.refuse(self.place(name, data), 'osmChange', 'apply-changes')

    def test_coordinates_without_granularity(self):
        """All nodes of such a file stand at one place: no empty success."""
        objects = [o for o in house(1, 11, 51.5)]
        block = primitive_block(objects) + number_field(17, 0)
        data = pbf_bytes([])[0] + blob(b'OSMData', block)
        self.refuse(self.place('g.osm.pbf', data), 'granularity')

    def test_truncated_pbf(self):
        blocks = pbf_bytes(read_xml(SAMPLE), block_size=300)
        self.assertGreater(len(blocks), 4)
        data = b''.join(blocks)
        borders = {sum(len(b) for b in blocks[:i]) for i in range(len(blocks) + 1)}
        cuts = {1, 3, 4, 5, 10, len(blocks[0]) - 1, len(blocks[0]) + 2, len(blocks[0]) + 20, len(data) - 1,
                *(len(data) * i // 10 for i in range(1, 10))} - borders
        for cut in sorted(cuts):
            with self.subTest(cut=cut, of=len(data)):
                self.refuse(self.place('cut.osm.pbf', data[:cut]))

    def test_damaged_pbf(self):
        """Bytes changed inside: refused or, where it is only a tag that changed, built; never a crash."""
        data = b''.join(pbf_bytes(read_xml(SAMPLE), block_size=300))
        refused = 0
        for i in range(40):
            at = 5 + (len(data) - 10) * i // 40
            source = self.place('damaged.osm.pbf', data[:at] + bytes([data[at] ^ 0xff]) + data[at + 1:])
            out = self.path('damaged')
            run = blockrand('build', source, '-o', out, '--force', '--lod', '2', '--progress', 'none')
            self.assertIn(run.code, (0, 2), run)
            refused += run.code == 2
            self.assertEqual(stray_siblings(out), [])
        self.assertGreater(refused, 30, 'nearly every change breaks a compressed block')

    def test_truncated_xml(self):
        with open(SAMPLE, 'rb') as f:
            data = f.read()
        for cut in (5, 60, len(data) // 3, len(data) // 2, len(data) - 8, len(data) - 3):
            with self.subTest(cut=cut, of=len(data)):
                self.refuse(self.place('cut.osm', data[:cut]))

    def test_truncated_archives(self):
        with open(SAMPLE, 'rb') as f:
            plain = f.read()
        for end, packed in (('gz', gzip.compress(plain)), ('bz2', bz2.compress(plain, 1))):
            for cut in (3, 12, len(packed) // 2, len(packed) - 9, len(packed) - 1):
                with self.subTest(end=end, cut=cut, of=len(packed)):
                    self.refuse(self.place(f'cut.osm.{end}', packed[:cut]))

    def test_damaged_archives(self):
        with open(SAMPLE, 'rb') as f:
            plain = f.read()
        for end, packed in (('gz', gzip.compress(plain)), ('bz2', bz2.compress(plain))):
            for at in (len(packed) // 2, len(packed) - 6):
                with self.subTest(end=end, at=at):
                    changed = packed[:at] + bytes([packed[at] ^ 0x55]) + packed[at + 1:]
                    self.refuse(self.place(f'damaged.osm.{end}', changed))

    def test_content_against_the_name(self):
        with open(SAMPLE, 'rb') as f:
            xml = f.read()
        pbf = b''.join(pbf_bytes(read_xml(SAMPLE)))
        for name, data in (('really-pbf.osm', pbf), ('really-xml.osm.pbf', xml), ('really-gz.osm', gzip.compress(xml)),
                           ('really-xml.osm.gz', xml), ('really-gz.osm.bz2', gzip.compress(xml)),
                           ('really-bz2.osm.gz', bz2.compress(xml)), ('pbf-in.osm.gz', gzip.compress(pbf)),
                           ('page.osm', b'<!DOCTYPE html>\n<html><body>429 Too Many Requests</body></html>\n'),
                           ('page.osm.pbf', b'<!DOCTYPE html>\n<html><body>404 Not Found</body></html>\n'),
                           ('error.osm', b'{"error": "too many nodes"}\n'), ('noise.osm.pbf', bytes(range(256)) * 40),
                           ('other.osm', b"<?xml version='1.0'?>\n<gpx version='1.1'><wpt lat='1' lon='2'/></gpx>\n")):
            with self.subTest(name):
                self.refuse(self.place(name, data))

    def test_unknown_kind_of_file(self):
        with open(SAMPLE, 'rb') as f:
            self.refuse(self.place('quarter.txt', f.read()))

    def test_malformed_xml(self):
        head = b"<?xml version='1.0'?><osm version='0.6'>"
        node = b"<node id='1' version='1' lat='51.5' lon='11.0'>"
        for name, data in (('nul-entity', head + node + b"<tag k='name' v='a&#0;b'/></node></osm>"),
                           ('nul-byte', head + node + b"<tag k='name' v='a\0b'/></node></osm>"),
                           ('bad-utf8', head + node + b"<tag k='name' v='\xff\xfe'/></node></osm>"),
                           ('unclosed', head + node + b'</osm>'),
                           ('bad-number', head + b"<node id='x' version='1' lat='51' lon='11'/></osm>"),
                           ('bad-latitude', head + b"<node id='1' version='1' lat='fifty' lon='11'/></osm>"),
                           ('bad-reference', head + b"<way id='1' version='1'><nd ref='abc'/></way></osm>")):
            with self.subTest(name):
                self.refuse(self.place(name + '.osm', data))

    def test_endless_tag(self):
        """OSM allows 255 characters; no editor writes more."""
        objects = house(1, 11, 51.5, {'name': 'x' * 60000})
        self.refuse(write_xml(self.path('endless.osm'), objects), 'long')
        self.refuse(write_pbf(self.path('endless.osm.pbf'), objects), 'long')

    def test_message_has_a_line_number_for_xml(self):
        run = self.refuse(self.place('line.osm', "<?xml version='1.0'?>\n<osm version='0.6'>\n<node id='1'\n</osm>\n"))
        self.assertRegex(run.err, r'line\.osm:line [34]\b')


class EmptyExtracts(BuildTest):
    """Valid without buildings: exit code 0, a warning, valid outputs with nothing in them."""

    def empty(self, source):
        out = self.build(source, os.path.basename(source) + '-out', '--single-glb')
        self.assertRegex(self.last.err.lower(), 'warning.*no building', self.last)
        build, _ = self.counts_add_up(out)
        self.assertEqual((build['counts']['models'], build['counts']['represented']), (0, 0))
        self.hashes_match(out)
        self.assertEqual(validators.xmllint(out), '')
        self.assertEqual(validators.tileset(out), '')
        self.assertEqual(validators.khronos(out), '')
        self.assertEqual(validators.validate(out), '')
        self.assertEqual(sum(len(root.findall('.//{*}Building')) for _, root in citygml_trees(out)), 0)
        return build

    def test_osm_element_only(self):
        self.empty(self.place('bare.osm', "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6'/>\n"))

    def test_pbf_header_only(self):
        self.empty(write_pbf(self.path('header.osm.pbf'), []))

    def test_without_buildings(self):
        objects = [o for o in read_xml(SAMPLE) if not any(k.startswith('building') for k in o.tags)]
        self.empty(write_xml(self.path('streets.osm'), objects))
        self.empty(write_pbf(self.path('streets.osm.pbf'), objects))

    def test_building_no_is_no_building(self):
        self.empty(write_xml(self.path('no.osm'), house(1, 11, 51.5, {'building': 'no'})))

    def test_only_points(self):
        build = self.empty(write_xml(self.path('points.osm'), [Node(i, 11, 51.5, {'building': 'yes'}) for i in (1, 2, 3)]))
        self.assertEqual(build['issues'], {'NODE_ONLY': 3})

    def test_bbox_beside_the_data(self):
        out = self.build(SAMPLE, 'beside', '--bbox', '12,50,12.1,50.1')
        self.assertRegex(self.last.err.lower(), 'warning.*no building')
        self.assertEqual(read_json(out, 'build.json')['counts']['buildings_in'], 0)

    def test_info(self):
        run = blockrand('info', self.place('bare2.osm', "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6'/>\n"))
        self.assertEqual(run.code, 0, run)


class WrongCalls(BuildTest):
    """Exit code 1, and the message names what is wrong."""

    def wrong(self, *arguments, words=(), code=1):
        run = blockrand(*arguments)
        self.refused(run, code, *words)
        self.assertEqual(os.listdir(self.folder), self.before)
        return run

    def setUp(self):
        self.before = os.listdir(self.folder)

    def test_commands(self):
        self.wrong()
        self.wrong('biuld', SAMPLE, words=['biuld', 'build'])
        self.wrong('build', words=['INPUT'])
        self.wrong('build', SAMPLE, words=['--output'])
        self.wrong('build', '-o', self.path('out'), words=['INPUT'])
        self.wrong('info', words=['INPUT'])

    def test_unknown_option_names_the_nearest(self):
        self.wrong('build', SAMPLE, '-o', self.path('out'), '--job', '4', words=['--job', '--jobs'])
        self.wrong('build', SAMPLE, '-o', self.path('out'), '--gzipp', words=['--gzipp', '--gzip'])
        self.wrong('info', SAMPLE, '--strict', words=['--strict', 'option of build'])

    def test_two_inputs(self):
        self.wrong('build', SAMPLE, SAMPLE, '-o', self.path('out'))

    def test_bad_values(self):
        for option, value in (('--lod', '4'), ('--lod', '-1'), ('--lod', 'two'), ('--lod', ''), ('--jobs', '-1'),
                              ('--jobs', 'many'), ('--jobs', '1.5'), ('--bbox', '1,2,3'), ('--bbox', '1,2,3,4,5'),
                              ('--bbox', 'a,b,c,d'), ('--bbox', '11,52,10,51'), ('--bbox', '11,52,12,51'),
                              ('--bbox', '-200,51,12,52'), ('--bbox', 'nan,51,12,52'), ('--formats', 'obj'),
                              ('--formats', ''), ('--formats', 'gltf,'), ('--crs', 'UTM'), ('--crs', 'EPSG:4326'),
                              ('--crs', 'EPSG:99999'), ('--crs', 'EPSG:25833+5783'), ('--crs', 'EPSG:2263'),
                              ('--seed', 'x'), ('--seed', '-3'), ('--ground-height', 'high'),
                              ('--ground-height', 'nan'), ('--ground-height', '1e9'), ('--progress', 'loud'),
                              ('--log-format', 'xml'), ('--configs', '/nowhere')):
            with self.subTest(f'{option} {value}'):
                self.wrong('build', SAMPLE, '-o', self.path('out'), f'{option}={value}', words=[option.strip('-')])

    def test_value_missing(self):
        self.wrong('build', SAMPLE, '-o', self.path('out'), '--lod', words=['lod'])

    def test_crs_of_another_continent(self):
        """The sample lies 40 zones from UTM 60 S: refused, or right to the millimetre; never silently wrong."""
        target = self.path('antipode')
        # Its metres are no metres here: houses would be too wide for their heights.
        self.refused(blockrand('build', SAMPLE, '-o', target, '--crs', 'EPSG:3857', '--progress', 'none'), 1, 'EPSG:3857', 'too wide', 'EPSG:25832', target=target)
        run = blockrand('build', SAMPLE, '-o', target, '--crs', 'EPSG:32760', '--progress', 'none')
        if run.code == 0:
            self.assertLess(read_json(target, 'build.json')['crs']['round_trip_error_m'], 1e-3)
        else:
            self.refused(run, 1, 'crs', target=target)

    def test_terrain_that_is_none(self):
        text = self.place('terrain.tif', 'not a raster')
        out = self.path('out')
        self.refused(blockrand('build', SAMPLE, '-o', out, '--terrain', text), 2, 'terrain.tif', target=out)
        self.refused(blockrand('build', SAMPLE, '-o', out, '--terrain', self.path('absent.tif')), 2, 'absent.tif', target=out)


class BadConfigs(BuildTest):
    """Exit code 2 (or 1 for a value that cannot be), and file:line:column in the message."""

    def test_messages_name_the_place(self):
        for name, text, line, column, words in (
                ('unknown', '[build]\nlod = 2\nfromats = "gltf"\n', 3, 1, ['fromats', 'formats']),
                ('section', '[build]\nlod = 2\n\n[bulid]\nlod = 1\n', 4, None, ['bulid', 'build']),
                ('type', '[build]\n  lod = "two"\n', 2, None, ['lod']),
                ('range', '[build]\nlod = 2\njobs = -4\n', 3, None, ['jobs']),
                ('syntax', '[build]\nlod = = 2\n', 2, None, []),
                ('twice', '[build]\nlod = 1\nlod = 2\n', 3, None, ['lod']),
                ('nested', '[repair]\nspike_width = 0.1\nspike_widht = 0.2\n', 3, 1, ['spike_widht', 'spike_width']),
                ('unclosed', '[build]\ncrs = "EPSG:25833\n', 2, None, [])):
            with self.subTest(name):
                config = self.place(name + '.toml', text)
                out = self.path('out')
                run = blockrand('build', SAMPLE, '-o', out, '--config', config)
                self.assertIn(run.code, (1, 2), run)
                self.refused(run, run.code, *words, target=out)
                self.assertRegex(run.err, rf'{name}\.toml:{line}:{column or "[0-9]+"}\b')

    def test_missing_config(self):
        run = blockrand('build', SAMPLE, '-o', self.path('out'), '--config', self.path('absent.toml'))
        self.refused(run, 2, 'absent.toml', target=self.path('out'))

    def test_config_is_a_folder(self):
        run = blockrand('build', SAMPLE, '-o', self.path('out'), '--config', self.folder)
        self.assertIn(run.code, (1, 2), run)
        self.refused(run, run.code, target=self.path('out'))

    def test_binary_config(self):
        run = blockrand('build', SAMPLE, '-o', self.path('out'), '--config', self.place('noise.toml', bytes(range(256))))
        self.refused(run, 2, 'noise.toml', target=self.path('out'))


class WrongPlaces(BuildTest):
    """Output places that cannot be used: exit code 1, and what is there stays as it is."""

    def test_parent_is_a_file(self):
        file = self.place('file', 'mine')
        for target in (os.path.join(file, 'out'), os.path.join(file, 'deep', 'out'), file):
            with self.subTest(target):
                self.refused(blockrand('build', SAMPLE, '-o', target), 1)
                self.refused(blockrand('build', SAMPLE, '-o', target, '--force'), 1)
        with open(file) as f:
            self.assertEqual(f.read(), 'mine')

    def test_existing_build_without_force(self):
        out = self.build(SAMPLE, 'existing', '--lod', '0')
        before = hashes(out)
        self.refused(blockrand('build', SAMPLE, '-o', out), 1, '--force')
        self.assertEqual(hashes(out), before)
        self.assertEqual(stray_siblings(out), [])

    def test_force_on_a_folder_that_is_no_build(self):
        precious = self.path('photos')
        os.mkdir(precious)
        self.place('photos/holiday.jpg', 'irreplaceable')
        for options in ([], ['--force']):
            self.refused(blockrand('build', SAMPLE, '-o', precious, *options), 1, 'build.json')
        self.assertEqual(os.listdir(precious), ['holiday.jpg'])
        self.assertEqual(stray_siblings(precious), [])

    def test_inputs_in_the_output_folder(self):
        """--force replaces the folder as a whole: what the build reads must not go with it."""
        out = self.build(SAMPLE, 'own', '--lod', '0')
        inner = shutil.copy(SAMPLE, os.path.join(out, 'inner.osm'))
        os.symlink(out, self.path('own-link'))
        for target in (out, out + '/', self.path('own-link')):
            self.refused(blockrand('build', inner, '-o', target, '--force'), 1, 'inner.osm', 'lies in the output folder')
        os.remove(inner)
        self.place('own/order.toml', '')
        self.refused(blockrand('build', SAMPLE, '-o', out, '--force', '--overrides', os.path.join(out, 'order.toml')), 1,
                     'order.toml')
        os.remove(os.path.join(out, 'order.toml'))
        record = os.path.join(out, 'build.json')
        self.refused(blockrand('build', SAMPLE, '-o', out, '--force', '--tile', '15/0/0', '--pinned', record), 1, 'build.json')
        self.hashes_match(out)

    def test_files_of_others_in_the_output_folder(self):
        """Told by name and kept; what GDAL and SQLite leave beside our files is no reason."""
        out = self.build(SAMPLE, 'shared', '--lod', '0')
        self.place('shared/notes.txt', 'mine')
        os.mkdir(os.path.join(out, 'maps'))
        self.place('shared/maps/plan.qgz', 'mine')
        self.refused(blockrand('build', SAMPLE, '-o', out, '--force'), 1, 'maps/plan.qgz, notes.txt', 'did not write')
        self.assertTrue(os.path.exists(os.path.join(out, 'maps', 'plan.qgz')))
        os.remove(os.path.join(out, 'notes.txt'))
        os.remove(os.path.join(out, 'maps', 'plan.qgz'))
        for name in ('plan.png.aux.xml', 'citygml/a.gfs', 'buildings.gpkg-wal', 'buildings.gpkg-shm'):
            self.place('shared/' + name, '')
        self.build(SAMPLE, 'shared', '--lod', '0', '--force')
        self.hashes_match(out)

    def test_a_good_build_is_not_replaced_by_an_empty_one(self):
        out = self.build(write_xml(self.path('forty.osm'), town(40)), 'good', '--lod', '0')
        before = hashes(out)
        for count, options, words in ((0, [], ('no models', '--allow-empty')),
                                      (19, [], ('19 models', '52.5 %', '--allow-shrink 53')),
                                      (30, ['--allow-shrink', '20'], ('25.0 %', '--allow-shrink 25'))):
            small = write_xml(self.path('few.osm'), town(count))
            with self.subTest(count=count):
                self.refused(blockrand('build', small, '-o', out, '--force', '--lod', '0', *options), 2, *words)
                self.assertEqual(hashes(out), before)
                self.assertEqual(stray_siblings(out), [])
        few = write_xml(self.path('few.osm'), town(19))
        self.build(few, 'good', '--lod', '0', '--force', '--allow-shrink', '53')
        self.build(write_xml(self.path('none.osm'), town(0)), 'good', '--lod', '0', '--force', '--allow-empty')
        self.build(few, 'good', '--lod', '0', '--force')

    def test_what_a_dead_run_left_is_told_and_removed(self):
        os.mkdir(self.path('.dead.part-999999999'))
        self.place('.dead.part-999999999/tile.glb', b'x' * 5_000_000)
        self.build(SAMPLE, 'dead', '--lod', '0')
        self.assertIn('.dead.part-999999999 (5.0 MB)', self.last.err)
        self.assertEqual(stray_siblings(self.path('dead')), [])

    def test_empty_folder_is_used(self):
        os.mkdir(self.path('empty'))
        self.build(SAMPLE, 'empty', '--lod', '0')

    def test_bad_input_leaves_the_old_build(self):
        out = self.build(SAMPLE, 'kept', '--lod', '0')
        before = hashes(out)
        for source in (self.place('zero.osm', b''), self.path('absent.osm')):
            self.assertEqual(blockrand('build', source, '-o', out, '--force', '--lod', '2').code, 2)
            self.assertEqual(hashes(out), before)
            self.assertEqual(stray_siblings(out), [])

    def test_root_and_working_folder(self):
        self.refused(blockrand('build', SAMPLE, '-o', '/', '--force'), 1)
        self.refused(blockrand('build', SAMPLE, '-o', '.', '--force', cwd=self.folder), 1)

    @unittest.skipUnless(os.path.isdir('/proc/self'), 'no /proc')
    def test_place_where_nothing_can_be_written(self):
        run = blockrand('build', SAMPLE, '-o', '/proc/out')
        self.assertIn(run.code, (1, 4), run)
        self.refused(run, run.code)

    def test_output_to_a_link(self):
        """A link to a build stands for the build: the link survives."""
        out = self.build(SAMPLE, 'target', '--lod', '0')
        link = self.path('link')
        os.symlink(out, link)
        self.build(SAMPLE, 'link', '--force', '--lod', '1')
        self.assertTrue(os.path.islink(link))
        self.assertEqual(read_json(out, 'build.json')['configuration']['lod'], 1)


if __name__ == '__main__':
    main()
