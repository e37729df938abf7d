"""The page of `blockrand view` in a browser: every function of it on a served build, and the same page inside of a report.

Needs Debian's Chromium and the npm packages of tests/validators/package.json; without them it skips.
"""
import json
import os
import shutil
import unittest

from blockrand_run import SAMPLE, BuildTest, Setup, call, extract, main
from view_test import served

SCRIPTS = os.path.dirname(os.path.abspath(__file__))


class ViewPage(BuildTest):
    def node(self, script, *arguments):
        tool = shutil.which('node') or shutil.which('nodejs')
        if not tool or not Setup.node_modules:
            self.skipTest('node or its packages are absent: npm install with tests/validators/package.json')
        run = call([tool, os.path.join(SCRIPTS, script), *arguments, os.path.abspath(Setup.node_modules)], timeout=1500)
        if run.code == 77:
            self.skipTest(run.err.strip())
        self.assertEqual(run.code, 0, run)
        return json.loads(run.out.strip().splitlines()[-1])

    def test_every_function(self):
        out = self.build(extract('berlin-zionskirchplatz-2020.osm') or SAMPLE, 'seen', '--lod', '3', '--formats', 'gltf')
        with served(out) as port:
            seen = self.node('view_page.mjs', f'http://127.0.0.1:{port}/', os.environ.get('BLOCKRAND_PICTURES') or self.path('pictures'))
        print('figures of the page:', json.dumps(seen))

    def test_the_report_shows_the_model(self):
        out = self.build(SAMPLE, 'reported', '--lod', '3', '--formats', 'gltf')
        seen = self.node('report_model.mjs', os.path.join(out, 'report.html'))
        self.assertEqual(seen['before'], 'hidden', 'nothing is unpacked before somebody asks')
        self.assertGreater(seen['colours'], 50, 'houses are drawn')
        self.assertEqual(seen['messages'], [])
        self.assertEqual(seen['foreign'], [], 'the page loads nothing')

    def test_large_builds_and_parts_of_builds_carry_none(self):
        out = self.build(SAMPLE, 'areas', '--lod', '2', '--formats', 'gltf', '--areas', '14')
        for place, _, names in os.walk(out):
            if 'report.html' in names:
                with open(os.path.join(place, 'report.html'), encoding='utf-8') as file:
                    self.assertNotIn('blockrand-embedded', file.read(), place)


if __name__ == '__main__':
    main()
