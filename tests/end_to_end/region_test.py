"""A region that is rebuilt every night: updates, gates, locks, kills, rollback. The last good model stands, always."""
import copy
import gzip
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import threading
import time
import unittest

from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, extract, files_of, hashes, main, read_json
from osm_files import STAMP, Node, Relation, Way, read_xml, town, write_xml


def kind(o):
    return {Node: 'node', Way: 'way', Relation: 'relation'}[type(o)]


def key(o):
    return (('node', 'way', 'relation').index(kind(o)), o.id)


def body(o):
    """The XML of an object, as change files have it."""
    from xml.sax.saxutils import quoteattr
    common = f'id="{o.id}" version="{o.version}" timestamp="{STAMP}"'
    tags = ''.join(f'<tag k={quoteattr(k)} v={quoteattr(v)}/>' for k, v in o.tags.items())
    if isinstance(o, Node):
        return f'<node {common} lat="{o.lat:.7f}" lon="{o.lon:.7f}">{tags}</node>'
    if isinstance(o, Way):
        return f'<way {common}>' + ''.join(f'<nd ref="{r}"/>' for r in o.refs) + tags + '</way>'
    return f'<relation {common}>' + ''.join(f'<member type="{k}" ref="{i}" role={quoteattr(r)}/>' for k, i, r in o.members) + tags + '</relation>'


class Map:
    """A map that is edited: what an editor did as a change file, and the state after it as a file."""

    def __init__(self, objects):
        self.objects = {key(o): o for o in objects}
        self.changes = []

    def put(self, o):
        old = self.objects.get(key(o))
        o.version = old.version + 1 if old else 1
        self.objects[key(o)] = o
        self.changes.append(('modify' if old else 'create', copy.deepcopy(o)))

    def delete(self, o):
        self.objects.pop(key(o))
        gone = copy.deepcopy(o)
        gone.version += 1
        self.changes.append(('delete', gone))

    def edit(self, o, **values):
        o = copy.deepcopy(o)
        for name, value in values.items():
            setattr(o, name, value)
        self.put(o)

    def write_changes(self, path):
        text = '<osmChange version="0.6">\n' + ''.join(f'<{what}>{body(o)}</{what}>\n' for what, o in self.changes) + '</osmChange>\n'
        self.changes = []
        with (gzip.open if path.endswith('.gz') else open)(path, 'wb') as f:
            f.write(text.encode())
        return path

    def write(self, path):
        return write_xml(path, [self.objects[k] for k in sorted(self.objects)])

    def ways(self, tag):
        return [o for k, o in sorted(self.objects.items()) if k[0] == 1 and tag in o.tags]

    def random_edits(self, rng, count):
        for _ in range(count):
            buildings, streets = self.ways('building'), self.ways('highway')
            what = rng.choice(['move', 'move', 'delete', 'retag', 'retag', 'split', 'relation', 'street', 'drag', 'vandal'])
            b = rng.choice(buildings)
            corners = [self.objects[(0, r)] for r in dict.fromkeys(b.refs) if (0, r) in self.objects]
            if what == 'move':
                dx, dy = rng.uniform(-3e-5, 3e-5), rng.uniform(-3e-5, 3e-5)
                for n in corners:
                    self.edit(n, lon=n.lon + dx, lat=n.lat + dy)
            elif what == 'drag' and corners:
                n = rng.choice(corners)
                self.edit(n, lon=n.lon + rng.uniform(-4e-5, 4e-5))
            elif what == 'delete':
                self.delete(b)
            elif what == 'retag':
                tags = dict(b.tags, **rng.choice([{'building:levels': str(rng.randrange(1, 9))}, {'roof:shape': rng.choice(['flat', 'gabled', 'hipped'])},
                                                  {'start_date': str(rng.randrange(1850, 2020))}, {'building': 'garage'}, {'height': 'tall'}]))
                self.edit(b, tags=tags)
            elif what == 'split' and len(corners) >= 4:
                last = max(k[1] for k in self.objects if k[0] == 1) + 1
                refs = [n.id for n in corners]
                self.put(Way(last, refs[:3] + refs[:1], {'building': 'yes'}))
                self.edit(b, refs=refs[2:] + refs[:1] + refs[2:3])
            elif what == 'relation' and len(buildings) > 1:
                last = max([k[1] for k in self.objects if k[0] == 2] + [0]) + 1
                other = rng.choice(buildings)
                self.put(Relation(last, [('way', b.id, 'outer')] + ([('way', other.id, 'outer')] if other.id != b.id else []),
                                  {'type': 'multipolygon', 'building': 'yes'}))
            elif what == 'street' and streets:
                s = rng.choice(streets)
                n = self.objects.get((0, rng.choice(s.refs)))
                if n:
                    self.edit(n, lon=n.lon + rng.uniform(-1e-4, 1e-4))
            elif what == 'vandal':
                self.edit(b, tags=dict(b.tags, height='9999', **{'building:levels': '-3'}))


