"""The sample neighbourhood: everything a build promises, on a file that is always there."""
import difflib
import json
import os
import re
import shutil
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import validators
from blockrand_run import SAMPLE, BuildTest, Setup, call, main, read_json, sha256
from model_files import GML_ID, attributes, buildings
from osm_files import Node, Way, read_xml

GOLDEN = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'golden', 'sample_summary.json')

# Planted by samples/make_sample.py: object, how it ends, and the code that tells why. Where `code` is a reported one it
# is the object's final state, else a row among notices or fallbacks of a modelled object.
PLANTED = [
    ('w9001', 'modelled', 'RING_REPAIRED'),       # bow-tie
    ('w9002', 'modelled', 'DUPLICATE_POINTS'),    # node twice in a row
    ('w9003', 'modelled', 'SPIKE_REMOVED'),
    ('w9004', 'reported', 'OPEN_WAY'),
    ('n9007', 'reported', 'NODE_ONLY'),
    ('r901', 'modelled', 'MEMBERS_MISSING'),      # inner way 9999
    ('w9009', 'modelled', 'VALUE_UNREADABLE'),    # building:levels=four
    ('w9010', 'modelled', 'VALUE_UNREADABLE'),    # height=about as high as next door
    ('w9011', 'modelled', None),                  # overlaps w9010: for the footprint stage
    ('w9012', 'modelled', None),                  # gap of 0.2 m: likewise
]


def mapped_objects():
    """{id: kind} of all objects with building or building:part, counted with nothing but an XML parser."""
    found = {}
    for o in read_xml(SAMPLE):
        letter = 'n' if isinstance(o, Node) else 'w' if isinstance(o, Way) else 'r'
        for key, kind in (('building', 'building'), ('building:part', 'building_part')):
            if o.tags.get(key, 'no') != 'no':
                found[f'{letter}{o.id}'] = kind
                break
    return found


