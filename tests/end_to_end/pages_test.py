"""The pages in a browser: axe-core finds nothing serious, and search, sorting, colours and the table do what they say."""
import csv
import io
import json
import os
import shutil
import unittest

import validators
from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, call, extract, main, read_json
from imagery_test import Imagery
from osm_files import read_xml
from region_run import Map, RegionTest


def node(test, *arguments):
    tool = shutil.which('node') or shutil.which('nodejs')
    if not tool or not Setup.node_modules:
        test.skipTest('node or its packages are absent: npm install with tests/validators/package.json')
    run = call([tool, os.path.join(validators.VALIDATORS, 'pages.mjs'), os.path.abspath(Setup.node_modules), *arguments], timeout=600)
    if run.code == 77:
        test.skipTest(run.err.strip())
    test.assertEqual(run.code, 0, run)
    out = json.loads(run.out)
    test.assertEqual(out['messages'], [], 'the page complains')
    return out['answer']


class Report(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.source = extract('berlin-zionskirchplatz-2020.osm') or SAMPLE
        cls.out = cls().build(cls.source, 'out', '--lod', '2', '--formats', 'gpkg')
        cls.page = os.path.join(cls.out, 'report.html')

    def rows_of_table(self):
        with open(os.path.join(self.out, 'buildings.csv'), 'rb') as f:
            data = f.read()
        self.assertTrue(data.startswith(b'\xef\xbb\xbf'), 'spreadsheets take it for UTF-8')
        self.assertTrue(data.endswith(b'\r\n'))
        return list(csv.DictReader(io.StringIO(data.decode('utf-8-sig'), newline=''), strict=True))

    def test_the_page_does_what_it_says(self):
        used = node(self, 'report', self.page)
        houses = used['houses']
        self.assertEqual(len(houses), len(self.rows_of_table()))
        self.assertEqual(len(used['rows']), min(25, len(houses)))
        # A heading sorts all houses, not the rows that are shown.
        self.assertEqual(used['sorted_heads'], 1)
        storeys = [h[4] for h in houses]
        shown = used['sorted']['3 descending']
        self.assertEqual([float(s) for s in shown], sorted(storeys, reverse=True)[:len(shown)])
        areas = sorted((h[13] for h in houses), reverse=True)
        self.assertEqual([int(a.split('\u00a0')[0].replace(',', '')) for a in used['sorted']['9 descending']], areas[:len(shown)])
        self.assertEqual(len(used['sorted']), 20, 'every column, both ways')
        # Search finds by id and by address, and says so when there is none.
        wanted = used['wanted']
        self.assertEqual([r[0] for r in used['by_id']['rows']], [wanted[0]])
        self.assertEqual(len(used['by_id']['hits']), 1)
        if wanted[1]:
            self.assertIn(wanted[1], [r[1] for r in used['by_address']['rows']][0])
        self.assertEqual(used['none']['rows'], [])
        self.assertEqual(used['none']['found'], 'None found.')
        # The house that was found stands in the middle of the map, with its facts and its row.
        self.assertIn(wanted[0], used['card'])
        self.assertEqual(used['chosen'], [wanted[0]])
        x, y, width, height = (float(v) for v in used['zoomed'].split())
        self.assertTrue(x <= float(used['ring'][0]) <= x + width and y <= float(used['ring'][1]) <= y + height)
        self.assertEqual(used['row_chosen'], ['house-' + wanted[0]])
        self.assertIsNone(used['closed'])
        self.assertIn(used['clicked'], used['card_of_click'])
        self.assertNotEqual(used['card_of_key'], used['card_of_click'])
        self.assertIsNone(used['card_after_escape'])
        # Each button shows its own legend, and the map has its colours, with the script and without.
        self.assertEqual(used['themes'], used['themes_without_script'])
        self.assertEqual([t['letter'] for t in used['themes']], list('aesrqhki'))
        for theme in used['themes']:
            self.assertEqual(theme['legends'], ['key legend of-' + theme['letter']])
            self.assertEqual(theme['wrong'], 0, theme)
            self.assertEqual(theme['colours'], theme['classes'], theme)
        self.assertEqual(used['rows_without_script'], min(25, len(houses)))
        self.assertEqual(used['links_without_script'], used['rows_without_script'])
        if used.get('block'):
            self.assertNotIn(used['block']['stroke'], ('none', ''))

    def test_the_table_is_what_was_built(self):
        rows = self.rows_of_table()
        counts = read_json(self.out, 'build.json')['counts']
        self.assertEqual(len({row['id'] for row in rows}), len(rows))
        self.assertEqual(sum(int(row['bodies']) for row in rows), counts['bodies'])
        for row in rows:
            self.assertRegex(row['id'], r'^[nwr]-?\d+$')
            self.assertFalse(any(v[:1] in tuple('=+@') for v in row.values()), row)
            if row['storeys']:
                self.assertGreater(float(row['height_m']), 0)
                self.assertRegex(row['storeys_source'], '^[a-z]+$')
                self.assertLessEqual(float(row['floor_area_on_guessed_storeys_m2']), float(row['floor_area_m2']))

    def test_axe_finds_nothing_serious(self):
        self.assertEqual(node(self, 'axe', self.page), [])


class OtherPages(BuildTest):
    def test_a_region_in_areas(self):
        out = self.build(SAMPLE, 'areas', '--lod', '1', '--formats', 'gpkg', '--areas', '14')
        pages = [os.path.join(out, 'report.html')]
        areas = os.listdir(os.path.join(out, 'areas', '14'))
        self.assertTrue(areas)
        for folder, _, files in os.walk(os.path.join(out, 'areas')):
            if 'report.html' in files:
                self.assertIn('buildings.csv', files)
                pages.append(os.path.join(folder, 'report.html'))
        self.assertEqual(node(self, 'axe', *pages[:2]), [])

    def test_a_comparison(self):
        folders = [self.build(SAMPLE, f'lod{lod}', '--lod', lod, '--formats', 'citygml', '--no-report') for lod in ('1', '2')]
        out = self.path('comparison')
        run = blockrand('compare', folders[0], os.path.join(folders[1], 'citygml'), '-o', out)
        self.assertIn(run.code, (0, 3), run)
        self.assertEqual(node(self, 'axe', os.path.join(out, 'compare.html')), [])


class OfImages(Imagery):
    """The page on images: of the village that imagery_test.py draws."""

    def test_houses_that_the_map_has_elsewhere_are_told_and_the_others_are_not(self):
        out = self.build(self.map, 'seen', '--imagery', self.image, '--lod', '1')
        self.assertEqual(node(self, 'axe', os.path.join(out, 'imagery.html')), [])


class OfChanges(RegionTest):
    def test_a_night(self):
        folder = self.path('town')
        self.update(folder, SAMPLE)
        map_ = Map(read_xml(SAMPLE))
        house = next(o for o in map_.ways('building') if 'building:levels' in o.tags)
        map_.edit(house, tags=dict(house.tags, **{'building:levels': '7'}))
        self.update(folder, map_.write_changes(self.path('one.osc.gz')))
        self.assertEqual(node(self, 'axe', os.path.join(folder, 'log', '000002.changes.html'),
                              os.path.join(folder, 'current', 'report.html')), [])


def load_tests(loader, _tests, _pattern):
    """Of the classes that tests here build upon, only what is told anew."""
    suite = unittest.TestSuite()
    for case in (Report, OtherPages):
        suite.addTests(loader.loadTestsFromTestCase(case))
    suite.addTest(OfImages('test_houses_that_the_map_has_elsewhere_are_told_and_the_others_are_not'))
    suite.addTest(OfChanges('test_a_night'))
    return suite


if __name__ == '__main__':
    main()
