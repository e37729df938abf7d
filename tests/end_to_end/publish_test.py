"""Builds sent to web roots, by commands and into archives: no reader is ever led to a missing file; what breaks off goes on."""
import gzip
import hashlib
import json
import os
import random
import shutil
import signal
import struct
import subprocess
import time
import unittest
import zipfile

from blockrand_run import SAMPLE, Setup, blockrand, extract, files_of, hashes, main, read_json, sha256
from osm_files import read_xml
from region_run import LIMITS_OFF, Map, RegionTest
from web_reader import Reader, reading, web_server

HERE = os.path.dirname(os.path.abspath(__file__))
TILES = '[build]\nformats = "gltf,gpkg"\nreport = false\n'
# A command as docs/publishing.md has it: copies, or removes, what the list names; notes how it was called.
COPY = '''
echo "$BLOCKRAND_ACTION $BLOCKRAND_STEP $BLOCKRAND_CALL/$BLOCKRAND_CALLS" >> "{log}"
test -e "{fail}" && test ! -s "{fail}" && exit 7
mkdir -p "{to}"
cmp -s "$BLOCKRAND_LIST" - || exit 8
if [ "$BLOCKRAND_ACTION" = put ]; then
  if test -s "{fail}" && test "$(cat "{fail}")" = "$BLOCKRAND_CALL"; then  # half of this call
    cd "$BLOCKRAND_SOURCE" && cp -p --parents -t "{to}" "$(head -n 1 "$BLOCKRAND_LIST")"; exit 7
  fi
  (cd "$BLOCKRAND_SOURCE" && xargs -0 cp -p --parents -t "{to}") < "$BLOCKRAND_LIST0"
else
  (cd "{to}" && xargs -0 rm -f --) < "$BLOCKRAND_LIST0"
fi
while read -r path; do echo "$BLOCKRAND_ACTION $path" >> "{log}.files"; done < "$BLOCKRAND_LIST"
'''


def named_by(build):
    """{path: sha256} of what a build and its areas name, with their records."""
    record = read_json(build, 'build.json')
    files = {p: e['sha256'] for p, e in record['files'].items()}
    files['build.json'] = sha256(os.path.join(build, 'build.json'))
    for area in record.get('areas', {}):
        files.update({f'areas/{area}/{p}': h for p, h in named_by(os.path.join(build, 'areas', area)).items()})
    return files


