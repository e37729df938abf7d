"""LoD3: facades by rule files, stored once and placed in GLBs, openings in CityGML; structure stays apart from style."""
import json
import os
import re
import shutil
import unittest

import judges
from blockrand_run import SAMPLE, SOURCE, BuildTest, blockrand, files_of, main, read_json
from glb_files import glb_json, places

LOD3 = ('--lod', '3', '--no-report', '--no-explain')


def gml(folder):
    text = ''
    for name in sorted(files_of(folder, '.gml')):
        with open(os.path.join(folder, name), encoding='utf-8') as f:
            text += f.read()
    return text


def lod2_polygons(text):
    """The polygons that LoD2 solids are made of, by id."""
    return dict(re.findall(r'<gml:Polygon gml:id="([^"]*_p\d+)">(.*?)</gml:Polygon>', text, re.S))


class Facades(BuildTest):
    def sound(self, out):
        self.assertEqual(judges.xmllint(out), '')
        self.assertEqual(judges.khronos(out), '')
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
        self.assertEqual(placed['ext'], text.count('<ImplicitGeometry>'))
        self.assertLess(placed['meshes'], placed['ext'] / 4, 'elements are stored once')
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
        self.assertEqual(ext['ext'], nodes['nodes'])
        self.assertEqual((baked['ext'], baked['nodes']), (0, 0))
        self.assertEqual(judges.khronos(baked_folder), '')

    def test_one_file(self):
        out = self.build(SAMPLE, 'single', *LOD3, '--formats', 'gltf', '--single-glb')
        glb = glb_json(os.path.join(out, 'model.glb'))
        placed = sum(glb['accessors'][n['extensions']['EXT_mesh_gpu_instancing']['attributes']['TRANSLATION']]['count']
                     for n in glb['nodes'] if 'extensions' in n)
        self.assertEqual(placed, places(out)['ext'])

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

    def test_shipped_rules_pass_their_check(self):
        folder = os.path.join(SOURCE, 'configs', 'grammars')
        run = blockrand('grammar', 'check', *[os.path.join(folder, f) for f in sorted(os.listdir(folder))])
        self.assertEqual(run.code, 0, run)
        self.assertIn('0 errors, 0 warnings', run.out + run.err)


if __name__ == '__main__':
    main()