class Sample(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'out', '--jobs', '2')
        cls.run_of_build = cls.last

    def test_counts_are_those_of_the_file(self):
        build, report = self.counts_add_up(self.out)
        kinds = list(mapped_objects().values())
        self.assertGreaterEqual(len(kinds), 150)
        self.assertEqual(build['counts']['buildings_in'], kinds.count('building'))
        self.assertEqual(build['counts']['parts_in'], kinds.count('building_part'))
        self.assertEqual(build['counts']['missing_ways'], 1)
        self.assertEqual(build['counts']['models_lod2'], build['counts']['models'], 'every model of the sample is LoD2')

    def test_every_object_has_one_end(self):
        """Each mapped object is a model in the CityGML files or a row of the report, never both, never neither."""
        rows = {row['id']: row['state'] for row in read_json(self.out, 'report.json')['objects']}
        bodies = set()
        for building in buildings(self.out).values():
            for e in building.iter():
                if e.find('{http://www.opengis.net/citygml/building/2.0}lod2Solid') is not None:
                    names = [n for n in e.get(GML_ID).split('.') if n[0] in 'nwr' and n != 'rest']
                    bodies.add(names[-1])
        objects = mapped_objects()
        self.assertEqual(set(rows) & bodies, set(), 'in the report and modelled')
        self.assertEqual(set(rows) | bodies, set(objects))

    def test_planted_errors_are_reported(self):
        report = read_json(self.out, 'report.json')
        states = {row['id']: row for row in report['objects']}
        rows = {(row['id'], row['code']) for row in report['notices'] + report['fallbacks']}
        for object_id, state, code in PLANTED:
            with self.subTest(object=object_id, code=code):
                if state == 'reported':
                    self.assertEqual((states.get(object_id, {}).get('state'), states.get(object_id, {}).get('code')),
                                     (state, code))
                else:
                    self.assertNotIn(object_id, states)
                    if code:
                        self.assertIn((object_id, code), rows, sorted(r for r in rows if r[0] == object_id))
        with self.subTest('traced twice'):
            # The richer one of the two stays.
            self.assertEqual(states.get('w9005', {}).get('state'), 'duplicate')
            self.assertEqual(states.get('w9005', {}).get('related'), 'w9006')
            self.assertNotIn('w9006', states)

    def test_unbuilt_objects_have_their_reasons(self):
        tags = {f'{"n" if isinstance(o, Node) else "w" if isinstance(o, Way) else "r"}{o.id}': o.tags
                for o in read_xml(SAMPLE)}
        ends = {row['id']: row.get('code') for row in read_json(self.out, 'report.json')['objects']}
        underground = [i for i, t in tags.items() if t.get('location') == 'underground' and 'building' in t]
        construction = [i for i, t in tags.items() if t.get('building') == 'construction']
        self.assertTrue(underground and construction)
        for object_id in underground:
            self.assertEqual(ends.get(object_id), 'UNDERGROUND', object_id)
        for object_id in construction:
            self.assertEqual(ends.get(object_id), 'LIFECYCLE', object_id)

    def test_documents_have_their_keys(self):
        build, run, report = (read_json(self.out, f) for f in ('build.json', 'run.json', 'report.json'))
        for key in ('program', 'inputs', 'crs', 'counts', 'issues', 'files'):
            self.assertIn(key, build)
        for key in ('buildings_in', 'parts_in', 'models', 'represented', 'reported'):
            self.assertIsInstance(build['counts'][key], int)
        self.assertEqual(build['crs']['code'], 'EPSG:25832')
        self.assertTrue(0 <= build['crs']['round_trip_error_m'] < 1e-3, build['crs'])
        self.assertTrue(0 <= build['crs']['frame_round_trip_error_m'] < 1e-3, build['crs'])
        self.assertGreater(build['crs']['accuracy_m'], 0)
        self.assertTrue(build['crs']['operation'])
        self.assertEqual(build['crs']['vertical_crs'], '', 'no vertical code is claimed without terrain')
        self.assertEqual(build['data_time'], '2024-05-01T00:00:00Z')
        self.assertRegex(build['data']['sha256'], '^[0-9a-f]{64}$')
        sample = next(i for i in run['inputs'] if i['role'] == 'extract')
        self.assertEqual((sample['bytes'], sample['sha256']), (os.path.getsize(SAMPLE), sha256(SAMPLE)))
        self.assertTrue(run['timings'])
        self.assertTrue(all(seconds >= 0 for seconds in run['timings'].values()))
        self.assertGreater(run['peak_rss_bytes'], 10_000_000)
        self.assertEqual(run['jobs'], 2)
        for list_name in ('fallbacks', 'notices'):
            for row in report[list_name]:
                self.assertIn(row['code'], report['codes'])
                self.assertRegex(row['id'], r'^[nwr]-?\d+$')

    def test_hashes_match(self):
        self.hashes_match(self.out)

    def test_values_say_where_they_come_from(self):
        """A tagged height has no source beside it; an inferred one names its source and confidence."""
        tagged = inferred = 0
        for building in buildings(self.out).values():
            a = attributes(building)
            if 'height' in a or building.find('{http://www.opengis.net/citygml/building/2.0}measuredHeight') is not None:
                if 'height_source' in a:
                    inferred += 1
                    self.assertTrue(0 <= float(a['height_confidence']) <= 1, a)
                else:
                    tagged += 1
                    self.assertTrue({'osm.height', 'osm.est_height'} & a.keys(), building.get(GML_ID))
        self.assertGreater(tagged, 5)
        self.assertGreater(inferred, 50)

    def test_summary_on_stdout(self):
        self.assertIn('modelled', self.run_of_build.out)
        self.assertRegex(self.run_of_build.err, 'no --ground-height: .* lie 4[0-9] m below the sea level of the place', 'the missing ground height is said')

    def test_golden_summary(self):
        build = read_json(self.out, 'build.json')
        summary = {'counts': build['counts'], 'issues': build['issues'], 'statistics': build['statistics'],
                   'crs': build['crs']['code'], 'files': sorted(build['files'])}
        if Setup.update:
            with open(GOLDEN, 'w', encoding='utf-8') as f:
                json.dump(summary, f, indent=1, ensure_ascii=False)
                f.write('\n')
        with open(GOLDEN, encoding='utf-8') as f:
            expected = json.load(f)
        texts = [json.dumps(s, indent=1, ensure_ascii=False, sort_keys=True).splitlines() for s in (expected, summary)]
        diff = '\n'.join(difflib.unified_diff(*texts, 'golden/sample_summary.json', 'this build', lineterm='', n=2))
        self.assertFalse(diff, f'\n{diff}\nIf the new values are right: python3 {os.path.relpath(__file__)} --update')

    # ---- validators

    def test_schema(self):
        self.assertEqual(validators.xmllint(self.out), '')

    def test_khronos(self):
        self.assertEqual(validators.khronos(self.out), '')

    def test_tileset(self):
        self.assertEqual(validators.tileset(self.out), '')

    def test_metadata(self):
        self.assertEqual(validators.metadata(self.out), '')

    def test_validate(self):
        self.assertEqual(validators.validate(self.out), '')

    # ---- the validators themselves: each must notice damage

    def damaged(self, name, path, change):
        """A copy of the build with one file changed."""
        folder = self.path(name)
        shutil.copytree(self.out, folder)
        with open(os.path.join(folder, path), 'rb') as f:
            data = f.read()
        changed = change(data)
        self.assertNotEqual(changed, data)
        with open(os.path.join(folder, path), 'wb') as f:
            f.write(changed)
        return folder

    def some_file(self, end):
        return max((p for p in read_json(self.out, 'build.json')['files'] if p.endswith(end)),
                   key=lambda p: os.path.getsize(os.path.join(self.out, p)))

    def test_validators_notice_a_moved_vertex(self):
        def lift(data):
            roof = re.search(rb'<bldg:RoofSurface.*?xlink:href="#([^"]*)"', data, re.S).group(1)
            at = data.index(b'<posList>', data.index(b'<Polygon gml:id="' + roof + b'"')) + 9
            end = data.index(b'</posList>', at)
            n = data[at:end].split()
            for i in (2, len(n) - 1):
                n[i] = b'%.4f' % (float(n[i]) + 3)
            return data[:at] + b' '.join(n) + data[end:]
        said = validators.validate(self.damaged('moved', self.some_file('.gml'), lift))
        self.assertIn('NOT SOUND', said)
        self.assertIn('own checker: ', said)
        self.assertNotIn('CGAL: valid', said)

    def test_validators_notice_a_lost_building(self):
        def drop(data):
            a, b = data.index(b'<core:cityObjectMember>'), data.index(b'</core:cityObjectMember>')
            return data[:a] + data[b + len(b'</core:cityObjectMember>'):]
        self.assertIn('build.json', validators.validate(self.damaged('lost', self.some_file('.gml'), drop)))

    def test_validators_notice_a_wrong_element(self):
        folder = self.damaged('element', self.some_file('.gml'), lambda d: d.replace(b'bldg:RoofSurface', b'bldg:Rooof'))
        self.assertIn('Rooof', validators.xmllint(folder))

    def test_validators_notice_a_tile_out_of_its_box(self):
        folder = self.damaged('box', 'tileset.json', lambda d: self.narrower(d))
        self.assertIn('outside', validators.tileset(folder))

    @staticmethod
    def narrower(data):
        tileset = json.loads(data)

        def shrink(tile):
            if 'content' in tile and 'box' in tile['boundingVolume']:
                tile['boundingVolume']['box'][3] /= 2
            for child in tile.get('children', []):
                shrink(child)
        shrink(tileset['root'])
        return json.dumps(tileset).encode()

    def test_validators_notice_a_broken_glb(self):
        folder = self.damaged('glb', self.some_file('.glb'), lambda d: d.replace(b'"VEC3"', b'"VEC2"', 1))
        self.assertNotEqual(validators.khronos(folder), '')


class SampleFile(unittest.TestCase):
    def test_generator_writes_the_committed_file(self):
        """samples/blockrand-viertel.osm is what make_sample.py writes, byte for byte."""
        with tempfile.TemporaryDirectory() as folder:
            target = os.path.join(folder, 'sample.osm')
            run = call([sys.executable, os.path.join(os.path.dirname(SAMPLE), 'make_sample.py'), target])
            self.assertEqual(run.code, 0, run)
            self.assertEqual(sha256(target), sha256(SAMPLE))

    def test_sample_is_well_formed(self):
        ElementTree.parse(SAMPLE)


if __name__ == '__main__':
    main()
