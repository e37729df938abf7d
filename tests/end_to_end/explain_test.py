"""`blockrand explain` for every object of a build: the sample, and a real extract where there is one."""
import collections
import gzip
import json
import os
import re
import shutil
import subprocess

from osm_files import Node, Way, house, write_xml
from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, main, read_json

ORDER = {'n': 0, 'w': 1, 'r': 2}
SOURCES = ['override', 'tag', 'implied', 'part', 'imagery', 'terrain', 'geometry', 'neighbours', 'block', 'cell',
           'district', 'region', 'preset', 'default']


def index_of(folder):
    with open(os.path.join(folder, 'explain', 'index.txt'), encoding='utf-8') as file:
        return [line.split(' ') for line in file.read().splitlines()]


Place = collections.namedtuple('Place', 'id tile lon lat top addresses name')


def places_of(folder):
    """The lines of places.tsv by id, in their order."""
    with open(os.path.join(folder, 'explain', 'places.tsv'), encoding='utf-8', newline='') as file:
        rows = file.read().split('\n')
    assert rows.pop() == '', 'the last line has an end'
    return {place.id: place for place in (Place(*row.split('\t')) for row in rows)}


def lines_of(folder, tile):
    with gzip.open(os.path.join(folder, 'explain', tile + '.jsonl.gz'), 'rt', encoding='utf-8') as file:
        return {j['id']: j for j in map(json.loads, file)}


def turned(thing):
    """Longitudes beyond 180 degrees on the other side."""
    if isinstance(thing, Node) and thing.lon > 180:
        thing.lon -= 360
    return thing


