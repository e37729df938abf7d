"""`blockrand validate` finds each kind of planted damage by what it is, and nothing in sound outputs.

Every damage is sealed again (hashes and list of files in build.json are those of the damaged files), but for those that
are about hashes and lists.
"""
import json
import math
import os
import re
import shutil
import sqlite3
import struct
import unittest

from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, extract, files_of, main, read_json
from damage import Damaged, accessor, column_start, first_leaf, index_format, primitive_of, table_of

EMPTY = '<osm version="0.6"><node id="1" lat="51.47" lon="11.03"/></osm>'


class Validated(BuildTest):
    def validate(self, folder, *options):
        run = blockrand('validate', folder, '--json', '--progress', 'none', *options, timeout=3600)
        self.assertIn(run.code, (0, 2), run)
        self.assertEqual(run.err, '', run)
        result = json.loads(run.out)
        self.assertEqual(run.code, 0 if result['sound'] else 2)
        self.assertEqual(result['sound'], not result['findings'])
        return result

    def sound(self, folder, *options):
        result = self.validate(folder, *options)
        said = '\n'.join(f"{f['code']} {f['file']} {f['object']}: {f['detail']}" for f in result['findings'][:30])
        self.assertTrue(result['sound'], said)
        return result


class AllAttributes(Validated):
    """The property tables of --attributes all."""
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'out', '--formats', 'gltf,gpkg', '--attributes', 'all', '--single-glb', '--no-report')

    def damage(self, change, *codes):
        d = Damaged(self.out, self.path('damaged'))
        d.change_glb(change)
        d.seal()
        found = {f['code'] for f in self.validate(d.folder)['findings']}
        shutil.rmtree(d.folder)
        self.assertEqual(found, set(codes))

    def test_it_is_sound(self):
        self.sound(self.out)

    def test_damages_are_found(self):
        def enum(j, b):
            b[column_start(j, 'height_source')] = 99

        def height(j, b):
            at = column_start(j, 'height')
            struct.pack_into('<d', b, at, struct.unpack_from('<d', b, at)[0] + 0.001)
        for change, codes in ((enum, 'METADATA_RULE SOURCE_WRONG ATTRIBUTE_DIFFERS COUNTS_DIFFER'),
                              (height, 'ATTRIBUTE_DIFFERS EXPLANATION_WRONG')):
            with self.subTest(change.__name__):
                self.damage(change, *codes.split())


