"""A hundred hostile inputs and calls: no crash, no hang, a documented exit code, a reason that names its place, nothing lost.

Independent of bad_input_test.py and odd_places_test.py: those say what one case must come to; here every case is held
against the same promises, whatever it comes to. A case is made of bytes by hand, so that no library mends it before.
"""
import gzip
import os
import random
import resource
import shutil
import struct
import zlib

from blockrand_run import BuildTest, blockrand, hashes, main, stray_siblings
from osm_files import METRE, Node, Relation, Way, blob, bytes_field, house, number_field, packed, pbf_bytes, primitive_block, ring, varint, write_xml, zigzag

CPU_SECONDS = 20  # no case is larger than a few houses
HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'


def limited():
    """A run that takes longer is ended by a signal, which is a crash here."""
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))


def xml_text(objects):
    path = '/dev/shm/blockrand-hostile.osm' if os.path.isdir('/dev/shm') else '/tmp/blockrand-hostile.osm'
    path += f'.{os.getpid()}'
    write_xml(path, objects)
    with open(path, encoding='utf-8') as f:
        text = f.read()
    os.remove(path)
    return text


HOUSES = house(1, 11, 51.5, {'building:levels': '3'}) + house(2, 11.001, 51.5, {'roof:shape': 'gabled'}, stretch=1.6)
TEXT = xml_text(HOUSES)


