"""Textures of surfaces in GLBs: beside the tiles, shared, and nothing of the buildings is another."""
import json
import os

import validators
from blockrand_run import SAMPLE, BuildTest, blockrand, files_of, main, read_json, sha256
from model_files import Glb

SMALL_MOST, FULL_MOST = 3_000_000, 12_000_000  # bytes of WebP


def size_of(folder, ending):
    return sum(os.path.getsize(os.path.join(folder, name)) for name in files_of(folder, ending))


class Textures(BuildTest):
    def build_with(self, name, textures, *options):
        return self.build(SAMPLE, name, '--lod', '3', '--formats', 'gltf,citygml', '--surroundings', 'on', '--textures', textures, *options)

    def test_nothing_but_surfaces_is_another(self):
        plain, textured = self.build_with('plain', 'none'), self.build_with('textured', 'shared', '--single-glb')
        self.assertEqual(validators.problems(textured), '')
        # Without them no word of them is written.
        self.assertEqual([name for name in files_of(plain) if 'texture' in name], [])
        self.assertNotIn('textures', json.dumps(read_json(plain, 'build.json')['configuration']))
        for name in files_of(plain, '.gml'):
            self.assertEqual(sha256(os.path.join(plain, name)), sha256(os.path.join(textured, name)), name)
        used, triangles = set(), 0
        for name in files_of(plain, '.glb'):
            a, b = Glb(os.path.join(plain, name)).json, Glb(os.path.join(textured, name)).json
            count = lambda j: sum(j['accessors'][p['indices']]['count'] for m in j['meshes'] for p in m['primitives'])
            # Panes with curtains are divided; nothing else is.
            self.assertLessEqual(count(a), count(b), name)
            self.assertLess(count(b), 1.2 * count(a), name)
            self.assertEqual(a['extensions']['EXT_structural_metadata'], b['extensions']['EXT_structural_metadata'], name)
            if name.endswith('_lod2.glb'):
                self.assertNotIn('KHR_texture_transform', b['extensionsUsed'], 'what is seen from afar is plain')
                continue
            for image in b.get('images', []):
                if 'uri' not in image:
                    continue
                file = os.path.normpath(os.path.join(os.path.dirname(os.path.join(textured, name)), image['uri']))
                self.assertTrue(os.path.exists(file), image)
                used.add(os.path.relpath(file, textured))
            for mesh in b['meshes']:
                for p in mesh['primitives']:
                    if 'baseColorTexture' in b['materials'][p['material']]['pbrMetallicRoughness']:
                        triangles += b['accessors'][p['indices']]['count'] // 3
        self.assertGreater(triangles, 1000)
        model = Glb(os.path.join(textured, 'model.glb')).json
        used.update(image['uri'] for image in model['images'])
        around = Glb(os.path.join(textured, 'surroundings.glb')).json
        used.update(image['uri'] for image in around['images'] if 'uri' in image)
        self.assertEqual(set(files_of(os.path.join(textured), '.webp', '.png')) - {'plan.png'}, used, 'those that are used, no others')
        self.assertLess(size_of(textured, '.webp'), FULL_MOST)
        self.assertEqual(read_json(textured, 'build.json')['configuration']['textures'], 'shared')

    def test_glass_is_of_several_kinds(self):
        told = {}
        for how in ('ext', 'nodes', 'baked'):
            folder = self.build(SAMPLE, 'glass-' + how, '--lod', '3', '--formats', 'gltf,citygml', '--textures', 'small', '--instancing', how,
                                '--single-glb', '--objects', 'building')
            self.assertEqual(validators.problems(folder), '')
            area = told.setdefault(how, {})
            for name in files_of(folder, '.glb'):
                glb = Glb(os.path.join(folder, name))
                for mesh in glb.json.get('meshes', []):
                    for p in mesh['primitives']:
                        material = glb.json['materials'][p['material']]
                        kind = material.get('extras', {}).get('glass_kind')
                        self.assertEqual(kind is not None, material['name'].startswith('glass'), material)
                        if not kind:
                            continue
                        self.assertEqual(material['emissiveFactor'], [0, 0, 0])
                        self.assertEqual(material['pbrMetallicRoughness']['metallicFactor'], 0)
                        self.assertNotIn('TEXCOORD_0', p['attributes'])
                        self.assertEqual('colour' in material['extras'], kind != 'other')
                        area[kind] = area.get(kind, 0) + glb.json['accessors'][p['indices']]['count'] // 3
        for how, kinds in told.items():
            for kind in ('clear', 'curtain', 'blind'):
                self.assertIn(kind, kinds, how)

    def test_a_tile_alone_has_the_same_panes(self):
        whole = self.build_with('whole', 'small')
        name = [n for n in files_of(whole, '.glb') if '_' not in os.path.basename(n)][0]
        alone = self.build_with('alone', 'small', '--tile', name[len('tiles/'):-len('.glb')], '--pinned', os.path.join(whole, 'build.json'))
        self.assertEqual(sha256(os.path.join(whole, name)), sha256(os.path.join(alone, name)))

    def test_small_ones_are_small(self):
        small = self.build_with('small', 'small')
        self.assertGreater(len(files_of(small, '.webp')), 6)
        self.assertLess(size_of(small, '.webp'), SMALL_MOST)

    def test_the_same_bytes_whatever_the_threads(self):
        one, two = self.build_with('one', 'small', '--jobs', '1'), self.build_with('two', 'small', '--jobs', '2')
        for name in files_of(one, '.glb', '.webp', '.png'):
            self.assertEqual(sha256(os.path.join(one, name)), sha256(os.path.join(two, name)), name)

    def test_what_cannot_be_is_refused(self):
        target = self.path('refused')
        self.refused(blockrand('build', SAMPLE, '-o', target, '--textures', 'golden'), 1, 'golden', 'shared', target=target)


if __name__ == '__main__':
    main()