LIMITS_OFF = '[gates]\nmax_lost = 1000\nmax_added = 1000\nmax_simpler = 1000\nmax_height_change = 1000000\n'


class RegionTest(BuildTest):
    def region(self, name, settings=LIMITS_OFF):
        """A region with its region.toml."""
        folder = self.path(name)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
            f.write(settings)
        return folder

    def update(self, folder, *arguments, code=0, **how):
        run = blockrand('update', folder, *arguments, '--progress', 'none', **how)
        self.assertEqual(run.code, code, run)
        return run

    def current(self, folder):
        return os.path.realpath(os.path.join(folder, 'current'))

    def stands(self, folder, build):
        """What is published is this build, whole."""
        self.assertEqual(self.current(folder), os.path.realpath(os.path.join(folder, 'builds', build)))
        self.hashes_match(self.current(folder))

    def clean(self, map_, folder, *options):
        """A build of the map's state as a file that bears the region's name."""
        name = os.path.basename(folder)
        os.makedirs(self.path('clean'), exist_ok=True)
        source = map_.write(self.path('clean', name + '.osm'))
        return self.build(source, os.path.join('clean', name + '.out'), '--force', '--allow-shrink', '100', *options)


class Updates(RegionTest):
    def test_a_first_night_and_the_next_ones(self):
        folder = self.path('town')
        run = self.update(folder, SAMPLE)
        self.assertIn('build 1 is published', run.out)
        self.stands(folder, '000001')
        self.assertTrue(os.path.exists(os.path.join(folder, 'region.toml')))
        self.assertIn('up to date', self.update(folder, SAMPLE).out)
        map_ = Map(read_xml(SAMPLE))
        house = next(o for o in map_.ways('building') if 'building:levels' in o.tags)
        map_.edit(house, tags=dict(house.tags, **{'building:levels': '7'}))
        changes = map_.write_changes(self.path('one.osc.gz'))
        self.assertIn('run 2 would build', self.update(folder, changes, '--dry-run').out)
        self.stands(folder, '000001')
        run = self.update(folder, changes)
        self.stands(folder, '000002')
        told = read_json(folder, 'log', '000002.changes.json')
        row = next(a for a in told['attributes'] if a['id'] == f'w{house.id}' and a['attribute'] == 'storeys')
        self.assertEqual((row['to'], row['to_source']), ('7', 'tag'))
        self.assertIn('up to date', self.update(folder, changes).out, 'a replay is no change')
        # Files that did not change are one on disk.
        first, second = (os.path.join(folder, 'builds', n) for n in ('000001', '000002'))
        same = [os.stat(os.path.join(first, p)).st_ino == os.stat(os.path.join(second, p)).st_ino for p in files_of(second)]
        self.assertTrue(any(same) and not all(same), same)
        status = json.loads(blockrand('status', folder, '--json').out)
        self.assertEqual((status['current'], status['published']), (2, [1, 2]))
        self.assertEqual(status['last_run']['state'], 'unchanged')

    def test_updates_equal_clean_builds(self):
        """Random edits, one night after the other: every file but run.json is that of a clean build."""
        rng = random.Random(5)
        folder, map_ = self.region('edited', LIMITS_OFF + '[region]\nkeep = 2\n'), Map(read_xml(SAMPLE))
        self.update(folder, map_.write(self.path('begin.osm')))
        for night in range(8):
            map_.random_edits(rng, rng.choice([1, 3, 20]))
            self.update(folder, map_.write_changes(self.path(f'night{night}.osc')))
            self.same_files(self.current(folder), self.clean(map_, folder))
        self.assertEqual(len(os.listdir(os.path.join(folder, 'builds'))), 2, 'keep = 2')
        # Another road to the same data: a full extract into a fresh region.
        other = self.region(os.path.join('other', 'edited'))
        self.update(other, map_.write(self.path('whole.osm')))
        self.same_files(self.current(folder), self.current(other))

    def test_facades_and_all_formats(self):
        rng = random.Random(9)
        options = ['--lod', '3']
        folder, map_ = self.region('facades', LIMITS_OFF + '[build]\nlod = 3\n'), Map(read_xml(SAMPLE))
        self.update(folder, map_.write(self.path('begin3.osm')))
        map_.random_edits(rng, 12)
        self.update(folder, map_.write_changes(self.path('night3.osc')))
        self.same_files(self.current(folder), self.clean(map_, folder, *options))
        self.assertEqual(blockrand('validate', self.current(folder)).code, 0)

    def test_a_real_quarter(self):
        source = extract('berlin-zionskirchplatz-2020.osm')
        if not source:
            self.skipTest('the shared data is absent')
        rng = random.Random(3)
        folder, map_ = self.region('zion', LIMITS_OFF), Map(read_xml(source))
        self.update(folder, map_.write(self.path('zion.osm')))
        map_.random_edits(rng, 30)
        self.update(folder, map_.write_changes(self.path('zion.osc')))
        self.same_files(self.current(folder), self.clean(map_, folder))

    def test_a_replication_folder(self):
        map_, server = Map(read_xml(SAMPLE)), self.path('server')

        def offer(number):
            place = os.path.join(server, '000', f'{number // 1000:03}')
            os.makedirs(place, exist_ok=True)
            map_.random_edits(random.Random(number), 2)
            map_.write_changes(os.path.join(place, f'{number % 1000:03}.osc.gz'))
            for path in (os.path.join(place, f'{number % 1000:03}.state.txt'), os.path.join(server, 'state.txt')):
                with open(path, 'w', encoding='utf-8') as f:
                    f.write(f'#Thu\nsequenceNumber={number}\ntimestamp=2026-11-{number - 4120:02}T20\\:21\\:22Z\n')
        offer(4123)
        folder = self.region('nightly', LIMITS_OFF + '[region]\nreplication = "../server"\nfirst_sequence = 4123\n')
        run = blockrand('update', folder)
        self.refused(run, 1, 'no data yet')
        begin = write_xml(self.path('begin_r.osm'), read_xml(SAMPLE))
        self.update(folder, begin)
        self.update(folder)
        self.assertEqual(read_json(folder, 'store', '000002.json')['sequence'], 4123)
        self.assertIn('up to date', self.update(folder).out)
        for number in (4124, 4125, 4126):  # a missed week
            offer(number)
        self.assertIn('wait: 3', blockrand('status', folder).out)
        self.update(folder)
        self.assertEqual(read_json(folder, 'store', '000003.json')['sequence'], 4126)
        self.same_files(self.current(folder), self.clean(map_, folder))
        with open(os.path.join(server, 'state.txt'), 'r+', encoding='utf-8') as f:
            text = f.read()
            f.seek(0), f.truncate(), f.write(text.replace('4126', '41'))
        self.refused(blockrand('update', folder), 2, 'is behind')
        offer(4127), offer(4128)
        os.remove(os.path.join(server, '000', '004', '127.osc.gz'))
        run = self.update(folder, code=2)
        self.refused(run, 2, 'sequence 4127', '127.osc.gz')
        self.stands(folder, '000003')
        self.assertIn('the next run will fail', blockrand('status', folder).out)