def xml_cases():
    """name: text of an .osm file"""
    deep = '<a>' * 5000 + '</a>' * 5000
    node = '<node id="100010" '
    cases = {
        'entity_bomb': HEAD + '<!DOCTYPE osm [' + ''.join(
            f'<!ENTITY e{i} "{f"&e{i - 1};" * 10 if i else "x" * 100}">' for i in range(10)) + ']><osm version="0.6">&e9;</osm>',
        'external_entity': HEAD + '<!DOCTYPE osm [<!ENTITY x SYSTEM "file:///etc/passwd">]><osm version="0.6"><node id="1" lat="51" '
                           'lon="11" version="1"><tag k="name" v="&x;"/></node></osm>',
        'deep_nesting': HEAD + f'<osm version="0.6">{deep}</osm>',
        'utf16': '\ufeff' + TEXT,
        'latin1_declared': TEXT.replace('UTF-8', 'ISO-8859-1'),
        'unknown_encoding': TEXT.replace('UTF-8', 'EBCDIC-CP-US'),
        'two_roots': TEXT + TEXT.split('\n', 1)[1],
        'text_between': TEXT.replace('<node', 'some text <node', 2),
        'cdata': TEXT.replace('<node', '<![CDATA[<osm>]]><node', 1),
        'comment_bomb': TEXT.replace('<node', '<!--' + 'x' * 2000000 + '--><node', 1),
        'processing_instructions': TEXT.replace('<node', '<?php exit(1); ?><node', 3),
        'namespaces': TEXT.replace('<osm ', '<osm xmlns="http://example.org/osm" xmlns:a="http://example.org/a" a:b="c" '),
        'version_0_5': TEXT.replace('version="0.6"', 'version="0.5"'),
        'version_absent': TEXT.replace(' version="0.6"', '', 1),
        'version_words': TEXT.replace('version="0.6"', 'version="newest"'),
        'object_in_object': TEXT.replace('<nd ', '<node id="7" lat="1" lon="1" version="1"/><nd ', 1),
        'id_zero': TEXT.replace('id="100010"', 'id="0"').replace('ref="100010"', 'ref="0"'),
        'id_empty': TEXT.replace(node, '<node id="" '),
        'id_words': TEXT.replace(node, '<node id="first" '),
        'id_twenty_digits': TEXT.replace('100010"', '99999999999999999999"'),
        'id_missing': TEXT.replace(node, '<node '),
        'ref_missing': TEXT.replace('<nd ref="100010"/>', '<nd/>', 1),
        'latitude_nan': TEXT.replace('lat="51.5000000"', 'lat="nan"', 1),
        'latitude_words': TEXT.replace('lat="51.5000000"', 'lat="north"', 1),
        'latitude_exponent': TEXT.replace('lat="51.5000000"', 'lat="5.15e1"', 1),
        'latitude_huge': TEXT.replace('lat="51.5000000"', 'lat="1e300"', 1),
        'latitude_40_digits': TEXT.replace('lat="51.5000000"', 'lat="51.' + '5' * 40 + '"', 1),
        'latitude_comma': TEXT.replace('lat="51.5000000"', 'lat="51,5"', 1),
        'latitude_missing': TEXT.replace('lat="51.5000000" ', '', 1),
        'timestamp_future': TEXT.replace('2024-05-01', '9999-12-31'),
        'timestamp_words': TEXT.replace('2024-05-01T00:00:00Z', 'yesterday'),
        'timestamp_month_13': TEXT.replace('2024-05-01', '2024-13-41'),
        'version_of_object_negative': TEXT.replace('" version="1"', '" version="-1"'),
        'key_twice': TEXT.replace('<tag k="building"', '<tag k="building" v="no"/><tag k="building"', 1),
        'key_empty': TEXT.replace('k="building:levels"', 'k=""'),
        'value_of_a_megabyte': TEXT.replace('v="gabled"', 'v="' + 'g' * 1000000 + '"'),
        'ten_thousand_tags': TEXT.replace('<tag k="roof:shape"', ''.join(f'<tag k="k{i}" v="v"/>' for i in range(10000)) + '<tag k="roof:shape"'),
        'bounds_upside_down': TEXT.replace('<node', '<bounds minlat="52" minlon="12" maxlat="51" maxlon="11"/><node', 1),
        'bounds_words': TEXT.replace('<node', '<bounds minlat="a" minlon="b" maxlat="c" maxlon="d"/><node', 1),
        'member_of_itself': xml_text(HOUSES + [Relation(5, [('relation', 5, 'outer')] * 3, {'type': 'building'})]),
        'members_in_a_circle': xml_text(HOUSES + [Relation(i, [('relation', (i + 1) % 50, 'outline')], {'type': 'building'})
                                                  for i in range(50)]),
        'member_ten_thousand_times': xml_text(HOUSES + [Relation(5, [('way', 1001, 'outer')] * 10000,
                                                                 {'type': 'multipolygon', 'building': 'yes'})]),
        'all_roles_unknown': xml_text(HOUSES + [Relation(5, [('way', 1001, 'xyzzy'), ('way', 1002, '')],
                                                         {'type': 'multipolygon', 'building': 'yes'})]),
        'way_over_one_node': xml_text(HOUSES + [Way(9, [100010] * 2000, {'building': 'yes'})]),
        'way_forth_and_back': xml_text(HOUSES + [Way(9, [100010, 100011, 100012] * 600 + [100010], {'building': 'yes'})]),
        'scribble': xml_text(ring(1, 9, scribble(1900, 150), {'building': 'yes', 'building:levels': '5'})),
        'thousand_courts': xml_text(courts(400)),
        'comb': xml_text(ring(1, 9, comb(900), {'building': 'yes', 'roof:shape': 'hipped'})),
        'needle': xml_text(ring(1, 9, [(11, 51.5), (11.05, 51.5), (11.05, 51.5000001)], {'building': 'yes', 'height': '300'})),
        'tower_of_2000_m': xml_text(house(1, 11, 51.5, {'height': '2000', 'building:levels': '900', 'roof:shape': 'onion'})),
        'parts_nested_50_deep': xml_text([o for i in range(50) for o in house(
            i, 11 + i * 0.1 * METRE, 51.5 + i * 0.1 * METRE, {'building:part': 'yes', 'building': 'no', 'height': str(i + 3)}, size=12 - i * 0.2)]),
        'same_place_200_times': xml_text([o for i in range(200) for o in house(i, 11, 51.5, {'height': '9'})]),
        'colours': xml_text([o for i, c in enumerate(('#', '#12', '#ggg', 'rgb(300,0,0)', '\u202e', '#' + '0' * 1000, 'no colour')) for o in
                             house(i, 11 + i * 0.0005, 51.5, {'building:colour': c, 'roof:colour': c, 'building:material': c})]),
        'dates': xml_text([o for i, d in enumerate(('0', '-1', '99999', 'C19', '~', '1900..1800', '9' * 400)) for o in
                           house(i, 11 + i * 0.0005, 51.5, {'start_date': d})]),
    }
    return {name: text.encode('utf-16' if name == 'utf16' else 'utf-8', 'surrogatepass') for name, text in cases.items()}