class Outward(RegionTest):
    def command(self, name):
        """A command that copies into a folder. \\returns (its text, that folder, its log, a file that makes it fail)"""
        places = {k: self.path(name, k) for k in ('to', 'log', 'fail')}
        shutil.rmtree(self.path(name), ignore_errors=True)
        os.makedirs(self.path(name))
        script = self.path(name, 'copy.sh')
        with open(script, 'w', encoding='utf-8') as f:
            f.write(COPY.format(**places))
        return f'sh {script}', places['to'], places['log'], places['fail']

    def publish(self, *arguments, code=0, **how):
        run = blockrand('publish', *arguments, '--progress', 'none', **how)
        self.assertEqual(run.code, code, run)
        return run

    def lies_there(self, folder, build, but=()):
        self.assertEqual({p: h for p, h in hashes(folder).items() if p not in but}, named_by(build))

    def test_a_reader_is_never_led_to_a_missing_file(self):
        """Nights with edits, published to a web root while a reader walks it."""
        rng, map_ = random.Random(11), Map(read_xml(SAMPLE))
        grace = 120  # s: many times what a walk takes
        folder = self.region('web', LIMITS_OFF + TILES + f'textures = "shared"\n[publish]\nweb_root = "../www"\nkeep_deleted = {grace / 3600}\n')
        run = self.update(folder, map_.write(self.path('web.osm')))
        self.assertIn('published outward: web-root', run.out)
        www = self.path('www')
        self.lies_there(www, self.current(folder))
        with web_server(www) as port:
            with reading(port) as reader:
                for night in range(5):
                    # Houses leave a tile for good and come back: tiles vanish, and their names come again.
                    if night == 2:
                        self.tile_of_its_own(map_)
                    map_.random_edits(rng, 15)
                    if night == 3:
                        self.tile_goes(map_)
                    self.update(folder, map_.write_changes(self.path(f'web{night}.osc')))
                    if night == 3:
                        left = set(files_of(www)) - set(named_by(self.current(folder)))
                        self.assertTrue(left, 'the tile that went is there for a while')
            self.assertEqual(reader.problems, [])
            self.assertGreater(reader.walks, 5)
            self.assertGreater(len(Reader(port).walk()), 5)
            # What this test would see.
            tile = next(p for p in files_of(www) if p.endswith('.glb'))
            os.rename(os.path.join(www, tile), os.path.join(www, 'elsewhere'))
            blind = Reader(port)
            blind.walk()
            self.assertEqual(len(blind.problems), 1, blind.problems)
            os.rename(os.path.join(www, 'elsewhere'), os.path.join(www, tile))
        self.publish(folder, '--keep-deleted', '0')
        self.lies_there(www, self.current(folder))

    def tile_of_its_own(self, map_):
        """A house so far away that its tile is its own."""
        from osm_files import house
        self.far = house(900000, 11.6, 51.6)
        for o in self.far:
            map_.put(o)

    def tile_goes(self, map_):
        for o in reversed(self.far):
            map_.delete(o)

    def test_a_command_gets_lists_in_order(self):
        command, to, log, fail = self.command('by_command')
        build = self.build(SAMPLE, 'one', '--textures', 'shared')
        self.publish(build, '--command', command, '--batch', '20')
        self.lies_there(to, build)
        with open(log, encoding='utf-8') as f:
            steps = [line.split()[1] for line in f]
        order = ['contents', 'tiles', 'tilesets', 'documents', 'record']
        self.assertEqual(sorted(steps, key=order.index), steps)
        self.assertEqual(set(steps), set(order))
        self.assertGreater(steps.count('contents'), 1, '--batch divides')
        with open(log + '.files', encoding='utf-8') as f:
            sent = f.read().split('\n')
        self.assertEqual(sent[-2], 'put build.json')
        self.assertLess(max(i for i, p in enumerate(sent) if p.endswith('.glb')), sent.index('put tileset.json'))
        self.assertLess(max(i for i, p in enumerate(sent) if 'textures/' in p), min(i for i, p in enumerate(sent) if p.endswith('.glb')))
        # Again: nothing to do, and the command is not called.
        os.remove(log)
        self.publish(build, '--command', command)
        self.assertFalse(os.path.exists(log))
        self.assertEqual(sorted(os.listdir(build + '.outward')), ['last.json', 'lock', 'web.command.state'])

    def test_what_breaks_off_goes_on(self):
        command, to, log, fail = self.command('breaks_off')
        map_ = Map(read_xml(SAMPLE))
        folder = self.region('breaks', LIMITS_OFF + TILES + f"[publish]\ncommand = '{command}'\nbatch = 2\nkeep_deleted = 0\n")
        open(fail, 'w', encoding='utf-8').close()
        run = self.update(folder, map_.write(self.path('breaks.osm')), code=6)
        self.assertIn('build 1 is published', run.out, 'what fails outward takes nothing back')
        self.assertIn('ended with exit code 7', run.err)
        self.assertIn(f'To do: blockrand publish {folder}', run.err)
        self.stands(folder, '000001')
        self.assertIn('outward, to do: command web', blockrand('status', folder).out)
        self.assertTrue(json.loads(blockrand('status', folder, '--json').out)['outward_to_do'])
        self.refused(blockrand('publish', folder, '--progress', 'none'), 4, 'exit code 7')
        os.remove(fail)
        self.publish(folder)
        self.lies_there(to, self.current(folder))
        self.assertNotIn('outward', blockrand('status', folder).out)
        # A night with nothing new takes up what is to do.
        os.remove(os.path.join(folder, 'outward', 'web.command.state'))
        shutil.rmtree(to)
        self.assertIn('up to date', self.update(folder).out)
        self.lies_there(to, self.current(folder))
        # Broken off in the middle: the next one sends what is in doubt and what was not reached, and no more.
        before = named_by(self.current(folder))
        map_.random_edits(random.Random(4), 20)
        reached, failing = 4, 5
        with open(fail, 'w', encoding='utf-8') as f:
            f.write(str(failing))
        os.remove(log + '.files')
        run = self.update(folder, map_.write_changes(self.path('breaks.osc')), code=6)
        self.assertIn(f'call {failing} of', run.err)
        done = self.paths_put(log)
        self.assertTrue(reached <= len(done) <= reached * 2, done)  # the last list of a step may be shorter
        now = named_by(self.current(folder))
        changed = {p for p, h in now.items() if before.get(p) != h}
        self.assertLess(set(done), changed)
        os.remove(fail)
        os.remove(log + '.files')
        self.publish(folder)
        self.assertEqual(sorted(self.paths_put(log)), sorted(changed - set(done)))
        self.lies_there(to, self.current(folder))
        # Back to the build before: what differs is sent again.
        blockrand('rollback', folder)
        self.assertIn('to do', blockrand('status', folder).out)
        self.publish(folder)
        self.lies_there(to, self.current(folder))

    def paths_put(self, log):
        with open(log + '.files', encoding='utf-8') as f:
            return [line.split()[1] for line in f if line.startswith('put ')]

    def test_what_a_command_started_ends_with_the_program(self):
        build = self.build(SAMPLE, 'ended', '--formats', 'gltf', '--no-report')
        for number in (signal.SIGTERM, signal.SIGKILL):
            noted = self.path(f'grandchild{number}')
            run = subprocess.Popen([Setup.program, 'publish', build, '--progress', 'none', '--command',
                                    f"sh -c 'echo $$ > {noted}.part; mv {noted}.part {noted}; sleep 300; true'; true"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
            self.until(lambda noted=noted: os.path.exists(noted), 'the command runs')
            with open(noted, encoding='utf-8') as f:
                started = int(f.read())
            self.until(lambda started=started: self.children(started), 'it has started another one')
            processes = [started, *self.children(started)]
            self.assertEqual(len(processes), 2)
            run.send_signal(number)
            run.wait()
            self.until(lambda processes=processes: not any(map(self.runs, processes)), f'all of them end after signal {number}')

    def until(self, what, words):
        for _ in range(600):
            if what():
                return
            time.sleep(0.1)
        self.fail(words + ': not within a minute')

    @staticmethod
    def children(pid):
        with open(f'/proc/{pid}/task/{pid}/children', encoding='utf-8') as f:
            return [int(child) for child in f.read().split()]

    @staticmethod
    def runs(pid):
        try:
            with open(f'/proc/{pid}/stat', encoding='utf-8') as f:
                return f.read().rsplit(')', 1)[1].split()[0] != 'Z'
        except OSError:
            return False

    def test_a_command_that_fails_is_seen_whatever_is_inherited(self):
        """A caller that ignores SIGCHLD hands that on, and the kernel then forgets how processes ended."""
        build = self.build(SAMPLE, 'inherited', '--formats', 'gltf', '--no-report')
        ignoring = 'trap "" CHLD; exec "$0" "$@"'
        for command, code in (('exit 7', 4), ('kill -9 $$', 4), ('exit 0', 0)):
            run = subprocess.run(['bash', '-c', ignoring, Setup.program, 'publish', build, '--progress', 'none', '--command', command],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertEqual(run.returncode, code, (command, run))

    def test_status_tells_of_each_place(self):
        folder = self.region('places', LIMITS_OFF + '[build]\nformats = "gltf"\nreport = false\n[publish]\nweb_root = "../places_www"\n')
        self.update(folder, SAMPLE)
        self.assertNotIn('outward', blockrand('status', folder).out)
        command, to, log, fail = self.command('by_hand')
        open(fail, 'w', encoding='utf-8').close()
        self.publish(folder, '--command', command, '--web-root', self.path('other_place'), code=4)
        parts = {(p['what'], p['place']): p['failure'] for p in read_json(folder, 'outward', 'last.json')['parts']}
        self.assertEqual(len(parts), 3, parts)
        self.assertIsNone(parts['web-root', self.path('places_www')], 'another place by hand does not take its entry')
        self.assertIn('exit code 7', parts['command', 'web'])
        # A damaged build is a failure of each place.
        tile = os.path.join(self.current(folder), 'tileset.json')
        os.rename(tile, tile + '.away')
        self.publish(folder, code=2)
        to_do = [line for line in blockrand('status', folder).out.split('\n') if 'outward, to do' in line]
        self.assertTrue(any('places_www' in line and 'tileset.json' in line for line in to_do), to_do)
        os.rename(tile + '.away', tile)
        # The next night has the places of region.toml alone.
        self.assertIn('up to date', self.update(folder).out)
        self.assertNotIn('outward', blockrand('status', folder).out)

    def test_a_web_root_is_mended(self):
        build, www = self.build(SAMPLE, 'mended'), self.path('mended_www')
        self.publish(build, '--web-root', www)
        os.remove(os.path.join(www, 'tileset.json'))
        with open(os.path.join(www, 'build.json'), 'w', encoding='utf-8') as f:
            f.write('{}')
        planned = self.publish(build, '--web-root', www, '--dry-run').out
        self.assertIn('0 files to send', planned, 'what others did there is not seen')
        self.publish(build, '--web-root', www, '--resend')
        self.lies_there(www, build)
        # Another web root: all is sent.
        self.publish(build, '--web-root', self.path('other_www'))
        self.lies_there(self.path('other_www'), build)

    def test_areas(self):
        source = extract('monaco-2021.osm.pbf')
        if not source:
            self.skipTest('the shared data is absent')
        command, to, log, fail = self.command('areas')
        build = self.build(source, 'in_areas', '--areas', '13', '--formats', 'gltf', '--no-report')
        self.publish(build, '--command', command)
        self.lies_there(to, build)
        with open(log + '.files', encoding='utf-8') as f:
            sent = [line.split()[1] for line in f]
        of_areas = [i for i, p in enumerate(sent) if p.endswith('/tileset.json')]
        self.assertEqual(len(of_areas), len(read_json(build, 'build.json')['areas']))
        self.assertLess(max(of_areas), sent.index('tileset.json'))
        self.assertEqual(sent[-1], 'build.json')
        with web_server(to) as port:
            reader = Reader(port)
            self.assertGreater(len(reader.walk()), len(of_areas) * 2)
            self.assertEqual(reader.problems, [])
        self.archive_is_whole(build, self.path('areas.3tz'))

    def archive_is_whole(self, build, path):
        """Reads an archive as its format says (3D Tiles Archive Format 1.3): by the index, and by python's zipfile."""
        self.publish(build, '--archive', path)
        with zipfile.ZipFile(path) as archive, open(path, 'rb') as raw:
            names = archive.namelist()
            self.assertIsNone(archive.testzip())
            self.assertEqual(names[-1], '@3dtilesIndex1@')
            self.assertEqual(archive.getinfo(names[-1]).compress_type, zipfile.ZIP_STORED)
            index = archive.read(names[-1])
            entries = [(index[i:i + 16], struct.unpack('<Q', index[i + 16:i + 24])[0]) for i in range(0, len(index), 24)]
            self.assertEqual(len(entries), len(names) - 1)
            self.assertEqual(entries, sorted(entries, key=lambda e: struct.unpack('<QQ', e[0])))
            by_hash = dict(entries)

            def read(name):
                """As a reader does that looks into the index alone."""
                raw.seek(by_hash[hashlib.md5(name.encode()).digest()])
                head = struct.unpack('<4sHHHHHIIIHH', raw.read(30))
                self.assertEqual(head[0], b'PK\x03\x04')
                self.assertEqual(raw.read(head[9]).decode(), name)
                raw.read(head[10])
                data = raw.read(head[7])
                import zlib
                return zlib.decompress(data, -15) if head[3] == 8 else data
            wanted = named_by(build)
            waiting, seen = ['tileset.json'], set()
            while waiting:
                name = waiting.pop()
                if name in seen:
                    continue
                seen.add(name)
                body = read(name)
                self.assertEqual(hashlib.sha256(body).hexdigest(), wanted[name])
                links = Reader(0).links(name, body)
                waiting += [os.path.normpath(os.path.join(os.path.dirname(name), uri)) for uri in links if not uri.startswith('data:')]
            self.assertEqual(seen, set(names[:-1]), 'all that is reachable, and nothing else')
        first = sha256(path)
        self.publish(build, '--archive', path)
        self.assertEqual(sha256(path), first, 'the same build gives the same bytes')

    def test_archive(self):
        self.archive_is_whole(self.build(SAMPLE, 'archived', '--textures', 'shared'), self.path('sample.3tz'))
        build = self.build(SAMPLE, 'no_tiles', '--formats', 'gpkg')
        self.refused(blockrand('publish', build, '--archive', self.path('x.3tz')), 1, 'has no tileset.json')
        self.refused(blockrand('publish', build, '--archive', self.path('x.zip')), 1, 'ends with .3tz')

    def test_variants(self):
        build, www = self.build(SAMPLE, 'packed'), self.path('packed_www')
        self.publish(build, '--web-root', self.path('turned_on'))
        planned = self.publish(build, '--web-root', self.path('turned_on'), '--variants', 'gzip', '--dry-run').out
        self.assertIn(f'{len(named_by(build))} files to send', planned, 'turned on, it sends all again')
        shutil.rmtree(build + '.outward')
        self.publish(build, '--web-root', www, '--variants', 'gzip')
        packed = [p for p in files_of(www) if p.endswith('.gz') and p[:-3] in named_by(build)]
        self.assertIn('report.json.gz', packed)
        self.assertNotIn('plan.png.gz', packed)
        for path in packed:
            with gzip.open(os.path.join(www, path), 'rb') as f, open(os.path.join(build, path[:-3]), 'rb') as plain:
                self.assertEqual(f.read(), plain.read(), path)
            self.assertLessEqual(os.path.getsize(os.path.join(www, path)), 0.9 * os.path.getsize(os.path.join(build, path[:-3])))
        before = hashes(www)
        shutil.rmtree(www)
        self.publish(build, '--web-root', www, '--variants', 'gzip', '--resend')
        self.assertEqual(hashes(www), before, 'the same bytes each time')
        command, to, log, fail = self.command('packed_by_command')
        self.publish(build, '--command', command, '--variants', 'gzip', '--batch', '5')
        self.assertEqual(hashes(to), before)
        self.publish(build, '--web-root', www)
        self.lies_there(www, build)

    def test_what_makes_no_sense_is_refused(self):
        build = self.build(SAMPLE, 'refusing', '--formats', 'gltf', '--no-report')
        self.refused(blockrand('publish', build), 1, 'nowhere to send to')
        self.refused(blockrand('publish', self.path('nothing')), 1, 'no region and no build')
        self.refused(blockrand('publish', build, '--web-root', build), 1, 'lies in the build')
        self.refused(blockrand('publish', build, '--web-root', os.path.join(build, 'deep', 'www')), 1, 'lies in the build')
        for dry in ([], ['--dry-run']):
            self.refused(blockrand('publish', build, '--archive', os.path.join(build, 'a.3tz'), *dry), 1, 'lies in the build')
        self.refused(blockrand('publish', build, '--web-root', self.path('w'), '--target', 'a/b'), 1, 'no name of a target')
        self.refused(blockrand('publish', build, '--postgis', 'PG:dbname=x'), 1, 'has no GeoPackage')
        folder = self.region('secret', LIMITS_OFF + '[publish]\npostgis = "PG:dbname=x password=hush"\n')
        for command in (['publish', folder], ['update', folder, SAMPLE], ['status', folder]):
            run = blockrand(*command)
            self.refused(run, 2, 'holds a password')
            self.assertNotIn('hush', run.out + run.err)
        # A build that lost a tile is not sent.
        tile = next(p for p in files_of(build) if p.endswith('.glb'))
        os.remove(os.path.join(build, tile))
        command, to, log, fail = self.command('damaged')
        self.refused(blockrand('publish', build, '--command', command), 2, os.path.basename(tile))
        self.assertFalse(os.path.exists(os.path.join(to, 'tileset.json')))


if __name__ == '__main__':
    main()
