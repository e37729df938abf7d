"""LoD3: facades by rule files, stored once and placed in GLBs, openings in CityGML; structure stays apart from style."""
import json
import os
import re
import shutil
import struct
import sys
import unittest

import validators
from blockrand_run import SAMPLE, SOURCE, BuildTest, blockrand, files_of, main, read_json
from damage import Damaged
from glb_files import glb_json, places
from model_files import Glb

sys.path.insert(0, os.path.join(SOURCE, 'tests', 'bench'))
import glb_counts  # noqa: E402

LOD3 = ('--lod', '3', '--surroundings', 'off', '--no-report', '--no-explain')


def gml(folder):
    text = ''
    for name in sorted(files_of(folder, '.gml')):
        with open(os.path.join(folder, name), encoding='utf-8') as f:
            text += f.read()
    return text


def lod2_polygons(text):
    """The polygons that LoD2 solids are made of, by id."""
    return dict(re.findall(r'<Polygon gml:id="([^"]*_p\d+)">(.*?)</Polygon>', text, re.S))


class Facades(BuildTest):
    def sound(self, out):
        self.assertEqual(validators.xmllint(out), '')
        self.assertEqual(validators.khronos(out), '')
        issues = read_json(out, 'build.json')['issues']
        self.assertNotIn('FACADE_FAILED', issues)
        self.assertNotIn('GRAMMAR_ERROR', issues)

    def test_the_sample_has_facades(self):
        out = self.build(SAMPLE, 'lod3', *LOD3, '--formats', 'gltf,citygml')
        counts = read_json(out, 'build.json')['counts']
        self.assertGreater(counts['models_lod3'], 0.8 * counts['models'])
        self.sound(out)
        text = gml(out)
        windows, doors = text.count('<bldg:Window '), text.count('<bldg:Door ')
        self.assertGreater(windows, 5 * counts['models'])
        self.assertGreater(doors, 0.3 * counts['models'])
        self.assertEqual(windows + doors, text.count('<bldg:opening>'))
        placed = places(out)
        whole = places(self.build(SAMPLE, 'whole', *LOD3, '--formats', 'gltf', '--instancing', 'nodes'))
        full = gml(self.build(SAMPLE, 'full', *LOD3, '--formats', 'citygml', '--citygml-detail', 'full'))
        self.assertEqual(whole['nodes'], full.count('<core:ImplicitGeometry>'))
        self.assertEqual(full.count('<bldg:opening>'), windows + doors)
        self.assertEqual(text.count('<core:ImplicitGeometry>'),
                         len(re.findall('<bldg:BuildingInstallation [^>]*><bldg:function>[^<]*</bldg:function>\\s*<bldg:lod3Impl', full)))
        self.assertLess(2.2 * len(text), len(full), 'elements are told once; bodies along the edges of roofs are whole in both')
        self.assertLess(placed['meshes'], placed['ext'] / 4, 'pieces are stored once')
        for name in files_of(out, '.glb'):
            draws, stored, shown, _ = glb_counts.count_scene(glb_json(os.path.join(out, name)))
            self.assertLessEqual(draws, 300, "the sample has a house of every kind in its middle: 2,699 before pieces were shared")
            self.assertLessEqual(stored, shown)
        self.assertGreater(text.count('<bldg:lod3Solid>'), 0.8 * counts['models'])

    def test_same_bytes_for_any_number_of_threads(self):
        one = self.build(SAMPLE, 'one', *LOD3, '--jobs', '1')
        two = self.build(SAMPLE, 'two', *LOD3, '--jobs', '2')
        self.assertEqual(read_json(one, 'build.json')['files'], read_json(two, 'build.json')['files'])

    def test_structure_stays_apart_from_style(self):
        """Another preset changes facades, not a point of LoD2."""
        configs = self.path('configs')
        shutil.copytree(os.path.join(SOURCE, 'configs'), configs)
        presets = os.path.join(configs, 'styles', 'presets.toml')
        with open(presets, encoding='utf-8') as f:
            text = f.read()
        with open(presets, 'w', encoding='utf-8') as f:
            f.write(re.sub(r'^attributes = .*\n', '', re.sub(r'grammar = "\w+\.cga"', 'grammar = "slab.cga"', text), flags=re.M))
        plain = gml(self.build(SAMPLE, 'plain2', '--no-report', '--no-explain', '--formats', 'citygml'))
        usual = gml(self.build(SAMPLE, 'usual', *LOD3, '--formats', 'citygml'))
        slabs = gml(self.build(SAMPLE, 'slabs', *LOD3, '--formats', 'citygml', '--configs', configs))
        wanted = lod2_polygons(plain)
        for other in (lod2_polygons(usual), lod2_polygons(slabs)):
            self.assertTrue(all(other.get(name) == polygon for name, polygon in wanted.items()))
        self.assertNotEqual(usual.count('<bldg:Window '), slabs.count('<bldg:Window '))

    def test_instancing(self):
        ext = places(self.build(SAMPLE, 'ext', *LOD3, '--formats', 'gltf'))
        nodes = places(self.build(SAMPLE, 'nodes', *LOD3, '--formats', 'gltf', '--instancing', 'nodes'))
        baked_folder = self.build(SAMPLE, 'baked', *LOD3, '--formats', 'gltf', '--instancing', 'baked')
        baked = places(baked_folder)
        self.assertGreater(ext['ext'], 500)
        self.assertEqual((ext['nodes'], nodes['ext']), (0, 0))
        self.assertGreaterEqual(ext['ext'], nodes['nodes'], 'elements are placed in pieces')
        self.assertEqual((baked['ext'], baked['nodes']), (0, 0))
        self.assertEqual(validators.khronos(baked_folder), '')

    def test_one_file(self):
        """model.glb as objects, with shared meshes, and as tiles are: all sound, beside tiles of the same bytes."""
        merged = self.build(SAMPLE, 'single', '--lod', '3', '--surroundings', 'off', '--no-report', '--formats', 'gltf', '--single-glb')
        batch = self.build(SAMPLE, 'batch', '--lod', '3', '--surroundings', 'off', '--no-report', '--formats', 'gltf', '--single-glb', '--objects', 'tile')
        nodes = self.build(SAMPLE, 'shared', '--lod', '3', '--surroundings', 'off', '--no-report', '--formats', 'gltf', '--single-glb', '--instancing',
                           'nodes')
        self.same_files(merged, batch, 'tiles', 'tileset.json')
        for out in (merged, batch, nodes):
            self.assertEqual(validators.validate(out), '')
            self.assertEqual(validators.khronos(out), '')
        glb = glb_json(os.path.join(batch, 'model.glb'))
        placed = places(nodes)['nodes']
        glb = glb_json(os.path.join(nodes, 'model.glb'))
        self.assertEqual(sum('id' not in n['extras'] for n in glb['nodes']), placed)
        self.assertLess(len(glb['meshes']), placed / 4, 'elements are stored once')
        self.assertNotIn('extensionsRequired', glb)

    def test_objects(self):
        """A node for each house, below it one for each part: named, with few meshes, and nothing that an importer must know."""
        out = self.build(SAMPLE, 'objects', *LOD3, '--formats', 'gltf', '--single-glb')
        counts = read_json(out, 'build.json')['counts']
        glb = Glb(os.path.join(out, 'model.glb'))
        self.assertNotIn('extensionsRequired', glb.json)
        self.assertEqual(glb.json['extensionsUsed'], ['EXT_structural_metadata'])
        nodes = glb.json['nodes']
        houses = [nodes[number] for number in glb.json['scenes'][0]['nodes']]
        parts = [nodes[number] for house in houses for number in house['children']]
        self.assertEqual((len(houses), len(parts)), (counts['buildings'], counts['bodies']))
        self.assertEqual(len(nodes), len(houses) + len(parts))
        self.assertEqual(sorted(p['extras']['id'] for p in parts), sorted(glb.texts('id')))
        addresses = {a.split(',')[0] for a in glb.texts('address') if a}
        self.assertGreater(len(addresses), 10)
        named = sum(house['name'] in addresses for house in houses)
        self.assertGreater(named, 0.8 * len(addresses))
        for house in houses:
            self.assertTrue(house['name'] in addresses or house['name'] in (house['extras'].get('name_tag'), house['extras']['id']), house)
        colours = {}
        for mesh in glb.json['meshes']:
            used = [p['material'] for p in mesh['primitives']]
            # One primitive for each material, and further ones where it has more corners than 16 bits number.
            corners = {}
            for p in mesh['primitives']:
                corners[p['material']] = corners.get(p['material'], 0) + glb.json['accessors'][p['attributes']['POSITION']]['count']
            for material in set(used):
                self.assertLessEqual((used.count(material) - 1) * 60000, corners[material])
            for p in mesh['primitives']:
                self.assertEqual(list(p['attributes']), ['POSITION'])
                material = glb.json['materials'][p['material']]
                colours.setdefault(material['name'], set()).add(str(material))
        self.assertTrue(all(len(same) == 1 for same in colours.values()), 'every material has a name of its own')
        said = re.search(r'model\.glb .*: ([\d,]+) houses in ([\d,]+) parts, ([\d,]+) triangles, [\d.]+ .B', self.last.out)
        self.assertTrue(said, self.last)
        self.assertEqual([int(n.replace(',', '')) for n in said.groups()],
                         [len(houses), len(parts), sum(glb.json['accessors'][p['indices']]['count'] // 3
                                                       for mesh in glb.json['meshes'] for p in mesh['primitives'])])

    def test_mistakes_in_rules_are_located(self):
        """Before anything is read, and nothing is written."""
        configs = self.path('broken')
        shutil.copytree(os.path.join(SOURCE, 'configs'), configs)
        with open(os.path.join(configs, 'grammars', 'plain.cga'), 'a', encoding='utf-8') as f:
            f.write('\nBroken --> split(x){ ~1 : Wall. | \n')
        target = self.path('nothing')
        run = blockrand('build', SAMPLE, '-o', target, *LOD3, '--configs', configs, '--progress', 'none')
        self.assertEqual(run.code, 2, run)
        self.assertRegex(run.err, r'plain\.cga:\d+:\d+')
        self.assertFalse(os.path.exists(target))
        # A build without facades does not ask for them.
        self.build(SAMPLE, 'lod2', '--configs', configs, '--formats', 'gltf')

    def test_validate_reads_every_way_of_writing(self):
        ways = (['citygml', 'ext', '--citygml-detail', 'full'], ['citygml', 'ext'], ['cityjson', 'nodes'], ['citygml', 'baked'], ['cityjson', 'ext', '--compress', 'meshopt'])
        for number, (form, *how) in enumerate(ways):
            out = self.build(SAMPLE, f'way{number}', '--lod', '3', '--formats', f'gltf,{form}', '--no-report', '--instancing', *how)
            self.assertEqual(validators.validate(out), '')
            self.assertEqual(validators.khronos(out), '')

    def test_levels_of_detail(self):
        out = self.build(SAMPLE, 'levels', *LOD3, '--formats', 'gltf', '--max-glb-bytes', '0')
        self.assertEqual(validators.tileset(out), '')
        self.assertEqual(validators.metadata(out), '')
        for name in files_of(out, '.glb'):
            if '_lod' not in name:
                self.assertTrue(os.path.exists(os.path.join(out, name.replace('.glb', '_lod2.glb'))))
        self.assertEqual([f for f in files_of(out, '.glb') if '_lod1' in f], [])

    def test_compressed_files_are_small(self):
        def size(out):
            return sum(os.path.getsize(os.path.join(out, f)) for f in files_of(out, '.glb'))
        plain = self.build(SAMPLE, 'plain_size', *LOD3, '--formats', 'gltf', '--compress', 'none')
        packed = self.build(SAMPLE, 'packed_size', *LOD3, '--formats', 'gltf')
        self.assertLess(size(packed), 0.3 * size(plain))

    def test_the_model_is_plain_and_the_end_says_what_is_not(self):
        out = self.path('with_model')
        run = blockrand('build', SAMPLE, '-o', out, '--lod', '2', '--formats', 'gltf', '--single-glb')
        self.assertEqual(run.code, 0, run)
        self.assertIn('--compress none', run.out[-400:])
        for name in files_of(out, '.glb'):
            required = glb_json(os.path.join(out, name)).get('extensionsRequired', [])
            self.assertEqual('EXT_meshopt_compression' in required, name != 'model.glb', name)

    def test_shipped_rules_pass_their_check(self):
        folder = os.path.join(SOURCE, 'configs', 'grammars')
        files = sorted(os.path.join(path, f) for path, _, names in os.walk(folder) for f in names if f.endswith('.cga'))
        run = blockrand('grammar', 'check', *files)
        self.assertEqual(run.code, 0, run)
        self.assertIn('0 errors, 0 warnings', run.out + run.err)