class Gates(RegionTest):
    def test_a_vandalised_map_is_not_published(self):
        folder, map_ = self.region('guarded', ''), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        before = hashes(self.current(folder))
        for house in map_.ways('building')[::2]:
            map_.delete(house)
        run = self.update(folder, map_.write_changes(self.path('vandal.osc')), code=5)
        self.assertIn('max_lost', run.out)
        self.stands(folder, '000001')
        self.assertEqual(hashes(self.current(folder)), before)
        told = read_json(folder, 'log', '000002.changes.json')
        self.assertIn('max_lost', [g['gate'] for g in told['gates'] if g['exceeded']])
        self.assertTrue(os.path.exists(os.path.join(folder, 'builds', '000002.refused', 'build.json')))
        self.assertEqual(sorted(os.listdir(os.path.join(folder, 'store'))), ['000001.json', '000001.osm.pbf'])
        self.assertFalse(os.path.exists(os.path.join(folder, 'builds', '000002')))

    def test_each_limit(self):
        begin = Map(read_xml(SAMPLE))
        folder = self.region('limits', '')
        self.update(folder, begin.write(self.path('limits.osm')))

        def night(name, edit):
            map_ = Map(read_xml(self.path('limits.osm')))
            edit(map_)
            run = self.update(folder, map_.write_changes(self.path(name + '.osc')), code=5)
            self.assertIn(name, run.out)
            self.stands(folder, '000001')

        def grow(map_):
            for o in town(100, lon=11.02, lat=51.46):
                map_.put(o)

        def raise_(map_):
            for house in map_.ways('building'):
                map_.edit(house, tags=dict(house.tags, height='60'))

        def spoil(map_):
            for house in map_.ways('building')[:40]:
                map_.edit(house, refs=house.refs[:2])
        night('max_added', grow)
        night('max_height_change', raise_)
        night('max_lost', lambda m: [m.delete(h) for h in m.ways('building')[:12]])
        night('max_simpler', spoil)
        # Nothing left at all.
        empty = write_xml(self.path('empty.osm'), [Node(1, 11, 51)])
        self.assertIn('no_buildings', self.update(folder, empty, code=5).out)
        self.stands(folder, '000001')

    def test_a_first_build_without_buildings_is_not_published(self):
        folder = self.region('nothing', '')
        self.update(folder, write_xml(self.path('empty2.osm'), [Node(1, 11, 51)]), code=5)
        self.assertFalse(os.path.lexists(os.path.join(folder, 'current')))

    def test_rollback(self):
        folder, map_ = self.region('back'), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        self.refused(blockrand('rollback', folder), 1, 'no earlier build')
        for night in range(2):
            map_.random_edits(random.Random(night), 2)
            self.update(folder, map_.write_changes(self.path(f'back{night}.osc')))
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.stands(folder, '000002')
        self.refused(blockrand('rollback', folder, '--to', '9'), 1, 'no build 9', '1, 2, 3')
        self.assertEqual(blockrand('rollback', folder, '--to', '1').code, 0)
        self.stands(folder, '000001')
        # What was left out comes again.
        for night in range(2):
            self.update(folder, self.path(f'back{night}.osc'))
        self.same_files(self.current(folder), os.path.join(folder, 'builds', '000003'))


