"""`blockrand compare` as a command: what it accepts and refuses, its exit codes, its files, and that only the input
decides what is in them. What it measures: a house that can be worked out by hand; the rest is in compare_degraded_test.py
and compare_real_test.py."""
import copy
import html.parser
import json
import os
import re
import signal
import sqlite3
import subprocess
import time
import unittest
import xml.etree.ElementTree as ElementTree

from blockrand_run import Setup, blockrand, hashes, main, read_json, sha256, stray_siblings
from compare_run import FILES, CompareTest, headline, reference, table, verdict
from interruption_test import small_disk, staging_of
from reference_osm import descendants


def box(id, x, y, width, depth, height, srs='EPSG:25832', cut=False):
    """A building of CityGML 2.0 as LoD1 solid with its south-west corner at x, y. `cut`: of triangles, which begin at
    the third corner, instead of rectangles."""
    corners = [(x, y), (x + width, y), (x + width, y + depth), (x, y + depth)]
    rings = [[(*p, 0) for p in corners[::-1]], [(*p, height) for p in corners]]
    for a, b in zip(corners, corners[1:] + corners[:1]):
        rings.append([(*a, 0), (*b, 0), (*b, height), (*a, height)])
    if cut:
        rings = [t for a, b, c, d in rings for t in ((c, d, a), (c, a, b))]
    polygons = ''.join('<gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>'
                       + ' '.join(f'{c:.3f}' for p in [*r, r[0]] for c in p)
                       + '</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>' for r in rings)
    return (f'<core:cityObjectMember><bldg:Building gml:id="{id}"><bldg:lod1Solid><gml:Solid srsName="{srs}" '
            f'srsDimension="3"><gml:exterior><gml:CompositeSurface>{polygons}</gml:CompositeSurface></gml:exterior>'
            '</gml:Solid></bldg:lod1Solid></bldg:Building></core:cityObjectMember>')


def city(*members, srs='EPSG:25832'):
    return ('<?xml version="1.0" encoding="UTF-8"?>\n<core:CityModel xmlns:core="http://www.opengis.net/citygml/2.0" '
            'xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:gml="http://www.opengis.net/gml">'
            f'<gml:boundedBy><gml:Envelope srsName="{srs}" srsDimension="3"><gml:lowerCorner>690000 5730000 0'
            '</gml:lowerCorner><gml:upperCorner>691000 5731000 100</gml:upperCorner></gml:Envelope></gml:boundedBy>'
            + '\n'.join(members) + '</core:CityModel>\n')


def street(count, change=0.0, cut=False):
    """Boxes in a row; `change`: how much higher and longer than the reference's."""
    return [box(f'B{i:03}', 690000 + 15 * i, 5730000, 10 + change, 8 + i % 3, 6 + i % 4 + change, cut=cut)
            for i in range(count)]


def measured(comparison):
    """compare.json without the names of files and what was read of each: what must not depend on how they are cut."""
    out = copy.deepcopy(comparison)
    out.pop('options')
    for side in ('model', 'reference'):
        out.pop(side)
    for row in out['missing'] + out['extra']:
        row.pop('file')
    return out


