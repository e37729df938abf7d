"""report.html: well-formed, complete, loading nothing, and in step with build.json and report.json."""
import base64
import os
import re
import shutil
import struct
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

from blockrand_run import SAMPLE, BuildTest, call, extract, main, read_json, sha256
from osm_files import Node, Way, write_xml

HTML = '{http://www.w3.org/1999/xhtml}'
SVG = '{http://www.w3.org/2000/svg}'
LISTED = 300  # ReportOptions::listed_objects
MAP_BYTES = 8_000_000  # ReportOptions::map_bytes
PNG_SIGNATURE = b'\x89PNG\r\n\x1a\n'
HOSTILE = '</title></svg><script>alert(1)</script><img src=x onerror="alert(2)">\'&amp;]]>'


class Page:
    """The page as a tree; parsing it as XML is the test of its form."""

    def __init__(self, folder):
        self.path = os.path.join(folder, 'report.html')
        with open(self.path, encoding='utf-8') as f:
            self.text = f.read()
        self.root = ElementTree.fromstring(self.text)
        self.ids = [e.get('id') for e in self.root.iter() if e.get('id')]

    def all(self, tag, **attributes):
        return [e for e in self.root.iter(tag) if all(e.get(k.rstrip('_')) == v for k, v in attributes.items())]

    def by_id(self, name):
        return next(e for e in self.root.iter() if e.get('id') == name)

    def rows(self, name):
        """The list entries of one code, or of one state."""
        found = [e for e in self.all(HTML + 'details') if e.get('id') == name]
        return found[0].findall(f'.//{HTML}li') if found else []

    def number(self, element):
        return int(''.join(element.itertext()).replace(',', ''))


def png_faults(data):
    """What is wrong with a PNG: chunks, checksums, size of the pixel data; a picture of one colour is wrong, too."""
    if data[:8] != PNG_SIGNATURE:
        return 'no PNG signature'
    at, chunks = 8, []
    while at < len(data):
        length, = struct.unpack('>I', data[at:at + 4])
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + length]
        crc, = struct.unpack('>I', data[at + 8 + length:at + 12 + length])
        if zlib.crc32(kind + body) != crc:
            return f'checksum of {kind}'
        chunks.append((kind, body))
        at += 12 + length
    kinds = [kind for kind, _ in chunks]
    if kinds[0] != b'IHDR' or kinds[-1] != b'IEND' or b'tIME' in kinds:
        return f'chunks {kinds}'
    width, height, depth, colour = struct.unpack('>IIBB', chunks[0][1][:10])
    pixels = zlib.decompress(b''.join(body for kind, body in chunks if kind == b'IDAT'))
    samples = {2: 3, 3: 1}.get(colour, 0)  # a colour of its own, or one of a palette
    if colour == 3 and not 0 < len(chunks[kinds.index(b'PLTE')][1]) <= 3 * 256:
        return 'palette'
    if depth != 8 or len(pixels) != height * (1 + samples * width):
        return f'{len(pixels)} bytes of pixels for {width} x {height}'
    if len(set(pixels)) < 30:
        return 'nothing is to be seen'
    return ''


def browser(page, *options):
    """Headless Chromium over a page; its messages are in .err. Skips where there is none."""
    tool = shutil.which('chromium') or shutil.which('chromium-browser')
    if not tool:
        raise unittest.SkipTest('chromium is not installed')
    with tempfile.TemporaryDirectory() as profile:
        return call([tool, '--headless', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--disable-background-networking',
                     '--no-first-run', f'--user-data-dir={profile}', '--enable-logging=stderr', '--v=0', *options,
                     'file://' + os.path.abspath(page)], timeout=300)