class Care(RegionTest):
    """What is somebody else's stays; what was once done is not undone by chance."""

    def test_foreign_files_stay(self):
        folder = self.region('shared')
        self.update(folder, SAMPLE)
        kept = [os.path.join(folder, *p) for p in (('builds', '202411', 'thesis.txt'), ('builds', 'mine.refused', 'x'), ('builds', '.notes.part-x'),
                                                   ('store', '202411.csv'), ('store', 'readme'), ('log', 'mine.txt'), ('notes.txt',))]
        for path in kept:
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, 'w', encoding='utf-8') as f:
                f.write('mine')
        map_ = Map(read_xml(SAMPLE))
        map_.edit(map_.ways('building')[0], tags={'building': 'yes', 'height': '9'})
        for house in map_.ways('building')[1:]:
            map_.edit(house, tags=dict(house.tags, note='x'))
        self.update(folder, map_.write_changes(self.path('f.osc')))
        self.assertEqual([p for p in kept if not os.path.exists(p)], [])
        # Nor is a folder a region for its names.
        other = self.path('project')
        os.makedirs(os.path.join(other, 'builds', '202411'))
        os.makedirs(os.path.join(other, 'store'))
        self.refused(blockrand('update', other, SAMPLE), 1, 'not empty')
        self.assertTrue(os.path.isdir(os.path.join(other, 'builds', '202411')))

    def test_the_log_may_be_cleared(self):
        folder, map_ = self.region('log'), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        for night in range(2):
            map_.random_edits(random.Random(night), 1)
            self.update(folder, map_.write_changes(self.path(f'l{night}.osc')))
            shutil.rmtree(os.path.join(folder, 'log'))
        self.assertEqual(json.loads(blockrand('status', folder, '--json').out)['published'], [1, 2, 3])
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.stands(folder, '000002')

    def test_what_was_deleted_does_not_come_back(self):
        folder, map_ = self.region('deleted'), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        house = map_.ways('building')[3]
        map_.edit(house, tags=dict(house.tags, height='9'))
        monday = map_.write_changes(self.path('monday.osc'))
        map_.delete(map_.objects[key(house)])
        tuesday = map_.write_changes(self.path('tuesday.osc'))
        for changes in (monday, tuesday, monday):
            self.update(folder, changes)
        self.same_files(self.current(folder), self.clean(map_, folder))

    def test_what_was_published_before_stays(self):
        folder, map_ = self.region('held', LIMITS_OFF + '[region]\nkeep = 2\n'), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        for night in range(1):
            map_.random_edits(random.Random(night), 1)
            self.update(folder, map_.write_changes(self.path('h.osc')))
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.update(folder, self.path('h.osc'))
        self.stands(folder, '000003')
        self.hashes_match(os.path.join(folder, 'builds', '000001'))
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.stands(folder, '000001')

    def test_the_input_of_the_settings_does_not_undo_changes(self):
        begin = self.path('begin_i.osm')
        shutil.copy(SAMPLE, begin)
        folder, map_ = self.region('input', LIMITS_OFF + f'[build]\ninput = "{begin}"\n'), Map(read_xml(SAMPLE))
        self.update(folder)
        map_.random_edits(random.Random(8), 2)
        self.update(folder, map_.write_changes(self.path('i.osc')))
        self.assertIn('up to date', self.update(folder).out)
        self.stands(folder, '000002')
        map_.random_edits(random.Random(9), 2)
        map_.write(begin)
        self.update(folder)
        self.stands(folder, '000003')

    def test_a_damaged_published_build_is_replaced(self):
        folder, map_ = self.region('broken', ''), Map(read_xml(SAMPLE))
        self.update(folder, SAMPLE)
        records = os.path.join(self.current(folder), 'explain')
        for victim in (os.path.join(records, n) for n in os.listdir(records) if n.endswith('.gz')):
            with open(victim, 'r+b') as f:
                f.truncate(100)
        map_.edit(map_.ways('building')[0], tags={'building': 'yes'})
        self.assertIn('compared by its number', self.update(folder, map_.write_changes(self.path('b.osc'))).err)
        self.stands(folder, '000002')
        # Without its record it is none: the way out is to go back, or to say so.
        os.remove(os.path.join(self.current(folder), 'build.json'))
        self.refused(blockrand('update', folder, SAMPLE), 2, 'rollback')
        self.assertEqual(blockrand('rollback', folder).code, 0)
        self.assertEqual(os.path.basename(self.current(folder)), '000001')

    def test_failures_are_on_record(self):
        folder = self.region('record')
        self.update(folder, SAMPLE)
        self.refused(blockrand('update', folder, self.path('absent.osc')), 2, 'no such file')
        last = json.loads(blockrand('status', folder, '--json').out)['last_run']
        self.assertEqual(last['state'], 'failed')
        self.assertIn('absent.osc', last['error'])

    def test_pointers_that_are_none(self):
        folder = self.region('copied')
        self.update(folder, SAMPLE)
        current = os.path.join(folder, 'current')
        build = self.current(folder)
        os.remove(current)
        self.assertIn('was missing', self.update(folder, SAMPLE).err)  # as after a kill between gates and switch
        self.stands(folder, '000001')
        map_ = Map(read_xml(SAMPLE))
        map_.random_edits(random.Random(2), 1)
        self.update(folder, map_.write_changes(self.path('p.osc')))
        os.remove(current)
        self.refused(blockrand('update', folder, SAMPLE), 2, 'rollback')
        shutil.copytree(build, current)
        self.refused(blockrand('update', folder, SAMPLE), 2, 'no link')
        shutil.rmtree(current)
        self.assertEqual(blockrand('rollback', folder, '--to', '1').code, 0)
        self.stands(folder, '000001')
        os.remove(os.path.join(folder, 'region.toml'))
        self.refused(blockrand('update', folder, SAMPLE), 1, 'region.toml is missing')

    def test_names(self):
        folder = self.region('named')
        self.assertEqual(blockrand('update', '.', SAMPLE, cwd=folder).code, 0)
        with open(os.path.join(self.current(folder), 'report.html'), encoding='utf-8') as f:
            self.assertIn('<h1>named</h1>', f.read())
        odd = os.path.join(self.folder.encode(), b'm\xfcn.osm')
        with open(SAMPLE, 'rb') as f, open(odd, 'wb') as g:
            g.write(f.read().replace(b'building:levels" v="4"', b'building:levels" v="5"', 1))
        run = subprocess.run([Setup.program.encode(), b'update', folder.encode(), odd, b'-q'], capture_output=True)
        self.assertEqual(run.returncode, 0, run)
        self.stands(folder, '000002')