def scribble(n, size):
    draw = random.Random(3)
    return [(11 + draw.random() * size * METRE * 1.6, 51.5 + draw.random() * size * METRE) for _ in range(n)]


def comb(teeth):
    points = []
    for i in range(teeth):
        x = 11 + i * 0.4 * METRE
        points += [(x, 51.5), (x + 0.2 * METRE, 51.5 + 30 * METRE)]
    return points + [(11 + teeth * 0.4 * METRE, 51.5 - 10 * METRE), (11, 51.5 - 10 * METRE)]


def courts(n):
    side, pitch = 20, 14 * METRE
    size = side * pitch

    def square(first, way, x, y, d):
        return ring(first, way, [(11 + a * 1.6, 51.5 + b) for a, b in ((x, y), (x + d, y), (x + d, y + d), (x, y + d))], {})
    objects, members = square(1, 1, 0, 0, size), [('way', 1, 'outer')]
    for i in range(n):
        objects += square(100 + 10 * i, 10 + i, (i % side) * pitch + 4 * METRE, (i // side) * pitch + 4 * METRE, 6 * METRE)
        members.append(('way', 10 + i, 'inner'))
    return objects + [Relation(1, members, {'type': 'multipolygon', 'building': 'yes'})]


def pbf_cases():
    """name: bytes of an .osm.pbf file"""
    header, *blocks = pbf_bytes(HOUSES)
    block = primitive_block(HOUSES)

    def with_header(*fields):
        return blob(b'OSMHeader', b''.join(fields)) + b''.join(blocks)

    def zipped(raw_size, data):
        body = number_field(2, raw_size) + bytes_field(3, data)
        head = bytes_field(1, b'OSMData') + number_field(3, len(body))
        return header + struct.pack('>I', len(head)) + head + body
    schema = bytes_field(4, b'OsmSchema-V0.6')
    return {
        'unknown_feature_required': with_header(schema, bytes_field(4, b'Teleportation')),
        'no_feature_required': with_header(bytes_field(16, b'x')),
        'two_headers': header + header + b''.join(blocks),
        'header_last': b''.join(blocks) + header,
        'unknown_blob_kind': header + blob(b'OSMJoke', block) + b''.join(blocks),
        'uncompressed': header + blob(b'OSMData', block, compress=False),
        'raw_size_too_small': zipped(10, zlib.compress(block)),
        'raw_size_too_large': zipped(len(block) + 1000, zlib.compress(block)),
        'raw_size_beyond_32_mib': zipped(1 << 31, zlib.compress(block)),
        'zip_bomb': zipped(32 << 20, zlib.compress(bytes(32 << 20), 9)),
        'head_size_of_4_gib': header + b'\xff\xff\xff\xff' + b''.join(blocks),
        'blob_of_other_compression': header + struct.pack('>I', 13) + bytes_field(1, b'OSMData') + number_field(3, 6)
                                     + bytes_field(4, b'lzma'),
        'string_index_beyond_the_table': header + blob(b'OSMData', bytes_field(1, bytes_field(1, b'')) + bytes_field(2, bytes_field(
            3, number_field(1, 9) + packed(2, [varint(77)]) + packed(3, [varint(88)])))),
        'keys_without_values': header + blob(b'OSMData', bytes_field(1, bytes_field(1, b'') + bytes_field(1, b'building')) + bytes_field(
            2, bytes_field(3, number_field(1, 9) + packed(2, [varint(1)])))),
        'varint_without_end': header + blob(b'OSMData', b'\x08' + b'\xff' * 20),
        'length_beyond_the_block': header + blob(b'OSMData', b'\x12\xff\xff\xff\x7f'),
        'group_of_all_kinds': header + blob(b'OSMData', bytes_field(1, bytes_field(1, b'')) + bytes_field(
            2, bytes_field(1, number_field(1, 2)) + bytes_field(3, number_field(1, 3)) + bytes_field(4, number_field(1, 4)))),
        'offset_of_latitude': header + blob(b'OSMData', block + varint(19 << 3) + zigzag(1 << 62)),
        'granularity_huge': header + blob(b'OSMData', block + number_field(17, 2147483647)),
        'granularity_negative': header + blob(b'OSMData', block + varint(17 << 3) + varint(-100)),
        'trailing_zeroes': header + b''.join(blocks) + bytes(1000),
        'ids_around_the_range': b''.join(pbf_bytes([Node((1 << 63) - 1 - i, 11 + i * 1e-4, 51.5) for i in range(4)]
                                                   + [Way((1 << 63) - 1, [(1 << 63) - 1 - i for i in (0, 1, 2, 3, 0)], {'building': 'yes'})])),
    }


def toml_cases():
    """(option, name): text. Files that settings, overrides and rule sets are read from."""
    deep = '[' * 2000 + ']' * 2000
    broken = {'deep_array': f'a = {deep}\n', 'nul': 'lod = 2\0\n', 'cr_only': 'lod = 2\rseed = 3\r', 'no_value': 'lod =\n',
              'table_twice': '[a]\nb = 1\n[a]\nb = 2\n', 'long_line': 'x = "' + 'y' * 500000 + '"\n', 'bom': '\ufefflod = 1\n',
              'number_without_end': 'seed = ' + '9' * 5000 + '\n', 'infinity': 'seed = inf\n', 'date': 'lod = 2024-01-01\n',
              'array': 'lod = [2]\n', 'table': '[lod]\nx = 1\n', 'truth': 'lod = true\n', 'negative_zero': 'lod = -0\n'}
    cases = {('--config', name): text for name, text in broken.items()}
    overrides = {'unknown_id': '[w99999999999]\nheight = 9\n', 'id_of_words': '[house]\nheight = 9\n', 'height_nan': '[w1001]\nheight = nan\n',
                 'height_words': '[w1001]\nheight = "tall"\n', 'height_minus': '[w1001]\nheight = -3\n',
                 'storeys_fraction': '["w1001"]\nstoreys = 2.5\n', 'storeys_million': '[w1001]\nstoreys = 1000000\n',
                 'shape_unknown': '[w1001]\nroof_shape = "spaghetti"\n', 'key_unknown': '[w1001]\nheigth = 9\n',
                 'preset_unknown': '[w1001]\npreset = "gruenderzeitt"\n', 'not_a_table': 'w1001 = 3\n', 'deep': f'[w1001]\nheight = {deep}\n',
                 'empty_key': '[w1001]\n"" = 3\n'}
    cases |= {('--overrides', name): text for name, text in overrides.items()}
    rule = 'title = "t"\n[[rule]]\nname = "r"\nlevel = "building"\npreset = "plain"\n'
    rules = {'polygon_of_two': 'polygon = [[11, 51], [12, 52]]\n' + rule, 'polygon_nan': 'polygon = [[nan, 51], [12, 52], [12, 51]]\n' + rule,
             'polygon_words': 'polygon = "everywhere"\n' + rule, 'polygon_bow_tie': 'polygon = [[10, 50], [12, 52], [12, 50], [10, 52]]\n' + rule,
             'level_unknown': rule.replace('"building"', '"galaxy"'), 'priority_words': rule + 'priority = "first"\n',
             'priority_huge': rule + 'priority = 99999999999999\n', 'range_backwards': rule + 'which.area = [40, 10]\n',
             'range_of_three': rule + 'which.area = [1, 2, 3]\n', 'which_unknown': rule + 'which.moon = "full"\n',
             'rule_is_no_list': 'title = "t"\nrule = 3\n', 'names_twice': rule + rule.split('\n', 1)[1], 'no_rules': 'title = "t"\n'}
    return cases | {('--districts', name): text for name, text in rules.items()}


def grammar_cases():
    """name: text of a rule file for `grammar check`"""
    head = 'version "2025.1"\n'
    return {'empty': '', 'binary': '\x01\x02\x7f' * 50, 'no_version': 'Lot --> NIL\n', 'endless_recursion': head + 'Lot --> Lot\n',
            'function_calls_itself': head + 'f(x) = f(x)\nLot --> extrude(f(1))\n', 'deep_brackets': head + 'const a = ' + '(' * 3000 + '1' + ')' * 3000 + '\nLot --> NIL\n',
            'deep_blocks': head + 'Lot --> ' + 'split(x){ 1 : ' * 1500 + 'NIL' + ' }' * 1500 + '\n', 'open_string': head + 'const a = "never\nLot --> NIL\n',
            'open_comment': head + '/* never\nLot --> NIL\n', 'import_of_itself': head + 'import a : "import_of_itself.cga"\nLot --> NIL\n',
            'import_of_nothing': head + 'import a : "nobody.cga"\nLot --> NIL\n', 'shares_beyond_1': head + 'Lot --> 70% : NIL 60% : NIL else : NIL\n',
            'constants_in_a_circle': head + 'const a = b\nconst b = a\nLot --> extrude(a)\n', 'long_name': head + 'R' * 200000 + ' --> NIL\n',
            'long_number': head + 'const a = ' + '9' * 5000 + '\nLot --> NIL\n', 'attr_twice': head + 'attr a = 1\nattr a = 2\nLot --> NIL\n'}


def raster_cases():
    """name: (file name, bytes)"""
    grid = 'ncols 3\nnrows 3\nxllcorner 638000\nyllcorner 5706000\ncellsize 500\nNODATA_value -9999\n1 2 3\n4 5 6\n7 8 9\n'
    return {'no_crs': ('a.asc', grid), 'cells_missing': ('b.asc', grid[:-12]), 'no_columns': ('c.asc', grid.replace('ncols 3', 'ncols 0')),
            'columns_beyond_memory': ('d.asc', grid.replace('ncols 3', 'ncols 2000000000').replace('nrows 3', 'nrows 2000000000')),
            'cell_of_nothing': ('e.asc', grid.replace('cellsize 500', 'cellsize 0')), 'cell_nan': ('f.asc', grid.replace('cellsize 500', 'cellsize nan')),
            'values_words': ('g.asc', grid.replace('4 5 6', 'x y z')), 'tiff_head_alone': ('h.tif', b'II*\0\x08\0\0\0'),
            'tiff_directory_in_a_circle': ('i.tif', b'II*\0\x08\0\0\0\0\0\x08\0\0\0'), 'png_head_alone': ('j.png', b'\x89PNG\r\n\x1a\n'),
            'vrt_of_itself': ('k.vrt', '<VRTDataset rasterXSize="3" rasterYSize="3"><VRTRasterBand dataType="Float32" band="1"><SimpleSource>'
                              '<SourceFilename relativeToVRT="1">k.vrt</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>')}


OPTIONS = [('--formats', ''), ('--formats', 'gltf,,citygml'), ('--formats', 'gltf,gltf'), ('--bbox', '11,51,10,50'),
           ('--bbox', 'nan,nan,nan,nan'), ('--bbox', '11,51,12'), ('--bbox', '170,-90,-170,90'), ('--tile', '15/0/0'),
           ('--pinned', 'nobody.json'), ('--tile', '99/1/1', '--pinned', 'nobody.json'), ('--crs', 'EPSG:4326'), ('--crs', 'EPSG:-1'),
           ('--crs', 'PROJ4:+proj=robin'), ('--seed', '-1'), ('--seed', '18446744073709551616'), ('--jobs', '100000'), ('--jobs', '-3'),
           ('--ground-height', '1e300'), ('--ground-height', 'nan'), ('--terrain-height-reference', 'EPSG:4326'),
           ('--districts', ''), ('--overrides', '/dev/null'), ('--config', '/dev/null'), ('--configs', '/dev/null'), ('--configs', '/'),
           ('--allow-shrink', '101'), ('--allow-shrink', '-1'), ('--compress', 'zip'), ('--instancing', ''), ('--lod', '+2'),
           ('--lod', '2.0'), ('--lod', '٢'), ('--progress', 'loud'), ('--log-format', 'xml')]


class Hostile(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.cases = 0
        with open(os.path.join(cls.folder, 'fine.osm'), 'w', encoding='utf-8') as f:
            f.write(TEXT)

    def setUp(self):
        self.good = self.path('good')
        if not os.path.exists(self.good):
            run = blockrand('build', self.path('fine.osm'), '-o', self.good, '--lod', '1', '--formats', 'gltf', '--no-report', '--progress', 'none')
            self.assertEqual(run.code, 0, run)
            shutil.copytree(self.good, self.path('kept'))
        type(self).before = hashes(self.path('kept'))

    def survives(self, *arguments, word, codes=(0, 1, 2)):
        """Runs into the folder of a good build, and holds the outcome against the promises; returns the exit code"""
        type(self).cases += 1
        run = blockrand(*arguments, preexec=limited, timeout=300)
        self.assertGreaterEqual(run.code, 0, f'ended by a signal\n{run}')
        self.assertIn(run.code, codes, run)
        self.assertEqual(stray_siblings(self.good), [], run)
        if run.code != 0:
            self.assertIn(word.lower(), run.err.lower(), f'the place is not named\n{run}')
            self.assertGreater(len(run.err.strip()), 20, run)
            self.assertNotIn('terminate called', run.err)
            self.assertEqual(hashes(self.good), self.before, f'the earlier build is not as it was\n{run}')
        elif arguments[0] == 'build':
            shutil.rmtree(self.good)
            shutil.copytree(self.path('kept'), self.good)
        return run.code

    def build_into_good(self, source, *options, word, codes=(0, 1, 2)):
        return self.survives('build', source, '-o', self.good, '--force', '--allow-shrink', '100', '--allow-empty', '--progress', 'none',
                             '--no-report', *options, word=word, codes=codes)

    def test_xml(self):
        for name, data in xml_cases().items():
            with self.subTest(name):
                source = self.place(f'{name}.osm', data)
                self.build_into_good(source, '--lod', '3', '--formats', 'gltf,cityjson', word=f'{name}.osm', codes=(0, 2))

    def test_pbf(self):
        for name, data in pbf_cases().items():
            with self.subTest(name):
                source = self.place(f'{name}.osm.pbf', data)
                self.build_into_good(source, '--lod', '1', '--formats', 'gltf', word=f'{name}.osm.pbf', codes=(0, 2))

    def test_archives_in_archives(self):
        once = gzip.compress(TEXT.encode())
        for name, data in (('twice', gzip.compress(once)), ('two_members', once + once), ('trailing', once + b'tail' * 100),
                           ('bomb', gzip.compress(b' ' * (200 << 20), 9))):
            with self.subTest(name):
                source = self.place(f'{name}.osm.gz', data)
                self.build_into_good(source, '--lod', '1', '--formats', 'gltf', word=f'{name}.osm.gz', codes=(0, 2))

    def test_settings_overrides_and_rules(self):
        for (option, name), text in toml_cases().items():
            with self.subTest(option=option, name=name):
                file = self.place(f'{name}.toml', text)
                self.build_into_good(self.path('fine.osm'), '--formats', 'gltf', option, file, word=f'{name}.toml')

    def test_grammars(self):
        for name, text in grammar_cases().items():
            with self.subTest(name):
                self.survives('grammar', 'check', self.place(f'{name}.cga', text), word=f'{name}.cga')

    def test_rasters(self):
        for name, (file, data) in raster_cases().items():
            with self.subTest(name):
                terrain = self.place(file, data)
                self.build_into_good(self.path('fine.osm'), '--lod', '1', '--formats', 'gltf', '--terrain', terrain,
                                     '--terrain-height-reference', 'ellipsoid', word=file)

    def test_options(self):
        for options in OPTIONS:
            with self.subTest(' '.join(options)):
                # A message names the option, or what was given for it.
                self.build_into_good(self.path('fine.osm'), *options, word=options[0].lstrip('-').split('-')[0][:5])

    @classmethod
    def tearDownClass(cls):
        print(f'{cls.cases} hostile cases')
        super().tearDownClass()


if __name__ == '__main__':
    main()