class PageTest(BuildTest):
    """What holds for the page of any build."""

    def page_is_sound(self, folder):
        page = Page(folder)
        build, report = read_json(folder, 'build.json'), read_json(folder, 'report.json')
        self.assertEqual(build['files']['report.html']['sha256'], sha256(page.path))
        self.loads_nothing(page)
        self.links_lead_somewhere(page, folder)
        self.counts_agree(page, build)
        self.rows_are_listed(page, build, report)
        self.map_agrees(page, build)
        self.pictures_are_pictures(page)
        return page

    def loads_nothing(self, page):
        """Nothing but links leads out of the page, and those only when they are clicked."""
        for element in page.root.iter():
            tag = element.tag.split('}')[-1]
            self.assertNotIn(tag, ('iframe', 'object', 'embed', 'base', 'form', 'image', 'use', 'video', 'audio', 'source'))
            for name, value in element.attrib.items():
                name = name.split('}')[-1]
                self.assertFalse(name.startswith('on'), f'<{tag} {name}>')
                if re.search(r'https?:|^//', value[:1000]) and name not in ('alt', 'aria-label'):
                    self.assertEqual((tag, name), ('a', 'href'), value[:80])
                if name == 'src':
                    self.assertTrue(value.startswith('data:'), value[:80])
        for style in page.all(HTML + 'style'):
            self.assertNotRegex(style.text, r'url\(|@import|https?:')
        scripts = [s for s in page.all(HTML + 'script') if s.get('type') != 'application/json']
        # The page's own, and the one that unpacks the model where it carries one: from what stands in the page.
        model = [s for s in scripts if 'viewer-files' in s.text]
        self.assertEqual(len(model), len([s for s in page.all(HTML + 'script') if s.get('id') == 'blockrand-embedded']))
        scripts = [s for s in scripts if s not in model]
        self.assertEqual(len(scripts), 1)
        for script in model:
            self.assertNotRegex(script.text, r'fetch|XMLHttp|import|https?:')
        # A link to a house's page at openstreetmap.org is made when it is asked for.
        self.assertNotRegex(scripts[0].text.replace("'https://www.openstreetmap.org/'", '').replace("'http://www.w3.org/2000/svg'", ''),
                            r'fetch|XMLHttp|import|https?:')

    def links_lead_somewhere(self, page, folder):
        ids = set(page.ids)
        self.assertEqual(len(ids), len(page.ids), 'an id stands twice')
        for tag in (HTML + 'a', SVG + 'a'):
            for link in page.all(tag):
                href = link.get('href')
                if href.startswith('#'):
                    self.assertIn(href[1:], ids)
                elif not href.startswith('https://www.openstreetmap.org/'):
                    # run.json is written after the page.
                    self.assertTrue(os.path.exists(os.path.join(folder, href)), href)

    def counts_agree(self, page, build):
        counts = build['counts']
        shown = [page.number(b) for b in page.all(HTML + 'b')[:4]]
        self.assertEqual(shown, [counts['buildings_in'] + counts['parts_in'], counts['models'], counts['represented'],
                                 counts['reported']])
        text = ' '.join(page.by_id('statistics').itertext())
        self.assertIn(f"{counts_of(build['statistics']['party_walls'])}", text)
        for roof, n in build['statistics']['roofs'].items():
            self.assertRegex(text, rf"(?i){roof.replace('_', ' ')}\s*{counts_of(n)}")
        # One bar for every attribute, and together its parts are all of it.
        bars = [bar for table in page.all(HTML + 'table', class_='sources') for bar in table.iter(SVG + 'svg')]
        self.assertEqual(len(bars), len(build['statistics']['sources']))
        for bar in bars:
            self.assertEqual(sum(int(r.get('width')) for r in bar.findall(SVG + 'rect')), 10000)
        shares = sorted(sorted(int(n.replace(',', '')) for n in re.findall(r' ([\d,]+) \(', bar.get('aria-label'))) for bar in bars)
        self.assertEqual(shares, sorted(sorted(by.values()) for by in build['statistics']['sources'].values()))
        self.styles_agree(page)

    def styles_agree(self, page):
        """Classes and eras count the same buildings; a bar is as long as its row's share."""
        tables = page.all(HTML + 'table', class_='sources styles')
        self.assertEqual(len(tables), 2)
        totals = set()
        for table in tables:
            rows = table.find(HTML + 'tbody').findall(HTML + 'tr')
            counts = [int(row.find(HTML + "td[@class='n']").text.strip().replace(',', '')) for row in rows]
            totals.add(sum(counts))
            for row, n in zip(rows, counts):
                bar = row.find('.//' + SVG + 'svg')
                self.assertEqual(sum(int(r.get('width')) for r in bar.findall(SVG + 'rect')), n * 10000 // sum(counts))
                self.assertEqual(sum(int(c.replace(',', '')) for c in re.findall(r' ([\d,]+) \(', bar.get('aria-label'))), n)
        self.assertEqual(len(totals), 1, totals)

    def rows_are_listed(self, page, build, report):
        wanted = {}
        for row in [r for r in report['objects'] if r['state'] == 'reported'] + report['fallbacks'] + report['notices']:
            wanted.setdefault('code-' + row['code'], []).append(row)
        for row in report['objects']:
            if row['state'] != 'reported':
                wanted.setdefault('objects-' + row['state'], []).append(row)
        shown = {e.get('id') for e in page.all(HTML + 'details', class_='code')}
        self.assertEqual(shown, set(wanted))
        for name, rows in wanted.items():
            count = page.number(next(e for e in page.by_id(name).iter(HTML + 'span') if e.get('class') == 'count'))
            self.assertEqual(count, len(rows), name)
            if name.startswith('code-'):
                self.assertEqual(count, build['issues'][name[5:]])
            items = page.rows(name)
            self.assertEqual(len(items), min(len(rows), LISTED), name)
            if len(rows) > LISTED:
                self.assertIn('report.json', ' '.join(page.by_id(name).itertext()))
                continue
            texts = sorted(''.join(item.itertext()).split()[0] for item in items)
            self.assertEqual(texts, sorted(row['id'] for row in rows), name)
            kinds = {'n': 'node', 'w': 'way', 'r': 'relation'}
            links = {a.get('href') for item in items for a in item.findall(HTML + 'a')}
            for row in rows:
                if not row['id'][1:].startswith('-'):
                    self.assertIn(f"https://www.openstreetmap.org/{kinds[row['id'][0]]}/{row['id'][1:]}", links)

    def map_agrees(self, page, build):
        groups = [g for g in page.all(SVG + 'g') if (g.get('class') or '').startswith('footprints')]
        if not groups:
            return
        paths = groups[0].findall(f'.//{SVG}path')
        self.assertLessEqual(sum(len(p.get('d')) for p in paths), MAP_BYTES)
        for path in paths:
            self.assertRegex(path.get('class'), r'^a\d e\d s\d r\d q\d+ h\d+ k\d+ i\d$')
            self.assertRegex(path.get('d'), r'^M[-\d ]+l[-\d mz]*z$')
        # Each theme's legend counts the same buildings.
        sums = {}
        for legend in page.all(HTML + 'ul'):
            if 'legend' in (legend.get('class') or ''):
                sums[legend.get('class')] = sum(page.number(b) for b in legend.iter(HTML + 'b'))
        self.assertIn(len(sums), (6, 8))
        self.assertEqual(len(set(sums.values())), 1, sums)
        if any(p.get('id') for p in paths):
            left_out = re.findall(r'([\d,]+) buildings? (?:lies?|has|have) ', ' '.join(page.by_id('map').itertext()))
            self.assertEqual(len(paths) + sum(int(n.replace(',', '')) for n in left_out), next(iter(sums.values())),
                             'a footprint for every building')

    def pictures_are_pictures(self, page):
        images = page.all(HTML + 'img')
        self.assertEqual(len(images), 4, 'three views and the plan')
        for image in images:
            self.assertTrue(image.get('alt'))
            data = base64.b64decode(image.get('src').removeprefix('data:image/png;base64,'), validate=True)
            self.assertEqual(png_faults(data), '')
            width, height = struct.unpack('>II', data[16:24])
            self.assertEqual((str(width), str(height)), (image.get('width'), image.get('height')))

    def browser_is_content(self, page):
        """No message of the page's own, and its script ran: the zoom buttons are there."""
        run = browser(page.path, '--dump-dom')
        self.assertEqual(run.code, 0, run)
        self.assertEqual([line for line in run.err.splitlines() if 'CONSOLE' in line], [])
        self.assertIn('class="zoom"', run.out, 'the script did not run')


def counts_of(n):
    return f'{n:,}'


class Sample(PageTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'out', '--jobs', '2')

    def test_page(self):
        page = self.page_is_sound(self.out)
        self.assertIn(os.path.splitext(os.path.basename(SAMPLE))[0], page.all(HTML + 'h1')[0].text)

    def test_browser(self):
        self.browser_is_content(Page(self.out))

    def test_same_bytes_for_any_number_of_threads(self):
        other = self.build(SAMPLE, 'one', '--jobs', '1')
        self.assertEqual(sha256(os.path.join(self.out, 'report.html')), sha256(os.path.join(other, 'report.html')))

    def test_footprints_only(self):
        """LoD 0 has no bodies to picture, but a plan; the page is there all the same."""
        folder = self.build(SAMPLE, 'lod0', '--lod', '0')
        page = Page(folder)
        self.loads_nothing(page)
        self.links_lead_somewhere(page, folder)
        self.assertEqual(len(page.all(HTML + 'img')), 1, 'the plan')
        self.assertGreater(len(page.all(SVG + 'path')), 100)


class Hostile(PageTest):
    def test_tag_text_stays_text(self):
        corners = [(13.4, 52.5), (13.4002, 52.5), (13.4002, 52.5001), (13.4, 52.5001)]
        nodes = [Node(i + 1, lon, lat, {}) for i, (lon, lat) in enumerate(corners)]
        way = Way(10, [1, 2, 3, 4, 1], {'building': 'yes', 'name': HOSTILE, 'building:levels': HOSTILE, 'height': '9',
                                        'roof:shape': HOSTILE, 'building:colour': HOSTILE})
        source = self.path('<b>evil & co.osm')
        write_xml(source, nodes + [way])
        folder = self.build(source, 'out')
        page = self.page_is_sound(folder)
        self.assertNotIn('<script>alert', page.text)
        self.assertIn(HOSTILE, page.by_id('w10').find(SVG + 'title').text)
        self.assertIn('<b>evil & co', page.all(HTML + 'h1')[0].text)
        values = ' '.join(''.join(item.itertext()) for item in page.rows('code-VALUE_UNREADABLE'))
        self.assertIn('<script>alert(1)</script>', values)
        self.browser_is_content(page)


class Empty(PageTest):
    def test_nothing_to_build(self):
        source = self.place('empty.osm', '<osm version="0.6"><node id="1" lat="52.5" lon="13.4"/></osm>')
        page = Page(self.build(source, 'out'))
        self.loads_nothing(page)
        self.assertIn('No building has a footprint.', page.text)


class RealExtracts(PageTest):
    def sound(self, name):
        source = extract(name)
        if not source:
            self.skipTest(f'{name} is not there')
        folder = self.build(source, name.split('.')[0])
        page = self.page_is_sound(folder)
        self.browser_is_content(page)

    def test_a_quarter(self):
        self.sound('berlin-zionskirchplatz-2020.osm')

    def test_a_town(self):
        self.sound('monaco-2021.osm.pbf')

    def test_the_middle_of_a_city(self):
        self.sound('berlin-mitte-2014.osm.pbf')


if __name__ == '__main__':
    main()
