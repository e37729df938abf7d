"""Work that is kept for later runs: it changes nothing but the time, whatever happened to it or to the run that kept it."""
import fcntl
import glob
import json
import os
import random
import shutil
import signal
import subprocess
import time

from blockrand_run import SAMPLE, SOURCE, BuildTest, Setup, blockrand, hashes, main, read_json
from interruption_test import small_disk
from osm_files import read_xml, town, write_xml
from region_run import Map

OPTIONS = ('--jobs', '2')
QUICK = ('--jobs', '2', '--lod', '1', '--formats', 'gltf,gpkg', '--no-report')
KILLED = ('--jobs', '2', '--lod', '3', '--formats', 'gltf,cityjson', '--no-report')


def tiles(folder):
    told = read_json(folder, 'run.json')['tiles']
    return told['built'], told['kept']


class Cache(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.town = write_xml(os.path.join(cls.folder, 'town.osm'), town(3000))

    def entries(self, cache, kind='*'):
        return sorted(glob.glob(os.path.join(cache, kind, '??', '*')))

    def lose_content(self, cache):
        """As a machine that goes down in the middle of a run: the disk has not all that was written."""
        for path in glob.glob(os.path.join(cache, 'tiles', '??', '*', '0')):
            stamp = os.stat(path)
            with open(path, 'r+b') as f:
                f.write(b'\0' * 16)
            os.utime(path, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
        with open(os.path.join(cache, 'open'), 'wb'):
            pass

    def test_a_second_run_takes_every_tile(self):
        for options in ((), ('--lod', '3'), ('--lod', '1', '--gzip')):
            with self.subTest(options):
                cache = self.path('kept' + ''.join(options))
                all_ = 4 if '3' in options else 3  # of LoD 3 a tile has nothing but surroundings
                plain = self.build(SAMPLE, 'plain', *options, *OPTIONS, '--force')
                first = self.build(SAMPLE, 'first', *options, *OPTIONS, '--force', '--cache', cache)
                self.same_files(plain, first)
                self.assertEqual(tiles(first), (all_, 0))
                second = self.build(SAMPLE, 'second', *options, '--jobs', '1', '--force', '--cache', cache)
                self.same_files(plain, second)
                self.hashes_match(second)
                self.assertEqual(tiles(second), (0, all_))

    def test_edits_build_what_they_touch(self):
        map_, cache = Map(read_xml(self.town)), self.path('edits')
        self.build(self.town, 'begin', *OPTIONS, '--cache', cache)
        houses = map_.ways('building')
        for way in (houses[0], houses[1500]):
            map_.edit(way, tags=dict(way.tags, height='31'))
            source = map_.write(self.path('edited.osm'))
            after = self.build(source, 'after', *OPTIONS, '--force', '--cache', cache)
            self.same_files(self.build(source, 'clean', *OPTIONS, '--force'), after)
            built, kept = tiles(after)
            self.assertGreater(kept, 2 * built, 'one house changed its height')

    def test_killed_runs_are_taken_up(self):
        """Ten runs that die at random instants; what they kept is whole, and the next ones go on with it."""
        plain = self.build(self.town, 'whole', *KILLED)
        all_tiles = sum(tiles(plain))
        cache, rng = self.path('killed'), random.Random(3)
        begun = time.monotonic()
        self.build(self.town, 'measured', *KILLED)
        lasts = time.monotonic() - begun
        for _ in range(10):
            run = subprocess.Popen([Setup.program, 'build', self.town, '-o', self.path('dies'), '--force', '--progress', 'none', *KILLED, '--cache', cache], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(rng.uniform(0, lasts))
            run.send_signal(signal.SIGKILL)
            run.wait()
        last = self.build(self.town, 'dies', *KILLED, '--force', '--cache', cache)
        self.same_files(plain, last)
        self.assertEqual(sum(tiles(last)), all_tiles)
        self.assertGreater(tiles(last)[1], 0, 'nothing of ten runs was kept')
        self.assertEqual(os.listdir(os.path.join(cache, 'new')), [])

    def test_damaged_entries(self):
        rng = random.Random(8)
        plain, cache = self.build(SAMPLE, 'sound', *QUICK), self.path('damaged')

        def flip(path):
            with open(path, 'r+b') as f:
                f.seek(rng.randrange(os.path.getsize(path)))
                at = f.tell()
                byte = f.read(1)
                f.seek(at)
                f.write(bytes([byte[0] ^ 1 << rng.randrange(8)]))

        def cut(path):
            os.truncate(path, os.path.getsize(path) // 2)

        def vanish(path):
            os.remove(path)

        def grow(path):
            with open(path, 'ab') as f:
                f.write(b'x' * 10000)

        def folder(path):
            os.remove(path)
            os.mkdir(path)

        for hurt in (flip, cut, vanish, grow, folder):
            for what in ('entry', '[0-9]*'):
                with self.subTest(f'{hurt.__name__} {what}'):
                    shutil.rmtree(cache, ignore_errors=True)
                    self.build(SAMPLE, 'first', *QUICK, '--force', '--cache', cache)
                    shutil.rmtree(self.path('first'))  # what is hurt is no file of a build
                    for path in glob.glob(os.path.join(cache, '*', '??', '*', what)):
                        hurt(path)
                    second = self.build(SAMPLE, 'second', *QUICK, '--force', '--cache', cache)
                    self.assertIn('damaged', self.last.err)
                    self.same_files(plain, second)
                    self.assertEqual(tiles(second), (3, 0))
                    third = self.build(SAMPLE, 'second', *QUICK, '--force', '--cache', cache)
                    self.same_files(plain, third)
                    self.assertEqual(tiles(third), (0, 3))

    def test_content_is_read_after_a_run_that_did_not_end(self):
        cache = self.path('torn')
        plain = self.build(SAMPLE, 'torn.plain', *OPTIONS)
        self.build(SAMPLE, 'torn.first', *OPTIONS, '--cache', cache)
        shutil.rmtree(self.path('torn.first'))
        self.lose_content(cache)
        again = self.build(SAMPLE, 'torn.again', *OPTIONS, '--cache', cache)
        self.same_files(plain, again)
        self.assertEqual(tiles(again), (3, 0))

    def test_settings_and_configs(self):
        """What a build is made of decides, not where its files lie; a rule file only where a building uses it."""
        configs, cache = self.path('configs'), self.path('settings')
        shutil.copytree(os.path.join(SOURCE, 'configs'), configs)
        houses = ('--lod', '3', '--surroundings', 'off')
        run = ('--configs', configs, *houses, *OPTIONS, '--force', '--cache', cache)
        self.build(SAMPLE, 'a', *run)
        self.assertEqual(tiles(self.build(SAMPLE, 'b', *houses, *OPTIONS, '--cache', cache)), (0, 3), 'the same configs elsewhere')
        self.assertEqual(tiles(self.build(SAMPLE, 'a', *run, '--seed', '2')), (3, 0))
        # Tables that every house is made with; then files that only decide, where the decision is the same.
        for file, built in (('styles/catalogue.toml', 3), ('defaults/uses.toml', 3), ('materials/materials.toml', 3),
                            ('styles/neighbours.toml', 3), ('styles/presets.toml', 0), ('districts/berlin.toml', 0)):
            with self.subTest(file), open(os.path.join(configs, file), 'a', encoding='utf-8') as f:
                f.write('\n# a remark\n')
                f.flush()
                self.assertEqual(tiles(self.build(SAMPLE, 'a', *run)), (built, 3 - built))
        used = self.presets_of(self.path('b'))
        book = os.path.join(configs, 'styles', 'presets.toml')
        with open(book, encoding='utf-8') as f:
            text = f.read()
        names = {}  # rule file: presets
        preset = None
        for line in text.splitlines():
            if line.startswith('['):
                preset = line.strip().strip('[]').split('.')[-1].strip('"')
            elif line.startswith('grammar') and preset:
                names.setdefault(line.split('"')[1], set()).add(preset)
        unused = next(file for file, presets in sorted(names.items()) if not presets & used)
        some = next(file for file, presets in sorted(names.items()) if presets & used)
        self.assertTrue(self.touch_rules(configs, unused))
        self.assertEqual(tiles(self.build(SAMPLE, 'a', *run)), (0, 3), f'no house uses {unused}')
        self.touch_rules(configs, some)
        self.assertGreater(tiles(self.build(SAMPLE, 'a', *run))[0], 0, f'houses use {some}')
        # What a preset states and promises counts where houses wear it.
        known = set().union(*names.values())
        for preset, worn in ((sorted(known - used)[0], False), (sorted(known & used)[0], True)):
            for table in ('measures]\nroof_pitch = 57\nstorey_height = 3.3\n', 'requirements]\nwindow_ratio = 9\n'):
                with open(book, 'a', encoding='utf-8') as f:
                    f.write(f'\n[{preset}.{table}')
                built = tiles(self.build(SAMPLE, 'a', *run))[0]
                self.assertEqual(built > 0, worn, preset + table)
        clean = self.build(SAMPLE, 'anew', '--configs', configs, *houses, *OPTIONS)
        self.same_files(clean, self.path('a'))

    def presets_of(self, folder):
        import gzip
        found = set()
        for path in glob.glob(os.path.join(folder, 'explain', '*.jsonl.gz')):
            with gzip.open(path, 'rt', encoding='utf-8') as f:
                for line in f:
                    for a in json.loads(line).get('attributes', []):
                        if a['name'] == 'preset':
                            found.add(a['value'])
        return found

    def touch_rules(self, configs, file):
        path = os.path.join(configs, 'grammars', file)
        with open(path, 'a', encoding='utf-8') as f:
            f.write('\n// a remark\n')
        return True

    def test_another_program(self):
        cache = self.path('older')
        self.build(SAMPLE, 'older.a', *OPTIONS, '--cache', cache)
        with open(os.path.join(cache, 'program'), 'w', encoding='utf-8') as f:
            f.write('blockrand kept work\n0.0.1 0000')
        self.build(SAMPLE, 'older.b', *OPTIONS, '--cache', cache)
        self.assertIn('another one', self.last.err)
        self.assertIn(str(len(self.entries(cache))), self.last.err.replace(',', ''))
        self.build(SAMPLE, 'older.b', *OPTIONS, '--cache', cache, '--force')
        self.assertNotIn('another one', self.last.err)

    def test_a_folder_of_others_loses_nothing(self):
        """Not even one that looks a little like kept work, nor what a link in kept work leads to."""
        others = self.path('others')
        for path in ('src/lib/deep/x', 'src/lib/main.c', 'new/sub/precious', 'program'):
            os.makedirs(os.path.dirname(os.path.join(others, path)), exist_ok=True)
            with open(os.path.join(others, path), 'w', encoding='utf-8') as f:
                f.write('mine')
        before = hashes(others)
        for what in (('cache', 'stat'), ('cache', 'verify'), ('cache', 'prune', '--keep-bytes', '0')):
            self.refused(blockrand(*what, others), 2, 'no kept work')
        self.refused(blockrand('build', SAMPLE, '-o', self.path('out'), '--cache', others), 1, 'not empty', target=self.path('out'))
        self.assertEqual(hashes(others), before)
        cache = self.path('linked')
        self.build(SAMPLE, 'linked.a', *OPTIONS, '--cache', cache)
        os.symlink(others, os.path.join(cache, 'photos'))
        os.makedirs(os.path.join(cache, 'notes', 'ab', 'letters'))
        self.assertEqual(blockrand('cache', 'verify', cache).code, 0)
        self.assertEqual(blockrand('cache', 'prune', cache, '--keep-bytes', '0').code, 0)
        self.assertEqual(hashes(others), before)
        self.assertTrue(os.path.isdir(os.path.join(cache, 'notes', 'ab', 'letters')))

    def test_links_in_kept_work_are_not_followed(self):
        cache, outside = self.path('trap'), self.path('outside')
        plain = self.build(SAMPLE, 'trap.plain', *OPTIONS)
        self.build(SAMPLE, 'trap.a', *OPTIONS, '--cache', cache)
        for number, path in enumerate(sorted(glob.glob(os.path.join(cache, 'tiles', '??', '*', '0')))):
            shutil.copy2(path, f'{outside}{number}')
            os.remove(path)
            os.symlink(f'{outside}{number}', path)
        kept = self.build(SAMPLE, 'trap.b', *OPTIONS, '--cache', cache)
        self.same_files(plain, kept)
        self.assertFalse(any(os.path.islink(os.path.join(kept, p)) for p in hashes(kept)))

    def test_killed_while_it_was_made(self):
        for left in (('new',), ('new', 'lock', 'open'), ('lock', 'program.new')):
            with self.subTest(left):
                cache = self.path('unmade' + '-'.join(left))
                os.makedirs(cache)
                for name in left:
                    if name == 'new':
                        os.mkdir(os.path.join(cache, name))
                    else:
                        with open(os.path.join(cache, name), 'wb'):
                            pass
                self.build(SAMPLE, 'unmade', *OPTIONS, '--force', '--cache', cache)
                self.assertEqual(tiles(self.build(SAMPLE, 'unmade', *OPTIONS, '--force', '--cache', cache)), (0, 3))

    def test_doubt_outlives_runs_that_fail(self):
        cache = self.path('doubt')
        plain = self.build(SAMPLE, 'doubt.plain', *OPTIONS)
        self.build(SAMPLE, 'doubt.first', *OPTIONS, '--cache', cache)
        shutil.rmtree(self.path('doubt.first'))
        self.lose_content(cache)
        with open(self.path('cut.osm'), 'w', encoding='utf-8') as f:
            f.write('<osm version="0.6"><node')
        self.assertEqual(blockrand('build', self.path('cut.osm'), '-o', self.path('doubt.cut'), '--cache', cache).code, 2)
        self.same_files(plain, self.build(SAMPLE, 'doubt.again', *OPTIONS, '--cache', cache))

    def test_terrain_by_way_of_others(self):
        """A VRT is the same file when the raster behind it is another one."""
        def raster(height):
            text = 'ncols 20\nnrows 20\nxllcorner 11.02\nyllcorner 51.46\ncellsize 0.001\n' + '\n'.join(' '.join([f'{height}.0'] * 20) for _ in range(20))
            with open(self.path('ground.asc'), 'w', encoding='utf-8') as f:
                f.write(text + '\n')
        raster(50)
        with open(self.path('ground.vrt'), 'w', encoding='utf-8') as f:
            f.write('<VRTDataset rasterXSize="20" rasterYSize="20"><SRS>EPSG:4326</SRS><GeoTransform>11.02, 0.001, 0, 51.48, 0, -0.001</GeoTransform>'
                    '<VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename relativeToVRT="1">ground.asc</SourceFilename>'
                    '<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>')
        options = ('--terrain', self.path('ground.vrt'), '--terrain-height-reference', 'sea-level', *OPTIONS)
        cache = self.path('heights')
        self.build(SAMPLE, 'at50', *options, '--cache', cache)
        raster(90)
        self.same_files(self.build(SAMPLE, 'at90.clean', *options), self.build(SAMPLE, 'at90', *options, '--cache', cache))
        self.assertEqual(tiles(self.path('at90')), (3, 0))
        self.assertNotEqual(hashes(self.path('at50'), 'tiles'), hashes(self.path('at90'), 'tiles'))

    def test_what_cannot_be_kept_is_said(self):
        cache = self.path('single')
        plain = self.build(SAMPLE, 'single.a', *OPTIONS, '--single-glb')
        for _ in range(2):
            kept = self.build(SAMPLE, 'single.b', *OPTIONS, '--single-glb', '--cache', cache, '--force')
            self.assertIn('every tile anew', self.last.err)
            self.same_files(plain, kept)

    def test_places(self):
        full = self.path('full')
        os.makedirs(full)
        with open(os.path.join(full, 'letter.txt'), 'w', encoding='utf-8') as f:
            f.write('of somebody')
        self.refused(blockrand('build', SAMPLE, '-o', self.path('out'), '--cache', full), 1, 'not empty', target=self.path('out'))
        self.assertEqual(os.listdir(full), ['letter.txt'])
        cache = self.path('busy')
        self.build(SAMPLE, 'busy.a', *OPTIONS, '--cache', cache)
        with open(os.path.join(cache, 'lock'), 'r+b') as f:
            fcntl.flock(f, fcntl.LOCK_EX)
            self.refused(blockrand('build', SAMPLE, '-o', self.path('out'), '--cache', cache), 1, 'another run', target=self.path('out'))
        for inside in (self.path('out'), self.path('out', 'cache')):
            self.refused(blockrand('build', SAMPLE, '-o', self.path('out'), '--cache', inside), 1, 'output folder', target=self.path('out'))
        self.build(SAMPLE, 'no.cache', *OPTIONS, '--cache', '/proc/no')
        self.assertIn('no work is kept', self.last.err)

    def test_a_full_disk_stops_keeping_not_building(self):
        with small_disk(self.path('disk'), 'size=200k') as disk:
            plain = self.build(SAMPLE, 'disk.plain', *OPTIONS)
            kept = self.build(SAMPLE, 'disk.kept', *OPTIONS, '--cache', os.path.join(disk, 'cache'))
            self.assertIn('could not be kept', self.last.err)
            self.same_files(plain, kept)

    def test_the_command(self):
        cache = self.path('asked')
        self.build(SAMPLE, 'asked.a', *OPTIONS, '--cache', cache)
        told = json.loads(blockrand('cache', 'stat', cache, '--json').out)
        self.assertEqual(told['entries'], len(self.entries(cache)))
        self.assertGreater(told['shared_bytes'], 0)
        self.assertEqual(blockrand('cache', 'verify', cache).code, 0)
        entry = glob.glob(os.path.join(cache, 'tiles', '??', '*', 'entry'))[0]
        os.truncate(entry, 10)
        run = blockrand('cache', 'verify', cache)
        self.assertEqual((run.code, '1 were damaged' in run.out), (3, True), run)
        self.assertEqual(blockrand('cache', 'verify', cache).code, 0)
        self.refused(blockrand('cache', 'prune', cache), 1, '--keep-bytes')
        run = blockrand('cache', 'prune', cache, '--keep-bytes', '0')
        self.assertEqual(run.code, 0, run)
        self.assertEqual(self.entries(cache), [])
        self.refused(blockrand('cache', 'stat', self.path('asked.a')), 2, 'no kept work')
        self.refused(blockrand('cache', 'polish', cache), 1, 'polish')


if __name__ == '__main__':
    main()