class Damages(Validated):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'out', '--formats', 'gltf,citygml,cityjson,gpkg')
        cls.number = 0

    def damaged(self):
        type(self).number += 1
        return Damaged(self.out, self.path(f'damaged{self.number}'))

    def found(self, damage, codes, *words, options=(), seal=True):
        """Exactly these codes, and for each word a finding that has it in file, object or detail."""
        if seal:
            damage.seal()
        result = self.validate(damage.folder, *options)
        said = [f"{f['code']} {f['file']} {f['object']}: {f['detail']}" for f in result['findings']]
        shown = '\n'.join(said[:30])
        self.assertEqual(sorted({f['code'] for f in result['findings']}), sorted(codes.split()), shown)
        for word in words:
            self.assertTrue(any(word in line for line in said), f'{word} is named by none of\n{shown}')
        shutil.rmtree(damage.folder)
        return result

    # ---- files and build.json

    def test_a_wrong_hash(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['files'][d.gml].update(sha256='0' * 64))
        self.found(d, 'FILE_CHANGED', d.gml, seal=False)

    def test_a_flipped_byte(self):
        d = self.damaged()
        d.change('tileset.json', lambda t: t[:-1] + b' ')
        self.found(d, 'FILE_CHANGED', 'tileset.json', seal=False)

    def test_a_truncated_citygml_file(self):
        d = self.damaged()
        d.change(d.gml, lambda t: t[:len(t) // 2])
        self.found(d, 'FILE_UNREADABLE', d.gml)

    def test_a_truncated_glb(self):
        d = self.damaged()
        d.change(d.glb, lambda t: t[:len(t) // 2])
        self.found(d, 'FILE_UNREADABLE', d.glb)

    def test_a_truncated_cityjson_file(self):
        d = self.damaged()
        d.change(d.cityjson, lambda t: t[:len(t) // 2])
        result = self.validate_sealed(d)
        self.assertTrue({f['code'] for f in result['findings']} & {'FILE_UNREADABLE', 'CITYJSON_RULE'}, result['findings'][:5])

    def validate_sealed(self, d):
        d.seal()
        return self.validate(d.folder)

    def test_a_missing_file(self):
        d = self.damaged()
        name = d.gml
        d.remove(name)
        self.found(d, 'FILE_MISSING', name, seal=False)

    def test_an_unlisted_file(self):
        d = self.damaged()
        d.write('citygml/old.gml', b'<x/>')
        self.found(d, 'FILE_UNLISTED', 'citygml/old.gml', seal=False)

    def test_damaged_gzip(self):
        d = self.damaged()
        d.change(d.explained, lambda t: t[:len(t) // 2] + b'\0\0\0\0' + t[len(t) // 2 + 4:])
        self.found(d, 'FILE_UNREADABLE', d.explained)

    def test_a_field_that_is_missing(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['counts'].pop('models'))
        self.found(d, 'BUILD_JSON REPORT_WRONG', 'counts.models')

    def test_counts_that_do_not_add_up(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['counts'].update(buildings_in=b['counts']['buildings_in'] + 1))
        self.found(d, 'BUILD_JSON REPORT_WRONG', 'counts')

    def test_a_count_that_no_file_confirms(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['counts'].update(solids_lod2=b['counts']['solids_lod2'] - 1))
        self.found(d, 'COUNTS_DIFFER', 'counts.solids_lod2')

    def test_wrong_statistics(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['statistics']['roofs'].update(gabled=1))
        self.found(d, 'COUNTS_DIFFER', 'statistics.roofs.gabled')

    def test_a_format_that_was_not_asked_for(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['configuration']['formats'].remove('citygml'))
        self.found(d, 'BUILD_JSON', 'citygml/')

    def test_a_pipeline_to_elsewhere(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['crs'].update(pipeline=b['crs']['pipeline'].replace('zone=32', 'zone=33')))
        self.found(d, 'BUILD_JSON GEOMETRY_DIFFERS POSITION', 'crs.pipeline')

    # ---- tileset

    def test_an_error_that_grows(self):
        d = self.damaged()
        d.json('tileset.json', lambda t: t['root']['children'][0].update(geometricError=1e9))
        self.found(d, 'TILESET_RULE', 'above the parent')

    def test_a_wrong_version(self):
        d = self.damaged()
        d.json('tileset.json', lambda t: t['asset'].update(version='1.0'))
        self.found(d, 'TILESET_RULE', 'tileset.json')

    def test_a_box_that_is_too_small(self):
        d = self.damaged()

        def shrink(t):
            first_leaf(t)['boundingVolume']['box'][3] *= 0.9
        d.json('tileset.json', shrink)
        self.found(d, 'TILE_BOUNDS', d.glb)

    def test_a_region_that_is_too_small(self):
        d = self.damaged()

        def lower(t):
            region = t['root']['boundingVolume']['region']
            region[5] = (region[4] + region[5]) / 2
        d.json('tileset.json', lower)
        self.found(d, 'TILE_BOUNDS', 'ancestor')

    def test_a_wrong_transform(self):
        d = self.damaged()

        def move(t):
            first_leaf(t)['transform'][13] += 0.5
        d.json('tileset.json', move)
        self.found(d, 'TILESET_RULE GEOREFERENCE GEOMETRY_DIFFERS POSITION', d.glb, 'all ')

    def test_a_scaled_transform(self):
        d = self.damaged()

        def scale(t):
            m = first_leaf(t)['transform']
            for i in (0, 1, 2):
                m[i] *= 1.001
        d.json('tileset.json', scale)
        self.found(d, 'TILESET_RULE GEOREFERENCE GEOMETRY_DIFFERS POSITION', 'rigid')

    def test_a_tile_that_is_missing(self):
        d = self.damaged()
        name = d.glb
        d.remove(name)
        self.found(d, 'TILE_MISSING OBJECT_MISSING EXPLANATION_WRONG', name)

    def test_a_tile_in_no_tileset(self):
        d = self.damaged()

        def drop(t):
            def walk(tile):
                tile['children'] = [c for c in tile.get('children', []) if c.get('content', {}).get('uri') != d.glb]
                for child in tile['children']:
                    walk(child)
                if not tile['children']:
                    del tile['children']
            walk(t['root'])
        d.json('tileset.json', drop)
        self.found(d, 'TILE_MISSING', d.glb)

    def test_a_tile_used_twice(self):
        d = self.damaged()

        def double(t):
            t['root']['children'].append(json.loads(json.dumps(first_leaf(t))))
        d.json('tileset.json', double)
        self.found(d, 'TILESET_RULE', 'used twice')

    # ---- GLB

    def test_a_shifted_origin(self):
        d = self.damaged()
        d.change_glb(lambda j, b: j['asset']['extras']['georeference']['origin'].update(longitude=11.0))
        self.found(d, 'GEOREFERENCE', d.glb)

    def found_in_glb(self, change, codes, *words):
        d = self.damaged()
        word = d.change_glb(change)
        self.found(d, codes, d.glb, *words, *([word] if word else []))

    def test_an_origin_elsewhere(self):
        def change(j, _):
            origin = j['asset']['extras']['georeference']['origin']
            origin['latitude'] = round(origin['latitude'], 3)
        self.found_in_glb(change, 'GEOREFERENCE')

    def test_another_crs(self):
        self.found_in_glb(lambda j, b: j['asset']['extras']['georeference'].update(crs='EPSG:25833'), 'GEOREFERENCE', 'EPSG:25833')

    def test_a_position_that_is_no_number(self):
        def change(j, b):
            a, start, _ = accessor(j, primitive_of(j), 'POSITION')
            self.assertEqual(a['componentType'], 5126)
            struct.pack_into('<f', b, start, math.nan)
        self.found_in_glb(change, 'GLB_RULE SOLID_INVALID GEOMETRY_DIFFERS', 'no finite number')

    def test_an_index_beyond_the_vertices(self):
        def change(j, b):
            _, start, _ = accessor(j, primitive_of(j), 'indices')
            struct.pack_into(index_format(j), b, start, 65000)
        self.found_in_glb(change, 'GLB_RULE SOLID_INVALID GEOMETRY_DIFFERS', '65000')

    def test_wrong_bounds(self):
        def change(j, _):
            a = accessor(j, primitive_of(j), 'POSITION')[0]
            a['max'][0] = 1
        self.found_in_glb(change, 'GLB_RULE', 'min and max')

    def test_a_normal_of_wrong_length(self):
        def change(j, b):
            _, start, _ = accessor(j, primitive_of(j), 'NORMAL')
            struct.pack_into('<bbb', b, start, 60, 0, 0)
        self.found_in_glb(change, 'GLB_RULE', 'length 0.47')

    def test_a_moved_vertex(self):
        def change(j, b):
            a, start, stride = accessor(j, primitive_of(j), 'POSITION')
            # A corner inside of the bounds, moved by 5 cm.
            for i in range(a['count']):
                x, y, z = struct.unpack_from('<fff', b, start + i * stride)
                if all(low + 1 < v < high - 1 for v, low, high in zip((x, y, z), a['min'], a['max'])):
                    struct.pack_into('<f', b, start + i * stride, x + 0.05)
                    return
            self.fail('every corner is at the bounds')
        self.found_in_glb(change, 'SOLID_INVALID GEOMETRY_DIFFERS', '0.05')

    def test_a_flipped_triangle(self):
        def change(j, b):
            _, start, _ = accessor(j, primitive_of(j), 'indices')
            f = index_format(j)
            size = struct.calcsize(f)
            one, two = (struct.unpack_from(f, b, start + k * size)[0] for k in (0, 1))
            struct.pack_into(f, b, start, two)
            struct.pack_into(f, b, start + size, one)
        self.found_in_glb(change, 'GLB_RULE SOLID_INVALID', 'does not look')

    def test_a_triangle_without_area(self):
        def change(j, b):
            _, start, _ = accessor(j, primitive_of(j), 'indices')
            f = index_format(j)
            struct.pack_into(f, b, start + struct.calcsize(f), struct.unpack_from(f, b, start)[0])
        self.found_in_glb(change, 'GLB_RULE SOLID_INVALID GEOMETRY_DIFFERS', 'no area')

    def test_a_colour_of_one_format(self):
        def change(j, b):
            coloured = next(p for p in j['meshes'][0]['primitives'] if 'COLOR_0' in p['attributes'])
            a, start, stride = accessor(j, coloured, 'COLOR_0')
            feature, at, step = accessor(j, coloured, '_FEATURE_ID_0')
            first = struct.unpack_from('<H', b, at)[0]
            for i in range(a['count']):
                if struct.unpack_from('<H', b, at + i * step)[0] == first:
                    struct.pack_into('<HHH', b, start + i * stride, 65535, 0, 0)
        self.found_in_glb(change, 'COLOUR_DIFFERS', 'm2')

    def test_a_colour_of_a_material(self):
        def change(j, _):
            plain = next(p for p in j['meshes'][0]['primitives'] if 'COLOR_0' not in p['attributes'])
            j['materials'][plain['material']]['pbrMetallicRoughness']['baseColorFactor'] = [1, 0, 0, 1]
        self.found_in_glb(change, 'COLOUR_DIFFERS', 'm2')

    def test_a_property_table_of_wrong_length(self):
        def change(j, _):
            table_of(j)['count'] -= 1
        self.found_in_glb(change, 'METADATA_RULE OBJECT_MISSING COUNTS_DIFFER', 'rows')

    def test_a_feature_beyond_the_table(self):
        def change(j, b):
            _, start, _ = accessor(j, primitive_of(j), '_FEATURE_ID_0')
            struct.pack_into('<H', b, start, 60000)
        self.found_in_glb(change, 'METADATA_RULE SOLID_INVALID GEOMETRY_DIFFERS', '60000')

    def test_an_enum_value_that_does_not_exist(self):
        def change(j, b):
            b[column_start(j, 'built_roof')] = 99
        self.found_in_glb(change, 'METADATA_RULE ATTRIBUTE_DIFFERS', 'not in the enum')

    def test_an_attribute_of_one_format(self):
        for off in (0.25, 0.1):
            def change(j, b):
                at = column_start(j, 'height')
                struct.pack_into('<d', b, at, struct.unpack_from('<d', b, at)[0] + off)
            self.found_in_glb(change, 'ATTRIBUTE_DIFFERS', 'height')

    def test_a_source_of_one_format(self):
        def change(j, b):
            start = column_start(j, 'sources')
            at = b.index(b'tag: ', start)
            b[at:at + 3] = b'tax'
        self.found_in_glb(change, 'SOURCE_WRONG ATTRIBUTE_DIFFERS', 'from "tax"')

    def test_sources_that_cannot_be_read(self):
        def change(j, b):
            start = column_start(j, 'sources')
            at = b.index(b'tag: ', start)
            b[at:at + 5] = b'tag, '
        self.found_in_glb(change, 'METADATA_RULE SOURCE_WRONG ATTRIBUTE_DIFFERS', 'is no source with its columns')

    def test_another_profile_than_asked(self):
        d = self.damaged()
        build = read_json(d.folder, 'build.json')
        self.assertEqual(build['configuration']['attributes'], 'people')
        build['configuration']['attributes'] = 'all'
        with open(d.path('build.json'), 'w', encoding='utf-8') as f:
            json.dump(build, f)
        self.assertIn('METADATA_RULE', {f['code'] for f in self.validate_sealed(d)['findings']})

    def test_two_rows_with_one_id(self):
        def change(j, b):
            text, offsets = column_start(j, 'id'), column_start(j, 'id', 'stringOffsets')
            bounds = struct.unpack_from('<200H', b, offsets)
            pairs = [(i, k) for i in range(20) for k in range(i + 1, 20)
                     if bounds[i + 1] - bounds[i] == bounds[k + 1] - bounds[k]]
            i, k = pairs[0]
            b[text + bounds[k]:text + bounds[k + 1]] = b[text + bounds[i]:text + bounds[i + 1]]
            return bytes(b[text + bounds[i]:text + bounds[i + 1]]).decode()
        self.found_in_glb(change, 'METADATA_RULE OBJECT_DOUBLED OBJECT_MISSING COUNTS_DIFFER')

    def test_an_extension_that_is_not_declared(self):
        def change(j, _):
            j['extensionsUsed'].remove('EXT_mesh_features')
        self.found_in_glb(change, 'GLB_RULE', 'EXT_mesh_features')

    # ---- CityGML

    def test_a_flipped_face(self):
        d = self.damaged()
        result = self.found(d, 'SOLID_INVALID GEOMETRY_DIFFERS', d.ring(lambda r: r[::-1]), '307 polygon wrong orientation')
        self.assertIn(307, [f.get('number') for f in result['findings']])

    def test_a_moved_corner(self):
        d = self.damaged()

        def move(ring):
            ring[0][2] -= 0.5
            ring[-1][2] -= 0.5
            return ring
        self.found(d, 'SOLID_INVALID GEOMETRY_DIFFERS', d.ring(move), '203 not planar')

    def test_a_corner_off_the_grid(self):
        d = self.damaged()

        def nudge(ring):
            ring[0][2] -= 0.0004
            ring[-1][2] -= 0.0004
            return ring
        self.found(d, 'OFF_GRID', d.ring(nudge))

    def test_a_moved_building(self):
        """One building, an eighth of a metre to the west: still a sound solid, and still in the envelope."""
        d = self.damaged()

        def move(text):
            def shift(found):
                n = found.group(2).split()
                return found.group(1) + ' '.join(f'{float(v) - 0.125:.4f}' if i % 3 == 0 else v for i, v in enumerate(n))
            return re.sub(r'(<posList>)([^<]*)', shift, text)
        west = float(re.search(r'<lowerCorner>([0-9.]*)', d.read(d.gml).decode()).group(1))
        building = d.building(move, lambda text: all(float(x) > west + 1 for x in re.findall(r'<posList>([0-9.]*)', text))
                              and 'gml:id="w1020"' in text)
        self.found(d, 'GEOMETRY_DIFFERS POSITION', building)

    def test_swapped_axes(self):
        d = self.damaged()

        def swap(data):
            def turn(found):
                n = found.group(2).split()
                return found.group(1) + ' '.join(v for i in range(0, len(n), 3) for v in (n[i + 1], n[i], n[i + 2]))
            return re.sub(r'(<posList>|<lowerCorner>|<upperCorner>)([^<]*)', turn, data.decode()).encode()
        d.change(d.gml, swap)
        self.found(d, 'SOLID_INVALID GEOMETRY_DIFFERS POSITION', d.gml)

    def test_an_open_solid(self):
        d = self.damaged()

        def drop(text):
            at = text.index('<bldg:lod1Solid>')
            start = text.index('<surfaceMember>', at)
            end = text.index('</surfaceMember>', start) + len('</surfaceMember>')
            return text[:start] + text[end:]
        self.found(d, 'SOLID_INVALID GEOMETRY_DIFFERS', d.building(drop), '302 shell not closed')

    def test_a_building_that_is_missing(self):
        d = self.damaged()
        building = d.building(lambda text: '')
        self.found(d, 'OBJECT_MISSING COUNTS_DIFFER EXPLANATION_WRONG REPORT_WRONG CITYGML_RULE', building)

    def test_a_building_that_stands_twice(self):
        d = self.damaged()
        building = d.building(lambda text: text + text)
        self.found(d, 'CITYGML_RULE OBJECT_DOUBLED COUNTS_DIFFER EXPLANATION_WRONG', building)

    def test_a_wrong_reference_system(self):
        d = self.damaged()
        d.change(d.gml, lambda t: re.sub(rb'srsName="[^"]*"', b'srsName="urn:ogc:def:crs:EPSG::25831"', t))
        self.found(d, 'CITYGML_RULE', 'EPSG::25831')

    def test_a_reference_to_nowhere(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'xlink:href="#[^"]*"', 'xlink:href="#nowhere"', text, count=1))
        self.found(d, 'CITYGML_RULE', building, '#nowhere')  # of a surface; the solid has its polygons itself

    def test_an_open_ring(self):
        d = self.damaged()
        self.found(d, 'CITYGML_RULE SOLID_INVALID GEOMETRY_DIFFERS', d.ring(lambda r: r[:-1]), '103 ring not closed')

    def test_an_unknown_source(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'(name="height_source"><gen:value>)[^<]*', r'\1guess', text), lambda t: 'name="height_source"' in t)
        self.found(d, 'SOURCE_WRONG ATTRIBUTE_DIFFERS EXPLANATION_WRONG COUNTS_DIFFER', building, 'guess')

    def test_a_confidence_above_one(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'(name="height_confidence"><gen:value>)[^<]*', r'\g<1>1.5', text), lambda t: 'name="height_confidence"' in t)
        self.found(d, 'SOURCE_WRONG ATTRIBUTE_DIFFERS', building, '1.5')

    def test_a_number_that_is_none(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'(name="roof_height"><gen:value>)[^<]*', r'\1high', text), lambda t: 'name="roof_height"' in t)
        self.found(d, 'CITYGML_RULE ATTRIBUTE_DIFFERS EXPLANATION_WRONG', building, 'high')

    def test_an_attribute_of_citygml(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'(<bldg:storeysAboveGround>)\d+', r'\g<1>77', text), lambda t: '<bldg:storeysAboveGround>' in t)
        self.found(d, 'ATTRIBUTE_DIFFERS EXPLANATION_WRONG', building, '77')

    def test_a_colour_of_citygml(self):
        d = self.damaged()
        d.change(d.gml, lambda t: re.sub(rb'(<app:diffuseColor>)[^<]*', rb'\g<1>1 0 1', t, count=1))
        self.found(d, 'COLOUR_DIFFERS', '#ff00ff')

    def test_a_colour_that_is_none(self):
        d = self.damaged()
        d.change(d.gml, lambda t: re.sub(rb'(<app:diffuseColor>)[^<]*', rb'\g<1>1 2 3', t, count=1))
        self.found(d, 'CITYGML_RULE', 'colour')

    def test_an_appearance_of_nothing(self):
        d = self.damaged()
        d.change(d.gml, lambda t: re.sub(rb'(<app:target>)[^<]*', rb'\g<1>#nothing', t, count=1))
        self.found(d, 'CITYGML_RULE', '#nothing')

    def test_an_envelope_that_is_too_small(self):
        d = self.damaged()

        def lower(data):
            found = re.search(rb'<upperCorner>([^<]*)', data)
            x, y, z = found.group(1).split()
            return data[:found.start(1)] + b'%s %s %.4f' % (x, y, float(z) - 1) + data[found.end(1):]
        d.change(d.gml, lower)
        self.found(d, 'CITYGML_RULE', 'envelope')

    def test_an_element_that_does_not_exist(self):
        d = self.damaged()
        d.change(d.gml, lambda t: t.replace(b'bldg:roofType', b'bldg:roofKind'))
        self.found(d, 'CITYGML_RULE', 'roofKind')

    def test_elements_out_of_order(self):
        """What only the schema knows."""
        schemas = os.path.join(Setup.shared or '', 'schemas')
        if not os.path.exists(os.path.join(schemas, 'citygml2.xsd')):
            self.skipTest('no CityGML schemas')
        d = self.damaged()

        def swap(text):
            found = re.search(r'(<bldg:measuredHeight[^>]*>[^<]*</bldg:measuredHeight>\s*)(<bldg:storeysAboveGround>[^<]*</bldg:storeysAboveGround>)', text)
            return text[:found.start()] + found.group(2) + found.group(1) + text[found.end():]
        d.building(swap, lambda t: '<bldg:storeysAboveGround>' in t)
        self.found(d, 'CITYGML_SCHEMA', d.gml, options=('--schemas', schemas))

    # ---- CityJSON

    def feature(self, d, change, wanted=lambda f: True):
        """Changes the first feature that `wanted` accepts; None from `change` drops it. Returns its id."""
        lines = d.read(d.cityjson).decode().splitlines()
        for i, line in enumerate(lines[1:], 1):
            feature = json.loads(line)
            if not wanted(feature):
                continue
            changed = change(feature)
            lines[i:i + 1] = [] if changed is None else [json.dumps(changed, ensure_ascii=False, separators=(',', ':'))]
            d.write(d.cityjson, ''.join(line + '\n' for line in lines).encode())
            return feature['id']
        raise AssertionError('no such feature')

    def test_a_child_without_parent(self):
        d = self.damaged()

        def orphan(f):
            for o in f['CityObjects'].values():
                o.pop('parents', None)
            return f
        d_id = self.feature(d, orphan, lambda f: len(f['CityObjects']) > 1)
        result = self.validate_sealed(d)
        self.assertIn('CITYJSON_RULE', {f['code'] for f in result['findings']})
        self.assertTrue(any(d_id in f['object'] for f in result['findings']))

    def test_a_vertex_that_does_not_exist(self):
        d = self.damaged()

        def point_beyond(f):
            geometry = [g for o in f['CityObjects'].values() for g in o.get('geometry', []) if g['type'] == 'Solid'][0]
            geometry['boundaries'][0][0][0][0] = 99999
            return f
        self.feature(d, point_beyond)
        result = self.validate_sealed(d)
        self.assertIn('CITYJSON_RULE', {f['code'] for f in result['findings']})

    def test_another_kind_of_surface(self):
        d = self.damaged()

        def rename(f):
            for o in f['CityObjects'].values():
                for g in o.get('geometry', []):
                    for s in g.get('semantics', {}).get('surfaces', []):
                        if s['type'] == 'RoofSurface':
                            s['type'] = 'OuterFloorSurface'
            return f
        changed = self.feature(d, rename)
        self.found(d, 'GEOMETRY_DIFFERS', changed, 'outer_floor')

    def test_a_feature_that_is_missing(self):
        d = self.damaged()
        dropped = self.feature(d, lambda f: None)
        result = self.validate_sealed(d)
        codes = {f['code'] for f in result['findings']}
        self.assertLessEqual({'OBJECT_MISSING', 'COUNTS_DIFFER'}, codes)
        self.assertTrue(any(dropped == f['object'] for f in result['findings'] if f['code'] == 'OBJECT_MISSING'))

    def test_a_scale_that_is_wrong(self):
        d = self.damaged()

        def stretch(data):
            first, rest = data.split(b'\n', 1)
            head = json.loads(first)
            head['transform']['scale'] = [0.001] * 3
            return json.dumps(head).encode() + b'\n' + rest
        d.change(d.cityjson, stretch)
        codes = {f['code'] for f in self.validate_sealed(d)['findings']}
        self.assertLessEqual({'GEOMETRY_DIFFERS', 'POSITION'}, codes)

    # ---- GeoPackage

    def test_a_row_that_is_missing(self):
        d = self.damaged()
        d.sql("DELETE FROM parts WHERE id = 'w1020'")
        result = self.validate_sealed(d)
        codes = {f['code'] for f in result['findings']}
        self.assertIn('OBJECT_MISSING', codes)
        self.assertTrue(any(f['object'] == 'w1020' for f in result['findings']))

    def test_a_value_of_the_geopackage(self):
        d = self.damaged()
        d.sql("UPDATE parts SET height = height + 1 WHERE id = 'w1020'")
        self.found(d, 'ATTRIBUTE_DIFFERS', 'buildings.gpkg', 'w1020')

    def test_a_geometry_of_the_geopackage(self):
        d = self.damaged()
        d.sql("UPDATE parts SET geom = (SELECT geom FROM parts WHERE id = 'w1024') WHERE id = 'w1020'")
        result = self.validate_sealed(d)
        found = [f for f in result['findings'] if f['code'] == 'GEOMETRY_DIFFERS']
        self.assertEqual({(f['file'], f['object']) for f in found}, {('buildings.gpkg', 'w1020')})

    def test_a_reported_object_that_is_missing(self):
        d = self.damaged()
        d.sql("DELETE FROM reported WHERE id = 'w9004'")
        result = self.validate_sealed(d)
        self.assertTrue(any(f['code'] == 'OBJECT_MISSING' and f['object'] == 'w9004' for f in result['findings']))

    def test_a_position_in_the_row_that_does_not_exist(self):
        d = self.damaged()
        d.sql("UPDATE buildings SET position = 'lost' WHERE id = 'w1020'")
        self.found(d, 'GEOPACKAGE_RULE', 'buildings.gpkg', 'w1020')

    def test_a_shift_that_contradicts_itself(self):
        d = self.damaged()
        d.sql("UPDATE buildings SET mean_shift = 0.3, max_shift = 0.2 WHERE id = 'w1020'")
        self.found(d, 'GEOPACKAGE_RULE', 'buildings.gpkg', 'w1020')

    def test_an_edge_that_is_missing_and_one_of_another_kind(self):
        d = self.damaged()
        db = sqlite3.connect(d.path('buildings.gpkg'))
        edges = db.execute('SELECT id, building FROM facade_edges ORDER BY fid').fetchall()
        db.close()
        if not edges:
            self.skipTest('this build has no edges')
        (first, _), (second, building) = edges[0], edges[len(edges) // 2]
        d.sql(f"UPDATE facade_edges SET kind = 'garden' WHERE id = '{first}'",
              f"DELETE FROM facade_edges WHERE id = '{second}'")
        found = [f for f in self.validate_sealed(d)['findings'] if f['code'] == 'GEOPACKAGE_RULE']
        self.assertLessEqual({first, building}, {f['object'] for f in found})

    # ---- explanations and reports

    def test_an_explanation_that_is_missing(self):
        d = self.damaged()
        gone = []
        d.explanations(lambda records: gone.append(records[0]['id']) or records[1:])
        self.found(d, 'EXPLANATION_WRONG', gone[0])

    def test_an_explanation_of_another_value(self):
        d = self.damaged()

        def change(records):
            for a in records[0]['attributes']:
                if a['name'] == 'height':
                    a['value'] += 3
        d.explanations(change)
        self.found(d, 'EXPLANATION_WRONG', 'height')

    def test_an_index_that_leads_nowhere(self):
        d = self.damaged()
        d.change('explain/index.txt', lambda t: t.replace(b'15_34776_25753', b'15_34776_25754', 1))
        self.found(d, 'EXPLANATION_WRONG', d.explained)

    def test_a_report_row_that_is_missing(self):
        d = self.damaged()
        d.json('report.json', lambda r: r['notices'].pop())
        self.found(d, 'COUNTS_DIFFER', 'report.json')

    def test_a_modelled_object_that_is_reported(self):
        d = self.damaged()

        def claim(report):
            row = next(r for r in report['objects'] if r['id'] == 'w9004')
            row['id'] = 'w1020'
        d.json('report.json', claim)
        self.found(d, 'REPORT_WRONG OBJECT_MISSING', 'w1020')

    def test_a_number_on_the_page(self):
        d = self.damaged()
        d.change('report.html', lambda t: re.sub(rb'<b>162</b><span>modelled', b'<b>163</b><span>modelled', t))
        self.found(d, 'REPORT_WRONG', 'modelled', '163')

    def test_an_issue_count_on_the_page(self):
        d = self.damaged()
        d.change('report.html', lambda t: re.sub(rb'(id="code-SPIKE_REMOVED"><summary><span class="count">)\d+', rb'\g<1>9', t))
        self.found(d, 'REPORT_WRONG', 'SPIKE_REMOVED')

    def test_a_page_that_is_not_well_formed(self):
        d = self.damaged()
        d.change('report.html', lambda t: t.replace(b'</section>', b'', 1))
        self.found(d, 'FILE_UNREADABLE', 'report.html')

    def test_a_page_that_loads_from_elsewhere(self):
        d = self.damaged()
        d.change('report.html', lambda t: t.replace(b'</main>', b'<img alt="" src="https://example.org/x.png"/></main>', 1))
        self.found(d, 'REPORT_WRONG', 'example.org')


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
        self.refused(blockrand('validate', SAMPLE), 1, 'no folder')

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