class Command(CompareTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        self = cls()
        cls.model = self.place('model.gml', city(*street(6, 0.5)))
        cls.reference = self.place('reference.gml', city(*street(6)))
        cls.done = self.path('done')
        self.compare('done', cls.model, cls.reference)

    def refuse(self, arguments, code, *words, output='refused'):
        target = self.path(output)
        run = blockrand('compare', *arguments, '-o', target, '--progress', 'none')
        self.refused(run, code, *words, target=target)

    def test_wrong_usage(self):
        both = [self.model, self.reference]
        baseline = os.path.join(self.done, 'compare.json')
        for arguments, words in [
                ([], ['MODEL', '--help']),
                ([self.model], ['REFERENCE', '--help']),
                (both + ['--nothing'], ['--nothing', '--help']),
                (both + ['--fail-if-worse', '2%'], ['--fail-if-worse', '--baseline']),
                (both + ['--baseline', baseline, '--fail-if-worse', 'much'], ['--fail-if-worse', 'much', '2%']),
                (both + ['--baseline', baseline, '--fail-if-worse', '-2%'], ['--fail-if-worse']),
                (both + ['--align', 'up'], ['--align', 'up', 'horizontal']),
                (both + ['--heights', 'high'], ['--heights', 'own-ground']),
                (both + ['--reach', '-1'], ['--reach']),
                (both + ['--samples', '0'], ['--samples']),
                (both + ['--max-lod', '9'], ['--max-lod']),
                (both + ['--pictures', 'many'], ['--pictures']),
                (both + ['--crs', 'EPSG:4326'], ['EPSG:4326', 'metres']),
                (both + ['--crs', 'nowhere'], ['nowhere']),
                (both + ['--model-origin', '1,2'], ['--model-origin'])]:
            with self.subTest(' '.join(map(str, arguments[2:]) or arguments)):
                self.refuse(arguments, 1, *words)

    def test_unreadable_input(self):
        os.makedirs(self.path('empty'), exist_ok=True)
        os.makedirs(self.path('letters'), exist_ok=True)
        self.place('letters/letter.txt', 'Dear all\n')
        whole = city(*street(3))
        for name, content, words in [
                ('text.txt', 'Dear all\n', ['format']), ('text.gml', 'Dear all\n', ['format']), ('void.gml', '', []),
                ('broken.json', '{"type": "CityJSON", "version"', []), ('other.json', '{"a": 1}', ['format']),
                ('broken.xml', '<core:CityModel', ['XML']), ('cut.gml', whole[:len(whole) // 5], []),
                ('page.xml', '<html><body>Hello</body></html>', [])]:
            with self.subTest(name):
                file = self.place(name, content)
                self.refuse([file, self.reference], 2, name, *words)
                self.refuse([self.model, file], 2, name, *words)
        for path, words in [(self.path('nowhere.gml'), ['no such file']), (self.path('empty'), ['no model', 'CityGML']),
                            (self.path('letters'), ['no model'])]:
            with self.subTest(path):
                self.refuse([path, self.reference], 2, path, *words)
                self.refuse([self.model, path], 2, path, *words)

    def test_unknown_crs_of_the_reference(self):
        unknown = self.place('unknown.gml', city(*[b.replace('25832', '99999') for b in street(2)], srs='EPSG:99999'))
        self.refuse([self.model, unknown], 2, 'unknown.gml', 'EPSG:99999', '--reference-crs')

    def test_no_crs_at_all(self):
        silent = self.place('silent.gml', re.sub(r' srsName="[^"]*"', '', city(*street(6))))
        self.refuse([self.model, silent], 2, 'silent.gml', '--reference-crs')
        given = self.compare('given', self.model, silent, '--reference-crs', 'EPSG:25832')
        self.assertEqual(given['counts'], read_json(self.done, 'compare.json')['counts'])
        self.assertEqual(given['summary'], read_json(self.done, 'compare.json')['summary'])

    def test_message_names_the_option_of_the_model(self):
        """What is wrong with the model is mended by the model's options, not by the reference's."""
        silent = self.place('silent2.gml', re.sub(r' srsName="[^"]*"', '', city(*street(2))))
        unknown = self.place('unknown2.gml', city(*[b.replace('25832', '99999') for b in street(2)], srs='EPSG:99999'))
        self.refuse([silent, self.reference], 2, 'silent2.gml', '--model-crs')
        self.refuse([unknown, self.reference], 2, 'unknown2.gml', '--model-crs')
        self.refuse([self.model, self.reference, '--model-crs', 'EPSG:4'], 1, '--model-crs', 'EPSG:4')

    def test_output_exists(self):
        before = hashes(self.done)
        run = blockrand('compare', self.model, self.reference, '-o', self.done)
        self.refused(run, 1, self.done, '--force')
        self.assertEqual(hashes(self.done), before)
        again = self.compare('again', self.model, self.reference)
        self.compare('again', self.reference, self.model, '--force')
        self.assertNotEqual(read_json(self.path('again'), 'compare.json'), again)
        self.compare('again', self.model, self.reference, '--force')
        self.same_files(self.done, self.path('again'))

    def test_output_is_something_else(self):
        os.makedirs(self.path('letters2'), exist_ok=True)
        letter = self.place('letters2/letter.txt', 'Dear all\n')
        run = blockrand('compare', self.model, self.reference, '-o', self.path('letters2'), '--force')
        self.refused(run, 1, 'letters2', 'compare.json', 'another')
        self.assertEqual(os.listdir(self.path('letters2')), ['letter.txt'])
        run = blockrand('compare', self.model, self.reference, '-o', letter, '--force')
        self.refused(run, 1, 'letter.txt')
        self.refused(blockrand('compare', self.model, self.reference, '-o', os.path.join(letter, 'below')), 1, 'letter.txt')
        # A build is no comparison, and the other way round.
        os.makedirs(self.path('build'), exist_ok=True)
        self.place('build/build.json', '{}')
        run = blockrand('compare', self.model, self.reference, '-o', self.path('build'), '--force')
        self.refused(run, 1, 'build', 'compare.json')

    def test_files_of_others_in_the_output_folder(self):
        self.compare('shared', self.model, self.reference)
        self.place('shared/notes.txt', 'mine')
        run = blockrand('compare', self.model, self.reference, '-o', self.path('shared'), '--force')
        self.refused(run, 1, 'notes.txt', 'did not write', 'comparison')
        self.assertTrue(os.path.exists(self.path('shared', 'notes.txt')))
        os.remove(self.path('shared', 'notes.txt'))
        self.place('shared/compare.gpkg-wal', '')
        self.compare('shared', self.model, self.reference, '--force')

    def test_output_is_looked_at_before_the_work(self):
        """As `build` does: the wrong folder is said at once, not after minutes. Told by which error comes first."""
        broken = self.place('broken2.xml', '<core:CityModel')
        run = blockrand('compare', broken, self.reference, '-o', self.done)
        self.refused(run, 1, self.done, '--force')

    def test_bad_baseline(self):
        """A baseline that is none is refused before the work, and nothing is written."""
        done = read_json(self.done, 'compare.json')
        older = dict(done, format_version=done['format_version'] + 1)
        for name, content, words in [
                ('text.json', 'Dear all', ['JSON']), ('cut.json', json.dumps(done)[:1000], ['JSON']),
                ('object.json', '{}', ['comparison']), ('list.json', '[]', ['comparison']),
                ('newer.json', json.dumps(older), ['version'])]:
            with self.subTest(name):
                self.refuse([self.model, self.reference, '--baseline', self.place(name, content)], 2, name, *words,
                            output='refused_' + name)
        self.refuse([self.model, self.reference, '--baseline', self.path('nowhere.json')], 2, 'nowhere.json', 'compare.json')

    def test_models_that_do_not_meet(self):
        """Nothing to compare is no success in silence: it is warned of."""
        far = self.place('far.gml', city(box('far', 695000, 5730000, 10, 8, 6)))
        empty = self.place('none.gml', city())
        for name, model, other in (('far', self.model, far), ('empty-model', empty, self.reference),
                                   ('empty-reference', self.model, empty)):
            with self.subTest(name):
                result = self.compare(name, model, other)
                self.assertEqual(result['counts']['matches'], 0)
                self.assertIn('warning', self.last.err, self.last)

    def test_without_output(self):
        """Tables on the terminal alone; --json prints what compare.json would hold; -q nothing."""
        before = sorted(os.listdir(self.folder))
        run = blockrand('compare', self.model, self.reference, '--progress', 'none')
        self.assertEqual(run.code, 0, run)
        for word in ('footprint IoU', 'ridge height error', 'matched', 'left out', 'offset'):
            self.assertIn(word, run.out)
        run = blockrand('compare', self.model, self.reference, '--json', '--progress', 'none')
        with open(os.path.join(self.done, 'compare.json'), encoding='utf-8') as f:
            self.assertEqual((run.code, run.out), (0, f.read()))
        run = blockrand('compare', self.model, self.reference, '-q')
        self.assertEqual((run.code, run.out), (0, ''), run)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_gate(self):
        worse = self.place('worse.gml', city(*street(6, 1.0)))
        baseline = ['--baseline', os.path.join(self.done, 'compare.json')]
        shown = blockrand('compare', worse, self.reference, *baseline, '--progress', 'none')
        self.assertEqual(shown.code, 0, 'without --fail-if-worse it is shown only')
        self.assertIn('ridge_error', verdict(shown.out))
        failed = blockrand('compare', worse, self.reference, *baseline, '--fail-if-worse', '2%', '--progress', 'none')
        self.assertEqual(failed.code, 3, failed)
        self.assertTrue({'ridge_error', 'footprint_iou', 'volume_ratio'} <= set(verdict(failed.out)), failed)
        self.assertIn('worse than', failed.err)
        generous = blockrand('compare', worse, self.reference, *baseline, '--fail-if-worse', '500%', '--progress', 'none')
        self.assertEqual(generous.code, 0, generous)
        same = blockrand('compare', self.model, self.reference, *baseline, '--fail-if-worse', '0%', '--progress', 'none')
        self.assertEqual(same.code, 0, same)
        better = blockrand('compare', self.reference, self.reference, *baseline, '--fail-if-worse', '0%', '--progress', 'none')
        self.assertEqual(better.code, 0, better)
        fewer = self.place('fewer.gml', city(*street(6)[:5]))
        lost = blockrand('compare', fewer, self.reference, *baseline, '--fail-if-worse', '2%', '--progress', 'none')
        self.assertEqual(lost.code, 3, 'leaving a building out must not pass as progress')
        self.assertIn('B005', lost.out)

    def test_gate_names_the_measure_when_quiet(self):
        """In a job's log with --quiet the error alone is left: it must say what became worse."""
        worse = self.place('worse2.gml', city(*street(6, 1.0)))
        run = blockrand('compare', worse, self.reference, '-q', '--baseline', os.path.join(self.done, 'compare.json'),
                        '--fail-if-worse', '2%')
        self.assertEqual((run.code, run.out), (3, ''), run)
        self.assertRegex(run.err, 'ridge_error|ridge height error', run)

    def test_values_of_boxes(self):
        """Each box of the model is 0.5 m longer to the east and 0.5 m higher: what that makes can be worked out."""
        for i, match in enumerate(read_json(self.done, 'compare.json')['matches']):
            depth, height = 8 + i % 3, 6 + i % 4
            expected = {'footprint_iou': 10 / 10.5, 'area_ratio': 1.05, 'outline_distance': 0.5, 'offset_east': 0.25,
                        'offset_north': 0, 'ridge_error': 0.5, 'eaves_error': 0.5, 'distance_max': 0.5 * 2 ** 0.5,
                        'volume_ratio': 1.05 * (height + 0.5) / height, 'roof_type_agrees': 1, 'valid_model': 1}
            for measure, value in expected.items():
                with self.subTest(f'{match["id"]}: {measure}'):
                    self.assertAlmostEqual(match['measures'][measure]['counted'], value, delta=1e-3)
            self.assertAlmostEqual(match['reference']['footprint_area'], 10 * depth, delta=1e-3)

    def test_fzk_house(self):
        """By hand: 10 x 5 m, eaves 3 m, ridge 5 m, 200 m3; its LoD1 is a block of 4 m."""
        if not reference('fzk-haus'):
            self.skipTest('the hand-built models of ../shared/data/reference are absent')
        files = [reference('fzk-haus', f'Building_LOD{i}-EPSG25832.gml') for i in (1, 2, 3)]
        one, two, itself = (self.compare(f'fzk{i + 1}', files[i], files[2]) for i in range(3))
        two_one = self.compare('fzk12', files[0], files[1])
        for result in (one, two, itself, two_one):
            self.assertEqual({k: result['counts'][k] for k in ('matches', 'missing', 'extra')},
                             {'matches': 1, 'missing': 0, 'extra': 0})
            self.assertEqual(result['heights'], 'absolute')
            self.assertAlmostEqual(result['matches'][0]['reference']['footprint_area'], 50, delta=1e-3)
            for side in ('model', 'reference'):
                self.assertAlmostEqual(result['matches'][0][side]['ground'], 112, delta=1e-3)
            for measure, ideal in {'footprint_iou': 1, 'area_ratio': 1, 'offset_east': 0, 'base_error': 0}.items():
                self.assertAlmostEqual(headline(result, measure), ideal, delta=1e-6)
        facts = two['matches'][0]['model']
        self.assertEqual([round(facts[k], 3) for k in ('eaves', 'ridge', 'volume')], [3, 5, 200])
        self.assertEqual(facts['roof_form'], 'gabled')
        facts = one['matches'][0]['model']
        self.assertEqual([round(facts[k], 3) for k in ('eaves', 'ridge', 'volume')], [4, 4, 200])
        for result in (one, two_one):
            self.assertAlmostEqual(result['summary']['eaves_error']['counted']['mean'], 1, delta=1e-3)
            self.assertAlmostEqual(result['summary']['ridge_error']['counted']['mean'], -1, delta=1e-3)
            self.assertEqual(headline(result, 'roof_type_agrees'), 0)
        self.assertAlmostEqual(headline(two_one, 'volume_ratio'), 1, delta=1e-6)
        for measure in ('eaves_error', 'ridge_error', 'roof_pitch_error'):
            self.assertAlmostEqual(headline(two, measure), 0, delta=1e-3)
        for measure in ('distance_mean', 'distance_rms', 'normal_deviation'):
            self.assertGreater(headline(one, measure), 3 * headline(two, measure))
            self.assertAlmostEqual(headline(itself, measure), 0, delta=1e-4)
        for result, openings in ((one, 0), (two, 0), (itself, 1)):
            self.assertEqual(headline(result, 'opening_recall'), openings)
        self.ideal(itself, 1e-4, but=('valid_model',))
        # The KIT's own house, LoD2 against LoD3: with overhanging eaves on neither, footprint and ridge alike.
        kit = [reference('fzk-haus', f'FZK-House-LoD{i}-KIT-IAI-KHH-V2.gml') for i in (2, 3)]
        house = self.compare('kit', *kit)
        self.assertEqual(house['counts']['matches'], 1)
        for measure in ('eaves_error', 'ridge_error', 'offset_east', 'offset_north'):
            self.assertLess(headline(house, measure), 0.01)
        self.assertGreater(headline(house, 'footprint_iou'), 0.99)
        table('FZK house', {'LoD1 - LoD3': one, 'LoD2 - LoD3': two, 'LoD1 - LoD2': two_one, 'KIT LoD2 - LoD3': house})


class Files(CompareTest):
    """compare.json, .csv, .gpkg and .html of one comparison with everything in it: matches of several houses, missing
    and extra buildings, names that want to be quoted."""

    NAMES = ['plain', 'with space', 'a,b', 'umlaut-Ä', 'quote"s', 'angle<b>&amp']

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        self = cls()
        quoted = [n.replace('&', '&amp;').replace('<', '&lt;').replace('"', '&quot;') for n in cls.NAMES]
        rows = [box(n, 690000 + 15 * i, 5730000, 10, 8, 6) for i, n in enumerate(quoted)]
        cls.reference = self.place('reference.gml', city(*rows, box('missing', 690000, 5730030, 8, 8, 5),
                                                         box('block', 690030, 5730030, 20, 10, 9)))
        cls.model = self.place('model.gml', city(*street(6, 0.3), box('left', 690030, 5730030, 10, 10, 9),
                                                 box('right', 690040, 5730030, 10, 10, 9),
                                                 box('extra', 690060, 5730030, 8, 8, 5)))
        cls.result = self.compare('all', cls.model, cls.reference, '--pictures', 3)
        cls.out = self.path('all')

    def read(self, name):
        with open(os.path.join(self.out, name), encoding='utf-8', newline='') as f:
            return f.read()

    def test_json(self):
        self.assertEqual((self.result['format'], self.result['format_version']), ('blockrand-compare', 1))
        # In this order, so that the rest is looked at even where a name is read wrongly.
        self.assertEqual([b['id'] for b in self.result['missing']], ['missing'])
        self.assertEqual([b['id'] for b in self.result['extra']], ['extra'])
        block = next(m for m in self.result['matches'] if m['id'] == 'block')
        self.assertEqual(block['model']['buildings'], ['left', 'right'])
        self.assertEqual(set(block['measures']), set(self.result['summary']))
        text = self.read('compare.json')
        self.assertNotIn(self.folder + '/all', text)  # where it was written to, and when, does not matter
        self.assertNotRegex(text, r'NaN|Infinity')
        self.assertEqual({m['id'] for m in self.result['matches']}, set(self.NAMES) | {'block'})

    def test_csv(self):
        import csv
        rows = list(csv.reader(self.read('compare.csv').splitlines()))
        self.assertTrue(all(len(r) == len(rows[0]) for r in rows))
        self.assertEqual([r[0] for r in rows[1:]], [m['id'] for m in self.result['matches']])
        for row, match in zip(rows[1:], self.result['matches']):
            for measure, value in match['measures'].items():
                for name, part in ((measure, 'counted'), (measure + '_all', 'all')):
                    cell = row[rows[0].index(name)]
                    self.assertEqual(float(cell) if cell else None, value[part], f'{match["id"]}: {name}')

    def test_geopackage(self):
        with sqlite3.connect(os.path.join(self.out, 'compare.gpkg')) as db:
            self.assertEqual(db.execute('PRAGMA integrity_check').fetchone(), ('ok',))
            layers = {row[0]: row[1] for row in db.execute('SELECT table_name, srs_id FROM gpkg_contents')}
            self.assertEqual(set(layers), {'matches', 'model', 'reference'})
            self.assertEqual(set(layers.values()), {25832})
            columns = [row[1] for row in db.execute('PRAGMA table_info(matches)')]
            for measure in self.result['summary']:
                self.assertIn(measure, columns)
            rows = {row[0]: row[1:] for row in db.execute('SELECT id, footprint_iou, ridge_error FROM matches')}
            self.assertEqual(set(rows), {m['id'] for m in self.result['matches']})
            for match in self.result['matches']:
                expected = tuple(match['measures'][m]['counted'] for m in ('footprint_iou', 'ridge_error'))
                self.assertEqual(rows[match['id']], expected, match['id'])
            for layer, count in (('model', 9), ('reference', 8)):
                self.assertEqual(db.execute(f'SELECT count(*) FROM {layer}').fetchone(), (count,))

    def test_page(self):
        text = self.read('compare.html')
        ElementTree.fromstring(text.partition('>')[2])  # well-formed XML below the document type

        class Reader(html.parser.HTMLParser):
            ids, links, sources, words = [], [], [], []

            def handle_starttag(self, tag, attributes):
                for name, value in attributes:
                    if name == 'id':
                        self.ids.append(value)
                    elif name in ('href', 'src', 'xlink:href', 'srcset', 'data', 'poster', 'action'):
                        (self.links if tag == 'a' else self.sources).append(value)

            def handle_data(self, data):
                self.words.append(data)
        reader = Reader()
        reader.feed(text)
        self.assertEqual(len(reader.ids), len(set(reader.ids)), 'an id stands twice')
        for source in reader.sources:
            self.assertRegex(source, r'^(data:|#)', 'the page needs nothing else')
        for link in reader.links:
            self.assertTrue(link.startswith('#') and link[1:] in reader.ids, f'leads nowhere: {link}')
        self.assertNotRegex(text, r'@import|url\((?!["\']?(data:|#))')
        self.assertNotRegex(text, r'https?://(?!www\.w3\.org/)')
        words = ' '.join(reader.words)
        for match in self.result['matches']:
            self.assertIn(match['id'], words)
        for name in ('missing', 'extra'):
            self.assertIn(name, words)
        self.assertGreaterEqual(text.count('data:image/png'), 3, 'pictures')


class Sameness(CompareTest):
    """The same input gives the same bytes, and how it is cut into files gives the same measures."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.berlin = reference('berlin-lod2', 'Berlin1b_3920_5820.gml')
        cls.fzk = reference('fzk-haus', 'FZK-House-LoD3-KIT-IAI-KHH-V2.gml')
        if not cls.berlin or not cls.fzk:
            raise unittest.SkipTest('the hand-built models of ../shared/data/reference are absent')

    def test_threads_and_repetition(self):
        low = reference('fzk-haus', 'FZK-House-LoD2-KIT-IAI-KHH-V2.gml')
        for name, model, other in (('fzk', low, self.fzk), ('berlin', self.berlin, self.berlin)):
            with self.subTest(name):
                self.compare(name + '1', model, other, '-j', 1, '--pictures', 5)
                self.compare(name + '2', model, other, '-j', 2, '--pictures', 5)
                self.compare(name + '3', model, other, '-j', 2, '--pictures', 5)
                self.same_files(self.path(name + '1'), self.path(name + '2'))
                self.same_files(self.path(name + '2'), self.path(name + '3'))

    def test_seed_matters_little(self):
        """Another seed samples other places: distances stay, within what sampling can tell."""
        low = reference('fzk-haus', 'FZK-House-LoD2-KIT-IAI-KHH-V2.gml')
        a, b = (self.compare(f'seed{s}', low, self.fzk, '--seed', s) for s in (1, 2))
        self.same(a, b, 'distance_mean', 0.01)
        self.same(a, b, 'footprint_iou', 0)

    def test_triangles_or_rectangles(self):
        """How surfaces are cut into polygons changes nothing but the numbers of triangles' polygons; places of samples
        may differ, distances by a few millimetres."""
        other = self.place('street.gml', city(*street(6)))
        a, b = (self.compare(f'cut{cut}', self.place(f'cut{cut}.gml', city(*street(6, 0.5, cut))), other)
                for cut in (False, True))
        for measure, summary in a['summary'].items():
            with self.subTest(measure):
                tolerance = {'m': 0.01, 'deg': 0.5, '1': 0.01}[summary['unit']] if summary['scope'] == 'surface' else 1e-6
                self.same(a, b, measure, tolerance)

    def test_symmetry(self):
        """Model and reference exchanged: distances (with all surfaces) the same, errors with the other sign."""
        low = reference('fzk-haus', 'FZK-House-LoD2-KIT-IAI-KHH-V2.gml')
        block = self.place('block.gml', city(*street(6, 0.5)))
        other = self.place('other.gml', city(*street(6)))
        for name, a, b in (('boxes', block, other), ('kit', low, self.fzk)):
            forth, back = self.compare(name + '_forth', a, b), self.compare(name + '_back', b, a)
            pairs = {m: m for m, s in forth['summary'].items()
                     if s['better'] in ('higher', 'lower') and s['scope'] in ('plan', 'body', 'surface')}
            pairs.update({'to_reference_mean': 'to_model_mean', 'to_model_mean': 'to_reference_mean'})
            pairs.update({f'completeness_{d}': f'correctness_{d}' for d in ('025', '050', '100')})
            pairs.update({f'correctness_{d}': f'completeness_{d}' for d in ('025', '050', '100')})
            pairs.update({'valid_model': 'valid_reference', 'semantic_model': 'semantic_reference'})
            for measure, opposite in pairs.items():
                with self.subTest(f'{name}: {measure}'):
                    first, second = headline(forth, measure, 'all'), headline(back, opposite, 'all')
                    self.assertAlmostEqual(first, second, delta=1e-3)
            for measure in ('eaves_error', 'ridge_error', 'offset_east', 'offset_north'):
                first, second = (r['summary'][measure]['all']['mean'] for r in (forth, back))
                self.assertAlmostEqual(first, -second, delta=1e-6)
            for measure in ('area_ratio', 'volume_ratio'):
                for first, second in zip(forth['matches'], back['matches']):
                    self.assertAlmostEqual(first['measures'][measure]['all'] * second['measures'][measure]['all'], 1, delta=1e-6)

    def split(self, path, pieces):
        """The buildings of a CityGML file dealt out to several."""
        files = []
        for k in range(pieces):
            tree = ElementTree.parse(path)
            members = descendants(tree.getroot(), 'cityObjectMember')
            for i, member in enumerate(members):
                if i % pieces != k:
                    tree.getroot().remove(member)
            files.append(self.path(f'piece{pieces}_{k}.gml'))
            tree.write(files[-1], encoding='UTF-8', xml_declaration=True)
        return files

    def test_order_and_cut_of_files(self):
        whole = self.compare('whole', self.berlin, self.berlin)
        self.assertGreater(whole['counts']['matches'], 3)
        pieces = self.split(self.berlin, 2)
        os.makedirs(self.path('tiled'), exist_ok=True)
        for piece in pieces:
            os.link(piece, self.path('tiled', os.path.basename(piece)))
        for name, model, others in [('cut', self.berlin, pieces), ('turned', self.berlin, pieces[::-1]),
                                    ('both', self.path('tiled'), pieces), ('folder', self.path('tiled'), [self.berlin]),
                                    ('twice', self.berlin, [pieces[0], self.berlin, pieces[1]])]:
            with self.subTest(name):
                result = self.compare(name, model, *others)
                self.assertEqual(measured(result), measured(whole))
                self.assertEqual(sha256(self.path(name, 'compare.csv')), sha256(self.path('whole', 'compare.csv')))


class Interrupted(CompareTest):
    """A comparison that does not end well leaves the earlier one as it was, and nothing beside it."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        self = cls()
        cls.model = self.place('model.gml', city(*street(400, 0.5)))
        cls.reference = self.place('reference.gml', city(*street(400)))
        self.compare('out', cls.reference, cls.reference, '--samples', 100)
        cls.before = hashes(self.path('out'))

    def test_signals(self):
        for number, staged in ((signal.SIGINT, False), (signal.SIGTERM, True)):
            with self.subTest(number.name):
                process = subprocess.Popen([Setup.program, 'compare', self.model, self.reference, '-o', self.path('out'),
                                            '--force', '--progress', 'none'], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                if staged:
                    while process.poll() is None and not staging_of(self.path('out')):
                        time.sleep(0.001)
                else:
                    time.sleep(0.3)
                process.send_signal(number)
                _, err = process.communicate(timeout=120)
                self.assertEqual(process.returncode, 128 + number, err.decode())
                self.assertEqual(hashes(self.path('out')), self.before)
                self.assertEqual(stray_siblings(self.path('out')), [])

    def test_full_disk(self):
        with small_disk(self.path('disk'), 'size=200k') as disk:
            target = os.path.join(disk, 'out')
            run = blockrand('compare', self.model, self.reference, '-o', target, '--progress', 'none')
            self.refused(run, 4, 'full', target=target)

    def test_stdout_that_is_full(self):
        with open('/dev/full', 'wb') as full:
            done = subprocess.run([Setup.program, 'compare', self.model, self.reference, '--samples', '100'],
                                  stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 4, done.stderr)


if __name__ == '__main__':
    main()
