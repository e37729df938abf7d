"""Fourteen nights of a region: edits, a torn file, a killed run, a night that nobody ran, a vandalised extract, a new program. Every
morning the model stands, whole, and is that of the data that should be in it. What happened can be read in the log."""
import gzip
import json
import os
import random
import shutil
import signal
import subprocess
import time

from areas_test import without_runs
from blockrand_run import SAMPLE, Setup, blockrand, extract, hashes, main
from osm_files import read_xml
from region_run import Map, RegionTest

SETTINGS = '''[build]
lod = 2
areas = 13
formats = "gltf,citygml,geopackage"
[region]
replication = "../server"
first_sequence = 1
keep = 3
'''
OPTIONS = ('--lod', '2', '--areas', '13', '--formats', 'gltf,citygml,geopackage')
CONFIGS = os.path.realpath(os.path.join(os.path.dirname(SAMPLE), '..', 'configs'))
NIGHTS = 14
TORN, KILLED, MISSED, VANDALISED, UPGRADE = 3, 6, 8, 10, 12


class Fortnight(RegionTest):
    def setUp(self):
        self.server = self.path('server')
        self.rng = random.Random(14)
        source = self.path('begin.osm')
        with gzip.open(extract('dortmund-innenstadt.osm.gz')) as packed, open(source, 'wb') as f:
            shutil.copyfileobj(packed, f)
        self.map_ = Map(read_xml(source))
        self.folder = self.region('dortmund', SETTINGS)
        self.program = Setup.program
        self.mornings = []

    def offer(self, night):
        """The change file of a day."""
        place = os.path.join(self.server, '000', '000')
        os.makedirs(place, exist_ok=True)
        self.map_.random_edits(self.rng, self.rng.choice([2, 5, 12]))
        path = self.map_.write_changes(os.path.join(place, f'{night:03}.osc.gz'))
        for state in (os.path.join(place, f'{night:03}.state.txt'), os.path.join(self.server, 'state.txt')):
            with open(state, 'w', encoding='utf-8') as f:
                f.write(f'#x\nsequenceNumber={night}\ntimestamp=2026-12-{night:02}T20\\:21\\:22Z\n')
        return path

    def night(self, *data, code=0):
        run = subprocess.run([self.program, 'update', self.folder, *data, '--configs', CONFIGS, '--progress', 'none'], capture_output=True, text=True)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        self.mornings.append(run.stdout + run.stderr)
        return run

    def is_right(self):
        """What stands is the data's, byte by byte, and sound."""
        clean = self.clean(self.map_, self.folder, *OPTIONS, '--configs', CONFIGS)
        first, second = (without_runs(hashes(f)) for f in (self.current(self.folder), clean))
        self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])
        sound = blockrand('validate', self.current(self.folder))
        self.assertEqual(sound.code, 0, sound)

    def stays(self, before):
        """The model of the morning before stands, and is whole."""
        self.assertEqual(self.current(self.folder), before[0])
        self.assertEqual(hashes(before[0]), before[1])
        sound = blockrand('validate', before[0])
        self.assertEqual(sound.code, 0, sound)

    def standing(self):
        return self.current(self.folder), hashes(self.current(self.folder))

    def torn_file(self, path, before):
        with open(path, 'rb') as f:
            whole = f.read()
        with open(path, 'wb') as f:
            f.write(whole[:len(whole) // 2])
        run = self.night(code=2)
        self.assertIn(os.path.basename(path), run.stderr)
        self.stays(before)
        with open(path, 'wb') as f:  # the server mends it during the day
            f.write(whole)

    def killed_run(self, before):
        run = subprocess.Popen([self.program, 'update', self.folder, '--configs', CONFIGS, '--progress', 'none'], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(3)
        run.send_signal(signal.SIGKILL)
        self.assertEqual(run.wait(), -signal.SIGKILL, 'it was over before it was killed')
        self.stays(before)

    def vandalised_extract(self, before):
        vandals = Map(self.map_.objects.values())
        houses = vandals.ways('building')
        for house in self.rng.sample(houses, len(houses) // 3):
            vandals.delete(house)
        self.assertIn('max_lost', self.night(vandals.write(self.path('vandals.osm')), code=5).stdout)
        self.stays(before)

    def upgrade(self):
        """The same program by another file: to the kept work it is another one."""
        place = self.path('new')
        os.makedirs(place)
        self.program = shutil.copy(self.program, place)
        with open(self.program, 'ab') as f:
            f.write(b'a newer one')
        return self.night()

    def test_it(self):
        self.night(self.map_.write(self.path('first.osm')))
        self.is_right()
        for night in range(1, NIGHTS + 1):
            before = self.standing()
            path = self.offer(night)
            if night == MISSED:
                self.mornings.append('(nobody ran it)\n')
                self.stays(before)
                continue
            if night == TORN:
                self.torn_file(path, before)
                continue
            if night == KILLED:
                self.killed_run(before)
                self.mornings.append('(killed)\n')
                continue
            if night == VANDALISED:
                self.vandalised_extract(before)
                continue
            run = self.upgrade() if night == UPGRADE else self.night()
            if night == UPGRADE:
                self.assertIn('another one than that which kept', run.stderr)
            # After a night that failed or was missed the change files of both days are in.
            self.assertEqual(json.loads(blockrand('status', self.folder, '--json').out)['sequence'], night)
            self.is_right()
        with open(os.path.join(self.folder, 'log', 'runs.jsonl'), encoding='utf-8') as f:
            runs = [json.loads(line) for line in f]
        self.assertEqual([r['state'] for r in runs],
                         ['published'] + ['refused' if n == VANDALISED else 'failed' if n == TORN else 'published'
                                          for n in range(1, NIGHTS + 1) if n not in (KILLED, MISSED)])
        self.assertEqual(len(json.loads(blockrand('status', self.folder, '--json').out)['published']), 3)
        print('\n'.join(f'-- night {n}\n{words}' for n, words in enumerate(self.mornings)))


if __name__ == '__main__':
    main()