class DamagedFacades(BuildTest):
    """What is planted into the GLBs of a sound build is found."""

    def found(self, change, codes, *words):
        source = self.path('sound')
        if not os.path.exists(source):
            self.build(SAMPLE, 'sound', *LOD3, '--formats', 'gltf,gpkg', '--max-glb-bytes', '0', '--compress', 'none')
        d = Damaged(source, self.path(self.id().split('.')[-1]))
        change(d)
        d.seal()
        run = blockrand('validate', d.folder, '--json', '--progress', 'none')
        findings = json.loads(run.out)['findings']
        self.assertTrue({f['code'] for f in findings} & set(codes.split()), findings[:5])
        for word in words:
            self.assertTrue(any(word in f['detail'] for f in findings), findings[:5])

    @staticmethod
    def instances(document):
        return next(n['extensions'] for n in document['nodes'] if 'EXT_mesh_gpu_instancing' in n.get('extensions', {}))

    def attribute(self, document, name):
        a = document['accessors'][self.instances(document)['EXT_mesh_gpu_instancing']['attributes'][name]]
        view = document['bufferViews'][a['bufferView']]
        return a, view.get('byteOffset', 0) + a.get('byteOffset', 0)

    def test_a_broken_instance_buffer(self):
        def change(j, b):
            _, at = self.attribute(j, 'TRANSLATION')
            b[at:at + 12] = struct.pack('<fff', 9e8, 0, 0)
        self.found(lambda d: d.change_glb(change), 'TILE_BOUNDS GLB_RULE')

    def test_a_wrong_feature_id(self):
        def change(j, b):
            _, at = self.attribute(j, '_FEATURE_ID_0')
            b[at:at + 2] = struct.pack('<H', 65000)
        self.found(lambda d: d.change_glb(change), 'METADATA_RULE', '65000')

    def test_a_wrong_count(self):
        def change(j, _):
            self.attribute(j, 'ROTATION')[0]['count'] -= 1
        self.found(lambda d: d.change_glb(change), 'GLB_RULE', 'values of another attribute')

    def test_a_level_that_the_tileset_forgot(self):
        def change(document):
            def walk(tile):
                children = tile.get('children', [])
                for i, child in enumerate(children):
                    if child.get('content', {}).get('uri', '').endswith('_lod2.glb'):
                        children[i] = child['children'][0]
                    walk(children[i])
            walk(document['root'])
        self.found(lambda d: d.json('tileset.json', change), 'TILE_MISSING', 'does not name it')

    def test_a_level_that_is_not_finer(self):
        def change(document):
            def walk(tile):
                for child in tile.get('children', []):
                    if tile.get('content', {}).get('uri', '').endswith('_lod2.glb'):
                        child['geometricError'] = tile['geometricError']
                    walk(child)
            walk(document['root'])
        self.found(lambda d: d.json('tileset.json', change), 'TILESET_RULE', 'not finer')


if __name__ == '__main__':
    main()