class Nights(RegionTest):
    """The worst of them. Each ends with what was published before, whole, and with words."""

    def setUp(self):
        self.map_ = Map(read_xml(SAMPLE))
        self.map_.random_edits(random.Random(1), 5)
        self.changes = self.map_.write_changes(self.path('night.osc'))

    def test_damaged_change_files(self):
        folder = self.region('damaged')
        self.update(folder, SAMPLE)
        with open(self.changes, 'rb') as f:
            whole = f.read()
        for name, content in (('cut.osc', whole[:len(whole) // 2]), ('none.osc', b''), ('cut.osc.gz', gzip.compress(whole)[:-40]),
                              ('text.osc', b'hello'), ('extract.osc', b'<osm version="0.6"></osm>')):
            with self.subTest(name):
                self.refused(blockrand('update', folder, self.place(name, content)), 2, name)
                self.stands(folder, '000001')
                self.assertEqual(sorted(os.listdir(os.path.join(folder, 'store'))), ['000001.json', '000001.osm.pbf'])

    def test_a_damaged_store(self):
        folder = self.region('store')
        self.update(folder, SAMPLE)
        with open(os.path.join(folder, 'store', '000001.osm.pbf'), 'r+b') as f:
            f.seek(200)
            f.write(b'damage')
        self.refused(blockrand('update', folder, self.changes), 2, '000001.osm.pbf', 'full extract')
        self.stands(folder, '000001')
        self.update(folder, self.map_.write(self.path('again.osm')))
        self.stands(folder, '000002')

    def test_hostile_settings(self):
        folder = self.region('settings')
        self.update(folder, SAMPLE)
        for text, words in (('[region]\nkeep = 0\n', ('keep', 'region.toml:2:')), ('[region]\nkepp = 3\n', ('kepp', 'keep')),
                            ('[gates]\nmax_lost = "all"\n', ('max_lost',)), ('[build]\noutput = "/tmp/x"\n', ('output',)),
                            ('[build]\nexplain = false\n', ('explain',)), ('[build]\nstrict = true\n', ('strict',)), ('[build\n', ('region.toml',)), ('[nights]\nx = 1\n', ('nights',)),
                            ('[gates]\nmax_lost = -1\n', ('max_lost',)), ('[gates]\nmax_lost = nan\n', ('max_lost',))):
            with self.subTest(text):
                with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
                    f.write(text)
                self.refused(blockrand('update', folder, self.changes), 2, *words)
                self.stands(folder, '000001')
        self.refused(blockrand('build', SAMPLE, '-o', self.path('x'), '--config', self.place('b.toml', '[gates]\nmax_lost = 1\n')), 2, 'gates')

    def test_new_settings_build_anew(self):
        folder = self.region('anew')
        self.update(folder, SAMPLE)
        with open(os.path.join(folder, 'region.toml'), 'a', encoding='utf-8') as f:
            f.write('[build]\nlod = 1\n')
        self.assertIn('region.toml', self.update(folder).out)
        self.stands(folder, '000002')
        self.assertEqual(read_json(self.current(folder), 'build.json')['configuration']['lod'], 1)

    def test_other_folders_are_refused(self):
        self.refused(blockrand('update', self.place('file', 'x'), SAMPLE), 1, 'is a file')
        os.makedirs(self.path('full'), exist_ok=True)
        self.place(os.path.join('full', 'thesis.txt'), 'x')
        self.refused(blockrand('update', self.path('full'), SAMPLE), 1, 'not empty')
        self.refused(blockrand('update', self.build(SAMPLE, 'a_build', '--lod', '0'), SAMPLE), 1, 'is a build')
        self.refused(blockrand('update', self.path('new')), 1, 'no region yet')
        self.assertFalse(os.path.exists(self.path('new')))
        self.refused(blockrand('status', self.path('new')), 1, 'no region')

    def test_a_full_disk(self):
        folder = self.region('full_disk')
        self.update(folder, SAMPLE)
        limit = 60_000

        def small():
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        self.refused(blockrand('update', folder, self.changes, preexec=small), 4)
        self.stands(folder, '000001')
        self.update(folder, self.changes)
        self.same_files(self.current(folder), self.clean(self.map_, folder))

    def test_locks(self):
        folder = self.region('locked')
        self.update(folder, SAMPLE)
        lock = os.path.join(folder, 'lock')
        import fcntl
        with open(lock, 'r+', encoding='utf-8') as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            held.write('{"pid":"7","host":"elsewhere","since":"now"}')
            held.flush()
            self.refused(blockrand('update', folder, self.changes), 1, 'another run', 'elsewhere')
            self.refused(blockrand('rollback', folder), 1, 'another run')
        # The process is gone without a word, on another host: only somebody who knows may go on.
        self.refused(blockrand('update', folder, self.changes), 1, 'another host', '--break-lock')
        os.utime(lock, (time.time() - 25 * 3600,) * 2)
        self.assertIn('taken over', self.update(folder, self.changes).err)
        with open(lock, 'w', encoding='utf-8') as f:
            f.write('{"pid":"7","host":"elsewhere","since":"now"}')
        self.assertIn('taken over', self.update(folder, self.changes, '--break-lock').err)
        with open(lock, 'w', encoding='utf-8') as f:
            f.write(json.dumps({'pid': '7', 'host': os.uname().nodename, 'since': 'yesterday'}))
        self.assertIn('taken over', self.update(folder, self.changes).err)
        self.assertEqual(os.path.getsize(lock), 0)

    def test_killed_at_any_moment(self):
        rng = random.Random(4)
        folder = self.region('killed', LIMITS_OFF + '[region]\nkeep = 2\n')
        self.update(folder, SAMPLE)
        start = time.time()
        self.update(folder, self.changes)
        usual = time.time() - start
        killed = 0
        for night in range(10):
            self.map_.random_edits(rng, 2)
            changes = self.map_.write_changes(self.path(f'k{night}.osc'))
            good = self.current(folder)
            before = hashes(good)
            process = subprocess.Popen([Setup.program, 'update', folder, changes, '--progress', 'none'],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(usual * rng.uniform(0, 1.05))
            process.kill()
            process.wait()
            killed += process.returncode < 0
            if self.current(folder) == good:
                self.assertEqual(hashes(good), before)
            self.hashes_match(self.current(folder))
            self.update(folder, changes)
            self.same_files(self.current(folder), self.clean(self.map_, folder))
            self.assertLessEqual(len(os.listdir(os.path.join(folder, 'builds'))), 3)
        self.assertGreaterEqual(killed, 5)

    def test_readers_are_not_disturbed(self):
        """A reader follows `current` once a round and reads all files that its build.json lists, while builds come and go."""
        folder = self.region('read', LIMITS_OFF + '[region]\nkeep = 2\n[build]\nlod = 0\nformats = "gltf"\nreport = false\n')
        self.update(folder, SAMPLE)
        problems, rounds, stop = [], [0], threading.Event()

        def read():
            while not stop.is_set():
                build = self.current(folder)
                try:
                    for path, entry in read_json(build, 'build.json')['files'].items():
                        with open(os.path.join(build, path), 'rb') as f:
                            if len(f.read()) != entry['bytes']:
                                problems.append(path)
                    rounds[0] += 1
                except (OSError, ValueError) as error:
                    problems.append(repr(error))
        reader = threading.Thread(target=read)
        reader.start()
        for night in range(20):
            self.map_.random_edits(random.Random(100 + night), 1)
            self.update(folder, self.map_.write_changes(self.path('r.osc')))
        stop.set()
        reader.join()
        self.assertEqual(problems, [])
        self.assertGreater(rounds[0], 20)


if __name__ == '__main__':
    main()
