"""What stands and lies around the houses: layers of their own, beside files of buildings that stay as they are."""
import os
import shutil
import xml.etree.ElementTree as ElementTree

import validators
from blockrand_run import SAMPLE, BuildTest, blockrand, extract, files_of, main, read_json, sha256
from model_files import Glb

# Files that name all others, or the options.
OF_THE_WHOLE = ('build.json', 'run.json', 'tileset.json')


def surroundings(folder):
    return [name for name in files_of(folder, '_surroundings.glb') if name.startswith('tiles')]


def classes(folder):
    """{class: OSM ids} of all features around the houses."""
    found = {}
    for name in surroundings(folder):
        glb = Glb(os.path.join(folder, name))
        for osm_id, kind in zip(glb.texts('osm_id') if 'osm_id' in glb.columns() else [''] * 10 ** 6, glb.texts('class')):
            found.setdefault(kind, set()).add(osm_id)
    return found


class Surroundings(BuildTest):
    def check(self, source, name):
        '''Builds with and without: files of buildings are the same, all is sound. \\returns the folder with them'''
        plain = self.build(source, 'plain-' + name, '--lod', '3', '--formats', 'gltf,citygml,cityjson', '--surroundings', 'off')
        with_all = self.build(source, 'with-' + name, '--lod', '3', '--formats', 'gltf,citygml,cityjson', '--surroundings', 'on')
        new = [name for name in files_of(with_all) if not os.path.exists(os.path.join(plain, name))]
        self.assertTrue(new)
        self.assertEqual([name for name in new if 'surroundings' not in name], [])
        for name in files_of(plain):
            # Explanations name the files of their tile.
            if name in OF_THE_WHOLE or name.startswith(('report', 'explain')):
                continue
            self.assertEqual(sha256(os.path.join(plain, name)), sha256(os.path.join(with_all, name)), name)
        self.assertEqual(validators.problems(with_all), '')
        shutil.rmtree(plain)
        return with_all

    def test_sample(self):
        folder = self.check(SAMPLE, 'sample')
        found = classes(folder)
        self.assertIn('carriageway', found)
        # Every tree of the file is told of.
        trees = [e for e in ElementTree.parse(SAMPLE).getroot()
                 if any(t.get('k') == 'natural' and t.get('v') in ('tree', 'tree_row') for t in e.findall('tag'))]
        told = read_json(folder, 'build.json')['surroundings'].get('tree', {})
        self.assertEqual(sum(told.values()), len(trees), told)
        streets = [e for e in ElementTree.parse(SAMPLE).getroot().findall('way') if any(t.get('k') == 'highway' for t in e.findall('tag'))]
        told = read_json(folder, 'build.json')['surroundings']['road']
        self.assertGreaterEqual(told['modelled'], 0.8 * len(streets), told)

    def test_quarter(self):
        source = extract('husum_altstadt.osm.pbf')
        if not source:
            self.skipTest('shared data is absent')
        folder = self.check(source, 'quarter')
        found = classes(folder)
        for kind in ('carriageway', 'pavement', 'water', 'grass', 'tree'):
            self.assertIn(kind, found)
        counts = read_json(folder, 'build.json')['surroundings']
        self.assertGreater(counts['road']['modelled'], 100)

    def test_a_tile_alone_has_the_same_surroundings(self):
        source = extract('berlin_karl_marx_allee.osm.pbf') or SAMPLE
        whole = self.build(source, 'whole', '--lod', '2', '--formats', 'gltf', '--surroundings', 'on', '--no-report')
        tried = 0
        for name in surroundings(whole):
            tile = name[len('tiles/'):-len('_surroundings.glb')]
            alone = self.build(source, 'alone', '--lod', '2', '--formats', 'gltf', '--surroundings', 'on', '--no-report', '--tile', tile,
                               '--pinned', os.path.join(whole, 'build.json'))
            self.assertEqual(sha256(os.path.join(whole, name)), sha256(os.path.join(alone, name)), tile)
            shutil.rmtree(alone)
            tried += 1
            if tried == 4:
                break
        self.assertGreater(tried, 0)

    def test_layers(self):
        folder = self.build(SAMPLE, 'objects', '--lod', '1', '--formats', 'gltf', '--surroundings', 'objects')
        for name in surroundings(folder):
            glb = Glb(os.path.join(folder, name))
            for node in glb.json['nodes']:
                self.assertTrue('mesh' not in node or 'EXT_mesh_gpu_instancing' in node.get('extensions', {}), node)
        baked = self.build(SAMPLE, 'baked', '--lod', '1', '--formats', 'gltf', '--surroundings', 'on', '--instancing', 'baked')
        for name in surroundings(baked):
            self.assertNotIn('EXT_mesh_gpu_instancing', Glb(os.path.join(baked, name)).json.get('extensionsUsed', []))

    def test_what_cannot_be_is_refused(self):
        target = self.path('refused')
        self.refused(blockrand('build', SAMPLE, '-o', target, '--surroundings', 'ground,clouds'), 1, 'clouds', 'ground, bodies, objects', target=target)


if __name__ == '__main__':
    main()
