"""What a build costs that can be counted, so that no change makes it worse unseen: draw calls, bytes, triangles, allocations.

tests/bench/counts.json has the counts of two extracts. More than a hundredth above one of them fails; --update writes them anew, which belongs into
the commit that changes them, with its reason. Times are of machines: tests/bench/compare_peers.py measures those.
"""
import json
import os
import sys
import unittest

from blockrand_run import SAMPLE, SOURCE, BuildTest, Setup, blockrand, extract, main, read_json

sys.path.insert(0, os.path.join(SOURCE, 'tests', 'bench'))
import glb_counts

COUNTS = os.path.join(SOURCE, 'tests', 'bench', 'counts.json')
SLACK = 1.01  # allocations differ by two in a thousand from run to run
OPTIONS = ('--lod', '3', '--surroundings', 'off', '--formats', 'gltf', '--jobs', '1', '-q')
COUNTED = ('draws', 'most_file_draws', 'bytes', 'gzip_bytes', 'stored_triangles', 'displayed_triangles')


# Where the program is linked with jemalloc, that says what was asked of it.
STATISTICS = {'MALLOC_CONF': 'stats_print:true,stats_print_opts:Jdblxeg'}


def allocations_of(text):
    """Requests to the allocator, of what it prints when the program ends; None where it prints nothing."""
    begin = text.find('{"jemalloc"')
    if begin < 0:
        return None
    merged = json.JSONDecoder().raw_decode(text[begin:])[0]['jemalloc']['stats.arenas']['merged']
    return merged['small']['nrequests'] + merged['large']['nrequests']


class Counts(BuildTest):
    def counts_of(self, name, source):
        out = self.path(name)
        run = blockrand('build', source, '-o', out, *OPTIONS, env=STATISTICS)
        self.assertEqual(run.code, 0, run)
        counts = glb_counts.counts(out)
        found = {key: counts[key] for key in COUNTED}
        found['report_bytes'] = os.path.getsize(os.path.join(out, 'report.html'))
        found['windows'] = read_json(out, 'build.json')['counts']['windows']
        allocations = allocations_of(run.err)
        if allocations is not None:
            found['allocations'] = allocations
        return found

    def check(self, name, source):
        found = self.counts_of(name, source)
        if Setup.update:
            known = read_json(COUNTS) if os.path.exists(COUNTS) else {}
            known[name] = found
            with open(COUNTS, 'w', encoding='utf-8') as f:
                json.dump(known, f, indent=1, sort_keys=True)
                f.write('\n')
            return
        known = read_json(COUNTS)[name]
        print(f'{name}: ' + ', '.join(f'{key} {value:,} of {known[key]:,}' for key, value in found.items()))
        worse = [f'{key}: {value:,} instead of {known[key]:,}' for key, value in found.items() if value > SLACK * known[key]]
        self.assertEqual(worse, [], f'{name}: more than tests/bench/counts.json has')
        self.assertEqual(found['windows'], known['windows'], 'fewer windows would make the rest cheap')

    def test_sample(self):
        self.check('sample', SAMPLE)

    def test_quarter(self):
        source = extract('berlin_frankfurter_allee.osm.pbf')
        if source is None:
            self.skipTest('no real data')
        self.check('berlin_frankfurter_allee', source)


class Sees(unittest.TestCase):
    """The counts are of what is drawn: a GLB that is known."""

    def test_known(self):
        glb = {'scenes': [{'nodes': [0]}], 'nodes': [{'children': [1, 2]}, {'mesh': 0}, {'mesh': 1, 'extensions': {'EXT_mesh_gpu_instancing': {'attributes': {'TRANSLATION': 2}}}}],
               'meshes': [{'primitives': [{'indices': 0, 'attributes': {'POSITION': 1}}, {'indices': 0, 'attributes': {'POSITION': 1}}]}, {'primitives': [{'indices': 0, 'attributes': {'POSITION': 1}}]}],
               'accessors': [{'count': 12}, {'count': 8}, {'count': 5}]}
        # Three primitives; two of the first mesh and five places of the second, of four triangles each; stored once.
        self.assertEqual(glb_counts.count_scene(glb), (3, 4, 28, 5))


if __name__ == '__main__':
    main()
