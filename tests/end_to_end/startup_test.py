"""How the program starts: what it says before it works, standard input, a dry run, words for what was meant."""
import gzip
import bz2
import json
import contextlib
import os
import pty
import re
import shutil
import signal
import subprocess

from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, files_of, main, read_json

QUICK = ('--lod', '0', '--formats', 'gltf', '--no-report')


def piped(data, *arguments, cwd=None, **how):
    """A call with bytes, or a file, as standard input."""
    given = {'stdin': data} if hasattr(data, 'fileno') or isinstance(data, int) else {'input': data}
    done = subprocess.run([Setup.program, *map(str, arguments)], capture_output=True, cwd=cwd, timeout=300, **given, **how)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def sample_bytes():
    with open(SAMPLE, 'rb') as f:
        return f.read()


class StandardInput(BuildTest):
    def from_pipe(self, name, data, *options):
        code, out, err = piped(data, 'build', '-', '-o', self.path(name), '--progress', 'none', *QUICK, *options)
        self.assertEqual(code, 0, err)
        self.assertEqual([n for n in os.listdir(self.folder) if n.startswith('.')], [], 'the copy has no name')
        return self.path(name)

    def test_the_same_build_as_from_a_file(self):
        named = self.build(SAMPLE, 'named', *QUICK, '--name', 'stdin')
        for kind, data in (('xml', sample_bytes()), ('gz', gzip.compress(sample_bytes())), ('bz2', bz2.compress(sample_bytes()))):
            with self.subTest(kind=kind):
                self.same_files(named, self.from_pipe(kind, data))
        extract = read_json(self.path('xml'), 'run.json')['inputs'][0]
        self.assertEqual((extract['path'], extract['bytes']), ('standard input', os.path.getsize(SAMPLE)))
        for path in files_of(self.path('xml')):
            with open(self.path('xml', path), 'rb') as f:
                self.assertNotIn(b'/proc/self', f.read(), f'{path} tells where the copy lay')

    def test_pbf(self):
        if not shutil.which('osmium'):
            self.skipTest('osmium is not here')
        pbf = self.path('sample.osm.pbf')
        subprocess.run(['osmium', 'cat', SAMPLE, '-o', pbf, '--overwrite'], check=True, capture_output=True)
        with open(pbf, 'rb') as f:
            self.same_files(self.build(SAMPLE, 'again', *QUICK, '--name', 'stdin'), self.from_pipe('pbf', f.read()))

    def test_a_file_as_standard_input(self):
        with open(SAMPLE, 'rb') as f:
            code, out, err = piped(f, 'info', '-', '--json', '--lod', '2')
        self.assertEqual(code, 0, err)
        info = json.loads(out)
        self.assertEqual((info['file'], info['bytes']), ('standard input', os.path.getsize(SAMPLE)))
        self.assertGreater(info['to_build'], 100)

    def test_name(self):
        out = self.from_pipe('by_name', sample_bytes(), '--name', 'A quarter')
        with open(os.path.join(out, 'tileset.json'), encoding='utf-8') as f:
            self.assertNotIn('/proc', f.read())

    def test_what_is_no_extract(self):
        for name, data, words in (('empty', b'', ['standard input', 'empty']), ('noise', b'no map at all', ['standard input', 'no OSM data']),
                                  ('o5m', b'\xff\xe0\x04o5m2' + bytes(40), ['o5m', 'osmium cat']), ('cut', sample_bytes()[:5000], ['standard input', 'line']),
                                  ('changes', b'<osmChange version="0.6"></osmChange>', ['change file'])):
            with self.subTest(name=name):
                code, _, err = piped(data, 'build', '-', '-o', self.path('no'), '--progress', 'none', *QUICK)
                self.assertEqual(code, 2, err)
                for word in words:
                    self.assertIn(word, err)
                self.assertNotIn('/proc/', err)
                self.assertEqual([n for n in os.listdir(self.folder) if n.startswith(('.', 'no'))], [])

    def test_a_terminal(self):
        ours, theirs = pty.openpty()
        try:
            for command in (('build', '-', '-o', self.path('no')), ('info', '-')):
                code, _, err = piped(theirs, *command)
                self.assertEqual(code, 1, err)
                self.assertIn('terminal', err)
        finally:
            os.close(ours)
            os.close(theirs)
        code, _, err = piped(None, 'info', '-', preexec_fn=lambda: os.close(0))
        self.assertEqual(code, 1, err)
        self.assertIn('closed', err)

    def test_nothing_stays_after_an_interruption(self):
        run = subprocess.Popen([Setup.program, 'build', '-', '-o', self.path('cut_off'), '--progress', 'none'], stdin=subprocess.PIPE,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        # More than a pipe holds: it is written when the program reads.
        run.stdin.write(sample_bytes()[:60000] + b' ' * 300_000)
        run.stdin.flush()
        run.send_signal(signal.SIGINT)
        run.wait(60)  # with its input open: what ends that way is no interruption
        err = run.stderr.read().decode()
        run.stderr.close()
        with contextlib.suppress(BrokenPipeError):
            run.stdin.close()
        self.assertEqual(run.returncode, 128 + signal.SIGINT, err)
        self.assertEqual([n for n in os.listdir(self.folder) if 'cut_off' in n or n.startswith('.')], [])


class DryRun(BuildTest):
    def plan(self, *arguments, code=0):
        before = {p: os.lstat(os.path.join(self.folder, p)).st_mtime_ns for p in files_of(self.folder)}
        folders = sorted(p for p, _, _ in os.walk(self.folder))
        run = blockrand('build', *arguments, '--dry-run', '--progress', 'none', cwd=self.folder, env={'TMPDIR': self.folder})
        self.assertEqual(run.code, code, run)
        self.assertEqual(before, {p: os.lstat(os.path.join(self.folder, p)).st_mtime_ns for p in files_of(self.folder)}, 'something was written')
        self.assertEqual(folders, sorted(p for p, _, _ in os.walk(self.folder)))
        return run

    def test_tells_what_would_be_built(self):
        target = self.path('deep', 'town')
        run = self.plan(SAMPLE, '-o', target)
        for word in ('EPSG:25832', target, 'tileset.json', 'buildings.gpkg', 'report.html', 'level of detail 3', 'of memory', 'of disk', 'Nothing was written'):
            self.assertIn(word, run.out)
        self.assertIn('--ground-height', run.err, 'it warns as the build would')
        plan = json.loads(self.plan(SAMPLE, '-o', target, '--log-format', 'json', '--formats', 'gltf').out)
        self.assertNotIn('buildings.gpkg', plan['files'])
        self.assertIn('tileset.json', plan['files'])

    def test_what_it_tells_comes_true(self):
        options = ('--lod', '3', '--jobs', '2', '--ground-height', '150')
        plan = json.loads(self.plan(SAMPLE, '-o', self.path('true'), '--log-format', 'json', *options).out)
        out = self.build(SAMPLE, 'true', *options)
        build, run = read_json(out, 'build.json'), read_json(out, 'run.json')
        self.assertEqual((plan['buildings_in'], plan['parts_in']), (build['counts']['buildings_in'], build['counts']['parts_in']))
        self.assertEqual(plan['tiles'], len([p for p in files_of(os.path.join(out, 'citygml')) if 'surroundings' not in p]), 'tiles with houses')
        disk = sum(f['bytes'] for f in build['files'].values())
        for what, told, real in (('disk', plan['estimate']['disk_bytes'], disk), ('memory', plan['estimate']['memory_bytes'], run['peak_rss_bytes'])):
            self.assertTrue(real / 1.5 < told < 1.5 * real, f'{what}: {told} told, {real} taken')
        again = self.plan(SAMPLE, '-o', out, '--force', *options)
        self.assertIn('in place of the build', again.out)
        self.refused(self.plan(SAMPLE, '-o', out, code=1), 1, '--force')
        small = self.place('small.osm', '<osm version="0.6"><node id="1" lat="51.47" lon="11.03"/></osm>')
        self.refused(self.plan(small, '-o', out, '--force', code=2), 2, '--allow-empty')

    def test_errors_are_those_of_the_build(self):
        bad = self.place('bad.toml', '[w1]\nheigth = 3\n')
        other = self.place('notes/letter.txt', 'x') if os.makedirs(self.path('notes'), exist_ok=True) is None else None
        for code, words, arguments in ((2, ['no such file'], [self.path('absent.osm')]), (2, ['bad.toml', 'height'], [SAMPLE, '--overrides', bad]),
                                       (2, ['absent.tif'], [SAMPLE, '--terrain', self.path('absent.tif')]), (1, ['EPSG:4326'], [SAMPLE, '--crs', 'EPSG:4326']),
                                       (2, ['absent.tif'], [SAMPLE, '--imagery', self.path('absent.tif')]),
                                       (2, ['line'], [self.place('cut.osm', sample_bytes()[:9000])]), (1, ['--single-glb'], [SAMPLE, '--areas', '12', '--single-glb'])):
            with self.subTest(words=words):
                self.refused(self.plan(*arguments, '-o', self.path('no'), code=code), code, *words)
        self.refused(self.plan(SAMPLE, '-o', os.path.dirname(other), code=1), 1, 'not empty')
        self.refused(self.plan(SAMPLE, '-o', self.path('bad.toml'), code=1), 1, 'is a file')
        if os.geteuid() != 0:
            os.makedirs(self.path('locked'), 0o500, exist_ok=True)
            self.refused(self.plan(SAMPLE, '-o', self.path('locked', 'out'), code=4), 4, 'permission')


class Meant(BuildTest):
    """A clear word for what was meant."""

    def test_did_you_mean(self):
        bad = [(['biuld'], 'build'), (['help', 'biuld'], 'build'), (['help', 'OPEN_WAI'], 'OPEN_WAY'), (['help', 'options', '--makrdown'], '--markdown'),
               (['help', 'completion', 'bsh'], 'bash'), (['build', SAMPLE, '-o', 'x', '--formats', 'gtlf'], 'gltf'),
               (['build', SAMPLE, '-o', 'x', '--instancing', 'bakd'], 'baked'), (['build', SAMPLE, '-o', 'x', '--districts', 'leipzg'], 'leipzig'),
               (['build', SAMPLE, '-o', 'x', '--progress', 'plian'], 'plain'), (['build', SAMPLE, '-o', 'x', '--dryrun'], '--dry-run'),
               (['region', 'repiar', 'x'], 'repair'), (['cache', 'prnue', 'x'], 'prune'), (['districts', 'chekc'], 'check'), (['grammar', 'tets', 'x'], 'test')]
        for arguments, meant in bad:
            with self.subTest(arguments=arguments[:3]):
                run = blockrand(*arguments)
                self.assertEqual(run.code, 1, run)
                self.assertRegex(run.err, rf'Did you mean (\S* )?{meant}\b', run)
        for key, text, meant in (('config', '[build]\nlodd = 2\n', 'lod'), ('overrides', '[w1]\nheigth = 3\n', 'height'), ('overrides', '[w1]\npreset = "Berlin_Mietskasern"\n', None),
                                 ('overrides', '[w1]\nroof_shape = "gabeld"\n', 'gabled')):
            with self.subTest(text=text):
                run = blockrand('build', SAMPLE, '-o', self.path('no'), f'--{key}', self.place(key + '.toml', text))
                self.assertEqual(run.code, 2, run)
                if meant:
                    self.assertRegex(run.err, rf'Did you mean (\S*\.)?{meant}\b', run)
        self.assertRegex(blockrand('help', 'OPEN_WAY').out, '^OPEN_WAY: .*not closed')

    def test_another_kind_of_path(self):
        out = self.build(SAMPLE, 'a build', *QUICK)
        for command in (('build', out, '-o', self.path('no')), ('info', out)):
            self.refused(blockrand(*command), 2, 'is a build', 'blockrand validate', target=self.path('no'))
        region = self.path('region')
        os.makedirs(region)
        self.place('region/region.toml', '')
        self.refused(blockrand('info', region), 2, 'is a region', 'blockrand update')
        shutil.copy(SAMPLE, os.path.join(out, '..', 'region', 'town.osm'))
        for command in (('explain', SAMPLE, 'w1'), ('validate', SAMPLE)):
            self.refused(blockrand(*command), 1, 'is an extract', 'blockrand build', 'blockrand info')
        for command in (('explain', region, 'w1'), ('validate', region)):
            self.refused(blockrand(*command), 1, 'is a region', 'no build yet')
        self.refused(blockrand('explain', os.path.join(out, 'tileset.json'), 'w1'), 1, 'a file of a build', out)
        self.refused(blockrand('info', self.place('x.osc.gz', 'x')), 2, 'change file', 'blockrand update')
        os.makedirs(self.path('holds_one'))
        shutil.copy(SAMPLE, self.path('holds_one', 'town.osm'))
        self.refused(blockrand('info', self.path('holds_one')), 2, 'holds_one/town.osm')

    def test_options_that_are_not_read(self):
        for arguments, words in ((['info', SAMPLE, '--strict'], ['--strict', 'build']), (['districts', 'check', '--bbox', '1,1,2,2'], ['--bbox', 'districts show']),
                                 (['grammar', 'check', 'x.cga', '--lot', '3x4'], ['--lot', 'grammar run']), (['districts', 'diff', 'a', 'b', SAMPLE, '--by', 'rule'], ['--by', 'show'])):
            with self.subTest(arguments=arguments):
                self.refused(blockrand(*arguments), 1, *words)


class BeforeReading(BuildTest):
    """What needs no extract is told before one is read: here one that cannot be read at all."""

    def test_all(self):
        broken = self.place('broken.osm', b'<osm version="0.6"><node id="1" lat="51.47" lon="11.03"/>' + b' ' * 100)
        self.refused(blockrand('build', broken, '-o', self.path('no')), 2, 'broken.osm', target=self.path('no'))
        for code, words, options in ((1, ['not a projected'], ['--crs', 'EPSG:4326']), (1, ['not a projected'], ['--crs', 'EPSG:5773']), (1, ['unknown to PROJ'], ['--crs', 'EPSG:99999']),
                                     (1, ['not in metres'], ['--crs', 'EPSG:2263']), (2, ['absent.tif'], ['--terrain', 'absent.tif']), (2, ['absent.toml'], ['--overrides', 'absent.toml']),
                                     (1, ['nowhere'], ['--districts', 'nowhere'])):
            for where in ([], ['--areas', '12']):
                with self.subTest(options=options, where=where):
                    self.refused(blockrand('build', broken, '-o', self.path('no'), *options, *where), code, *words, target=self.path('no'))
        for command in (['info', broken], ['districts', 'show', broken, '-o', self.path('no')]):
            self.refused(blockrand(*command, '--crs', 'EPSG:4326'), 1, 'not a projected')


class Libraries(BuildTest):
    """What a command does not need is not loaded: GDAL and PROJ bring ninety libraries."""

    def loaded(self, *arguments):
        done = subprocess.run([Setup.program, *map(str, arguments)], capture_output=True, text=True, timeout=300, env={**os.environ, 'LD_DEBUG': 'files', 'LD_DEBUG_OUTPUT': self.path('loaded')})
        self.assertEqual(done.returncode, 0, done.stderr)
        names = set()
        for file in os.listdir(self.folder):
            if file.startswith('loaded.'):
                with open(self.path(file), encoding='utf-8', errors='replace') as f:
                    names.update(re.findall(r'file=([^\s/]+\.so[.\d]*) \[\d+\];  (?:needed|dynamically)', f.read()))
                os.remove(self.path(file))
        return names

    def test_version(self):
        names = self.loaded('--version')
        self.assertTrue(any(n.startswith('libc.so') for n in names), names)
        self.assertLess(len(names), 40, sorted(names))
        self.assertFalse([n for n in names if n.startswith(('libgdal', 'libproj'))])

    def test_a_build_that_needs_no_gdal(self):
        names = self.loaded('build', SAMPLE, '-o', self.path('gltf'), *QUICK)
        self.assertTrue(any(n.startswith('libproj') for n in names))
        self.assertFalse([n for n in names if n.startswith('libgdal')])
        names = self.loaded('build', SAMPLE, '-o', self.path('gpkg'), '--lod', '0', '--formats', 'gpkg', '--no-report')
        self.assertTrue(any(n.startswith('libgdal') for n in names))


if __name__ == '__main__':
    main()
