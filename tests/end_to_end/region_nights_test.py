"""The worst of nights: torn files, a full disk, kills, locks, hostile settings. The last good model stands, always."""
import fcntl
import glob
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

from blockrand_run import SAMPLE, Setup, blockrand, call, hashes, main, read_json
from interruption_test import small_disk
from osm_files import read_xml
from region_run import LIMITS_OFF, Map, RegionTest


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
                self.assertEqual(sorted(os.listdir(os.path.join(folder, 'store'))), ['000001.json', '000001.osm.pbf', '000001.toml'])

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

    def test_repair(self):
        folder = self.region('repaired')
        self.update(folder, SAMPLE)
        run = blockrand('region', 'repair', folder)
        self.assertEqual(run.code, 0, run)
        self.assertIn('data of build 1: whole', run.out)
        with open(os.path.join(folder, 'store', '000001.osm.pbf'), 'r+b') as f:
            f.seek(200)
            f.write(b'damage')
        for path in glob.glob(os.path.join(folder, 'cache', 'tiles', '??', '*', 'entry')):
            os.truncate(path, 3)
        self.refused(blockrand('region', 'repair', folder), 2, 'damaged', 'EXTRACT')
        run = blockrand('region', 'repair', folder, SAMPLE)
        self.assertEqual(run.code, 0, run)
        self.stands(folder, '000001')
        self.assertIn('data of build 1: whole', blockrand('region', 'repair', folder).out)
        self.update(folder, self.changes)
        self.stands(folder, '000002')
        self.refused(blockrand('region', 'repair', self.path('nowhere')), 1, 'no region')
        self.refused(blockrand('region', 'polish', folder), 1, 'polish')

    def test_damaged_work_does_no_harm(self):
        folder, rng = self.region('rotten'), random.Random(4)
        self.update(folder, SAMPLE)
        for path in glob.glob(os.path.join(folder, 'cache', '*', '??', '*', 'entry')):
            with open(path, 'r+b') as f:
                f.seek(rng.randrange(os.path.getsize(path)))
                f.write(b'\xff')
        with open(os.path.join(folder, 'region.toml'), 'a', encoding='utf-8') as f:
            f.write('[region]\nkeep = 3\n')
        self.assertIn('damaged', self.update(folder).err)
        self.update(folder, self.changes)
        self.same_files(self.current(folder), self.clean(self.map_, folder))

    def test_a_region_that_cannot_be_written(self):
        with small_disk(self.path('sealed'), 'size=64m') as disk:
            folder = os.path.join(disk, 'town')
            os.makedirs(folder)
            with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
                f.write('[build]\nlod = 2\n' + LIMITS_OFF)
            self.update(folder, SAMPLE)
            before = hashes(os.path.realpath(os.path.join(folder, 'current')))
            self.assertEqual(call(['mount', '-o', 'remount,ro', disk]).code, 0)
            try:
                self.refused(blockrand('update', folder, self.changes), 4, 'read-only')
                self.refused(blockrand('rollback', folder), 4, 'read-only')
                self.assertEqual(blockrand('status', folder).code, 0)
                self.assertEqual(self.update(folder, self.changes, '--dry-run').code, 0)
            finally:
                call(['mount', '-o', 'remount,rw', disk])
            self.assertEqual(hashes(os.path.realpath(os.path.join(folder, 'current'))), before)
            self.update(folder, self.changes)

    def test_a_clock_that_jumps(self):
        """Files with times of tomorrow and of 1970: nothing is decided by a clock."""
        folder = self.region('clock')
        self.update(folder, SAMPLE)
        for at in (4e9, 0):
            for place, _, names in os.walk(folder):
                for name in names:
                    if not os.path.islink(os.path.join(place, name)):
                        os.utime(os.path.join(place, name), (at, at))
        self.update(folder, self.changes)
        self.same_files(self.current(folder), self.clean(self.map_, folder))
        self.assertEqual(blockrand('status', folder).code, 0)

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
        with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
            f.write('[build]\nlod = 1\n' + LIMITS_OFF)
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
        for night in range(100):
            self.map_.random_edits(random.Random(100 + night), 1)
            self.update(folder, self.map_.write_changes(self.path('r.osc')))
        stop.set()
        reader.join()
        self.assertEqual(problems, [])
        self.assertGreater(rounds[0], 20)


if __name__ == '__main__':
    main()
