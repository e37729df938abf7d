"""`blockrand validate` finds each kind of damage planted into the tileset and its GLBs by what it is.

Every damage is sealed again (hashes and list of files in build.json are those of the damaged files), but for those that
are about hashes and lists.
"""
import json
import math
import os
import shutil
import struct

from blockrand_run import SAMPLE, blockrand, files_of, hashes, main, read_json
from damage import Damaged, accessor, column_start, first_leaf, index_format, primitive_of, table_of
from validate_run import Damages, Validated


class Pieces(Validated):
    """Tiles whose GLB is larger than asked are cut; they hold what the one file held."""
    def test_pieces(self):
        for options, part in ((('--lod', '3', '--surroundings', 'off'), 5), (('--lod', '2', '--compress', 'none', '--attributes', 'all'), 2)):
            with self.subTest(options):
                whole = self.build(SAMPLE, 'whole', *options, '--force', '--max-glb-bytes', '0')
                most = max(os.path.getsize(os.path.join(whole, p)) for p in files_of(whole, '.glb')) // part
                cut = self.build(SAMPLE, 'cut', *options, '--force', '--max-glb-bytes', str(most))
                pieces = [p for p in files_of(cut, '.glb') if '_q' in p]
                self.assertGreaterEqual(len(pieces), 3)
                self.assertTrue(all(os.path.getsize(os.path.join(cut, p)) <= most for p in pieces))
                if part > 4:
                    self.assertTrue(any(len(p.rpartition('_q')[2]) > len('0.glb') for p in pieces), 'none is cut twice')
                for build in (whole, cut):
                    run = blockrand('validate', build)
                    self.assertEqual(run.code, 0, run)
                a, b = (read_json(f, 'build.json') for f in (whole, cut))
                self.assertEqual(a['counts'], b['counts'])
                same = ('citygml', 'cityjson')
                self.assertEqual(hashes(whole, *same), hashes(cut, *same))
                self.assertEqual(sorted(lod for p in files_of(whole, '.glb') for lod in ('1', '2') if f'_lod{lod}' in p),
                                 sorted(lod for p in files_of(cut, '.glb') for lod in ('1', '2') if f'_lod{lod}' in p))

    def test_a_piece_that_is_missing(self):
        cut = self.build(SAMPLE, 'less', '--force', '--compress', 'none', '--max-glb-bytes', '50000')
        piece = [p for p in files_of(cut, '.glb') if '_q' in p][-1]
        os.remove(os.path.join(cut, piece))
        run = blockrand('validate', cut)
        self.assertEqual(run.code, 2, run)
        self.assertIn(piece, run.out)


class Tileset(Damages):
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


class GlbTiles(Damages):
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
            # A corner inside of the bounds, moved by 5 cm and more than a step.
            for i in range(a['count']):
                x, y, z = struct.unpack_from('<fff', b, start + i * stride)
                if all(low + 1 < v < high - 1 for v, low, high in zip((x, y, z), a['min'], a['max'])):
                    struct.pack_into('<f', b, start + i * stride, x + 0.0508)
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
        # The first triangle is one of a large wall, which counts for the volume.
        self.found_in_glb(change, 'GLB_RULE SOLID_INVALID GEOMETRY_DIFFERS', 'does not look')

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
            # One material for all, whose factor colours of vertices are multiplied by.
            j['materials'][primitive_of(j)['material']]['pbrMetallicRoughness']['baseColorFactor'] = [1, 0, 0, 1]
        self.found_in_glb(change, 'COLOUR_DIFFERS GLB_RULE', 'm2')

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

    @staticmethod
    def change_sources(document, old, new):
        """In the first text of the column that has `old`; they are values of an enumeration."""
        values = document['extensions']['EXT_structural_metadata']['schema']['enums']['sources']['values']
        value = next(v for v in values if old in v['name'])
        value['name'] = value['name'].replace(old, new, 1)

    def test_a_source_of_one_format(self):
        def change(j, _):
            self.change_sources(j, 'tag: ', 'tax: ')
        self.found_in_glb(change, 'SOURCE_WRONG ATTRIBUTE_DIFFERS', 'from "tax"')

    def test_sources_that_cannot_be_read(self):
        def change(j, _):
            self.change_sources(j, 'tag: ', 'tag, ')
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


if __name__ == '__main__':
    main()