class Explain(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'explained')

    def explained(self, folder, identity, *options):
        run = blockrand('explain', folder, identity, *options)
        self.assertEqual(run.code, 0, run.err)
        return run.out

    def complete(self, folder):
        """Every object that has a body, and every building that has none, has a line; nothing else has."""
        index = index_of(folder)
        keys = [(ORDER[o[0]], int(o[1:])) for o, _, _ in index]
        self.assertEqual(keys, sorted(set(keys)))
        tiles = {tile: lines_of(folder, tile) for tile in {tile for _, tile, _ in index}}
        self.assertEqual(sum(map(len, tiles.values())), len({b for _, _, b in index}))
        counts = read_json(folder, 'build.json')['counts']
        reported = {o['id']: o for o in read_json(folder, 'report.json')['objects']}
        buildings = bodies = modelled = 0
        for tile in tiles.values():
            for line in tile.values():
                buildings += bool(line['bodies'])
                bodies += len(line['bodies'])
                if line['state'] != 'modelled':
                    self.assertEqual(line['state'], reported[line['id']]['state'])
                for a in line['attributes']:
                    self.assertIn(a['source'], SOURCES)
                    self.assertTrue(0 <= a['confidence'] <= 1, a)
                    self.assertTrue(a.get('why'), f"{line['id']} {a['name']} has no reason")
                    for lost in a.get('lost', []):
                        self.assertTrue(lost['why'], a)
                        self.assertLessEqual(SOURCES.index(a['source']), SOURCES.index(lost['source']), a)
                for name in line['files']:
                    self.assertTrue(os.path.exists(os.path.join(folder, name)), name)
        self.assertEqual((buildings, bodies), (counts['buildings'], counts['bodies']))
        modelled = {o for o, _, _ in index} - set(reported)
        self.assertEqual(len(modelled), counts['models'])
        return index, tiles

    def test_every_object_of_the_sample(self):
        index, tiles = self.complete(self.out)
        for identity, tile, building in index[::5] + [row for row in index if row[0] != row[2]][:10]:
            text = self.explained(self.out, identity, '--all')
            line = tiles[tile][building]
            self.assertIn(building, text)
            for stage in line['stages']:
                self.assertIn(stage['stage'], text)
            self.assertEqual(json.loads(self.explained(self.out, identity, '--json')), line)
        for row in read_json(self.out, 'report.json')['objects']:
            text = self.explained(self.out, row['id'], '--all')
            self.assertIn(row['id'], text)
            if row['state'] == 'reported':
                self.assertIn(row['code'], text)

    def test_plain_lines_for_people(self):
        """About ten lines without codes, ids of blocks, keys of styles, footnotes and bare probabilities."""
        index = index_of(self.out)
        objects = [o for o, _, _ in index[::7]] + [o['id'] for o in read_json(self.out, 'report.json')['objects']]
        for identity in objects:
            text = self.explained(self.out, identity)
            lines = [line for line in text.split('\n') if re.match('  [A-Z]', line)]
            self.assertTrue(1 <= len(lines) <= 12, text)
            plain = re.sub(r'[nwr]-?[0-9]+[.][a-z_]+ =', '', text.split('\nEverything that is known')[0])
            for pattern in ('[A-Z]{3,}_[A-Z]', r'\b(gz|pb|ind)_', r'\bs[0-9][.][0-9]', r'\[E\]', r'\b0[.][0-9]{2}',
                            r'[nwr][0-9]+[.][a-z]'):
                self.assertIsNone(re.search(pattern, plain), pattern + ' in ' + text)
        house = next(l for t in {t for _, t, _ in index} for l in lines_of(self.out, t).values() if l['bodies'])
        text = self.explained(self.out, house['id'])
        for subject in ('What it is', 'Storeys', 'Height', 'Roof', 'Facade', 'Outline', 'To change it'):
            self.assertIn('\n  ' + subject + ':', text)
        self.assertIn('--all', text)

    def test_the_order_that_is_shown_works(self):
        """Whoever pastes the line gets what it orders."""
        for identity, _, building in index_of(self.out):
            if identity != building:
                continue
            text = ' '.join(self.explained(self.out, identity).split())
            found = re.search(r'or write ([nwr][0-9]+)[.]storeys = ([0-9.]+) ', text)
            if found:
                break
        else:
            self.fail('no house of the sample has guessed storeys')
        orders = os.path.join(self.folder, 'orders.toml')
        with open(orders, 'w', encoding='utf-8') as file:
            file.write(f'{found.group(1)}.storeys = 9\n')
        out = self.build(SAMPLE, 'ordered', '--overrides', orders)
        self.assertIn('Storeys: 9, as you ordered', self.explained(out, found.group(1)))

    def test_places_agree_with_the_explanations(self):
        index, places = index_of(self.out), places_of(self.out)
        self.assertEqual(list(places), [b for o, _, b in index if o == b])
        for tile in {t for _, t, _ in index}:
            for line in lines_of(self.out, tile).values():
                place = places[line['id']]
                self.assertEqual((place.tile, place.name), (tile, line.get('name', '')))
                self.assertEqual((place.lon, place.lat), tuple('%.7f' % line['place'][k] for k in ('lon', 'lat')))
                self.assertTrue(place.addresses.startswith(line.get('address', '')), place)
                self.assertEqual(float(place.top) > 0, bool(line['bodies']))
        self.assertIn('explain/places.tsv', read_json(self.out, 'build.json')['files'])

    def town(self, name):
        """Six houses of one street, and what people may ask for."""
        objects, ways = [], []
        for i in range(6):
            own = house(i, 12.37 + i * 0.0004, 51.34)
            objects += own
            ways.append(next(o for o in own if isinstance(o, Way)))
        for way, number in zip(ways, ('1', '3', '5a', '7-11', '13')):
            way.tags = {'building': 'house', 'addr:street': 'Große Gasse Straße', 'addr:housenumber': number}
        ways[4].tags['addr:city'] = 'Leipzig'
        ways[5].tags = {'building': 'church', 'name': 'Thomaskirche'}
        source = os.path.join(self.folder, name + '.osm')
        write_xml(source, objects)
        return self.build(source, name), ['w%d' % way.id for way in ways]

    def test_by_address_and_by_name(self):
        out, ids = self.town('town')
        for text, expected in (('Große Gasse Straße 3', 1), ('3 grosse gasse str.', 1), ('GROSSE GASSE STRASSE 3, Leipzig', 1),
                               ('Grosse-Gasse-Strasse 13', 4), ('thomaskirche', 5), ('Thomas', 5)):
            self.assertEqual(self.explained(out, text), self.explained(out, ids[expected]), text)
            self.assertEqual(json.loads(self.explained(out, text, '--json'))['id'], ids[expected])
        run = blockrand('explain', out, 'Große Gasse Straße 9')
        self.assertEqual(run.code, 0)
        self.assertIn('beside', run.err)
        self.assertEqual(run.out, self.explained(out, ids[3]))
        run = blockrand('explain', out, 'Große Gasse Straße')
        self.assertEqual((run.code, run.out), (2, ''))
        for identity in ids[:5]:
            self.assertIn(identity, run.err)
        self.assertNotIn(ids[5], run.err)
        run = blockrand('explain', out, 'Grose Gase Strase 3')
        self.assertEqual(run.code, 0, 'double letters do not count')
        run = blockrand('explain', out, 'Grosse Gosse Str. 3')
        self.assertEqual((run.code, run.out), (2, ''))
        self.assertIn("Did you mean 'Große Gasse Straße 3'?", run.err)

    def test_at_most_ten_are_listed(self):
        found = collections.Counter(re.sub(r' [0-9].*', '', p.addresses) for p in places_of(self.out).values() if p.addresses)
        street, count = found.most_common(1)[0]
        if count <= 10:
            self.skipTest('no street of the sample has eleven houses')
        run = blockrand('explain', self.out, street)
        self.assertEqual(run.code, 2)
        self.assertLessEqual(len(re.findall(r'\n  [nwr][0-9]', run.err)), 10)
        self.assertIn('more', run.err)

    def test_a_build_from_before_addresses_were_known(self):
        old = os.path.join(self.folder, 'old')
        shutil.copytree(self.out, old)
        os.remove(os.path.join(old, 'explain', 'places.tsv'))
        run = blockrand('explain', old, 'Arkonaplatz 5')
        self.assertEqual((run.code, run.out), (2, ''))
        self.assertIn('places.tsv', run.err)
        self.assertIn('w123', run.err)
        self.assertEqual(blockrand('explain', old, index_of(old)[0][0]).code, 0)

    def test_walls_on_request(self):
        index = index_of(self.out)
        for identity, tile, building in [row for row in index if row[0] == row[2]][:40:4]:
            line = lines_of(self.out, tile)[building]
            text = self.explained(self.out, identity, '--edges')
            self.assertIn('Its walls', text)
            self.assertNotIn('Its walls', self.explained(self.out, identity))
            rows = text[text.index('Its walls'):]
            for edge in line.get('edges', []):
                self.assertIn(edge['id'].split('.e', 1)[1], rows)
                self.assertIn(f"{edge['length']:.1f} m", rows)
                self.assertIn(edge.get('street_name', edge.get('neighbour', '')), rows)

    def test_ids_in_all_forms(self):
        identity = next(o for o, _, b in index_of(self.out) if o == b and o[0] == 'w')
        text = self.explained(self.out, identity)
        for form in ('way/' + identity[1:], 'https://www.openstreetmap.org/way/' + identity[1:], identity + '.rest'):
            self.assertEqual(self.explained(self.out, form), text)

    def test_what_cannot_be_explained(self):
        run = blockrand('explain', self.out, 'w999999999999')
        self.assertEqual((run.code, run.out), (2, ''))
        self.assertIn('w999999999999', run.err)
        run = blockrand('explain', self.out, '12')
        self.assertEqual(run.code, 1)
        self.assertIn('w12', run.err)
        run = blockrand('explain', os.path.dirname(self.out), 'w1')
        self.assertEqual(run.code, 1)
        self.assertIn('build.json', run.err)
        bare = self.build(SAMPLE, 'bare', '--no-explain')
        self.assertFalse(os.path.exists(os.path.join(bare, 'explain')))
        run = blockrand('explain', bare, 'w1')
        self.assertEqual(run.code, 1)
        self.assertIn('--no-explain', run.err)

    def test_a_closed_pipe_is_no_crash(self):
        identity = index_of(self.out)[0][0]
        run = subprocess.run(f'"{Setup.program}" explain "{self.out}" {identity} | head -1', shell=True, capture_output=True,
                             text=True)
        self.assertEqual(run.stdout.count('\n'), 1)

    def test_output_that_cannot_be_written_is_an_error(self):
        if not os.path.exists('/dev/full'):
            self.skipTest('no /dev/full')
        identity = index_of(self.out)[0][0]
        for command in (['explain', self.out, identity], ['help', 'options', '--markdown'], ['help', 'man']):
            with open('/dev/full', 'w') as full:
                run = subprocess.run([Setup.program, *command], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(run.returncode, 4, command)
            self.assertIn('standard output', run.stderr)

    def test_bodies_by_their_own_ids(self):
        building = next(line for tile in {t for _, t, _ in index_of(self.out)} for line in lines_of(self.out, tile).values()
                        if len(line['bodies']) > 1)
        for body in building['bodies']:
            self.assertIn('The values of ' + body['id'], self.explained(self.out, body['id'], '--all'))

    def test_hostile_texts_double_keys_and_places_far_from_europe(self):
        """Near the equator and in the far north, across 180 degrees: sound, and explained where it stands."""
        places = {'jakarta': (106.8, -6.2), 'svalbard': (15.6, 78.2), 'fiji': (179.9999, -16.5)}
        for name, (lon, lat) in places.items():
            objects = [o for i in range(12) for o in house(i, lon + (i % 4) * 0.0003, lat + i // 4 * 0.0003)]
            way = next(o for o in objects if isinstance(o, Way))
            way.tags = {'building': 'house', 'note': '\u009b31m', 'name': 'A\n  forged: line'}
            source = os.path.join(self.folder, name + '.osm')
            write_xml(source, [turned(o) for o in objects])
            with open(source, encoding='utf-8') as file:
                text = file.read()
            with open(source, 'w', encoding='utf-8') as file:
                file.write(text.replace('<tag k="note"', '<tag k="height" v="10"/><tag k="height" v="20"/><tag k="note"'))
            out = self.build(source, name)
            run = blockrand('validate', out)
            self.assertEqual(run.code, 0, run.out)
            explained = self.explained(out, 'w%d' % way.id, '--all')
            for text in (explained, self.explained(out, 'w%d' % way.id)):
                self.assertNotIn('\u009b', text)
                self.assertNotIn('\n  forged', text)
            self.assertIn('DUPLICATE_KEY', explained)
            self.assertEqual(places_of(out)['w%d' % way.id].name, 'A   forged: line')
            self.assertIn('forged', self.explained(out, 'a forged line'))
            place = json.loads(self.explained(out, 'w%d' % way.id, '--json'))['place']
            self.assertLess(abs((place['lon'] - lon + 180) % 360 - 180), 0.01)
            self.assertLess(abs(place['lat'] - lat), 0.01)

    def test_a_real_quarter(self):
        path = os.path.join(Setup.shared or '', 'data', 'osm', 'berlin-zionskirchplatz-2020.osm')
        if not os.path.exists(path):
            self.skipTest('no ' + path)
        out = self.build(path, 'real')
        index, tiles = self.complete(out)
        lines = [line for tile in tiles.values() for line in tile.values()]
        named = sum('shared with w' in s['text'] for line in lines for s in line['stages'])
        self.assertGreater(named, len(lines) / 4, 'perimeter blocks: most houses have neighbours')
        self.assertTrue(any(a.get('lost') for line in lines for a in line['attributes']))


if __name__ == '__main__':
    main()
