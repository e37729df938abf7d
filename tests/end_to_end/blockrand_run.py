"""What the end-to-end tests share: running the program as a user does, and looking at what it left behind.

Every test file runs alone, from ctest or by hand:

    python3 tests/end_to_end/sample_test.py [--program build/release/bin/blockrand] [unittest's own options]

The places of program, data and node modules are options with a search behind each. Exit code 77 means that
nothing could be tested because data or tools are absent (ctest's SKIP_RETURN_CODE).
"""
import argparse
import hashlib
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SAMPLE = os.path.join(SOURCE, 'samples', 'blockrand-viertel.osm')
SKIPPED = 77

# What report.json may say about an object whose outline cannot be built at all, or that is not there to be built.
NO_WHOLE_GEOMETRY = {'NODE_ONLY', 'OPEN_WAY', 'RING_BROKEN', 'OUTLINE_INCOMPLETE', 'TOO_FEW_POINTS', 'ZERO_AREA',
                     'INVALID_LOCATION', 'RELATION_TYPE'}
NOT_STANDING = {'UNDERGROUND', 'LIFECYCLE'}


def first_present(*paths):
    return next((p for p in paths if p and os.path.exists(p)), None)


class Setup:
    """Where things are; filled by main()."""
    program = shared = node_modules = None
    update = keep = False

    @classmethod
    def read(cls, argv):
        parser = argparse.ArgumentParser(add_help=False)
        parser.add_argument('--program', help='the blockrand to test')
        parser.add_argument('--shared', help='folder with data/osm and schemas')
        parser.add_argument('--node-modules', help='node_modules with gltf-validator')
        parser.add_argument('--update', action='store_true', help='write golden files instead of comparing')
        parser.add_argument('--keep', action='store_true', help='leave the temporary folder and say where it is')
        options, rest = parser.parse_known_args(argv)
        builds = [os.path.join(SOURCE, 'build', b) for b in ('ci', 'release', 'debug')]

        def binary(name):
            found = first_present(*(os.path.join(b, p, name) for b in builds
                                    for p in ('bin', 'pipeline/cli', 'tests', 'tests/end_to_end', '.')))
            return found or shutil.which(name)
        cls.program = options.program or binary('blockrand')
        cls.shared = options.shared or first_present(os.path.join(SOURCE, '..', 'shared'))
        cls.node_modules = first_present(options.node_modules, *(os.path.join(b, 'node_modules') for b in builds),
                                         os.path.join(SOURCE, 'tests', 'validators', 'node_modules'))
        cls.update, cls.keep = options.update, options.keep
        return rest


def extract(name):
    """Path of a real extract, or None where the shared data is absent."""
    path = os.path.join(Setup.shared or '', 'data', 'osm', name)
    return path if os.path.exists(path) else None


class Run:
    """A finished call of the program."""

    def __init__(self, command, code, out, err):
        self.command, self.code, self.out, self.err = command, code, out, err

    def __str__(self):
        return f'$ {shlex.join(self.command)}\nexit code {self.code}\n{self.out[-8000:]}{self.err[-4000:]}'


def call(command, timeout=900, env=None, cwd=None, preexec=None):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                          timeout=timeout, cwd=cwd, env=dict(os.environ, **env) if env else None, preexec_fn=preexec)
    return Run(command, done.returncode, done.stdout.decode('utf-8', 'replace'), done.stderr.decode('utf-8', 'replace'))


def blockrand(*arguments, **how):
    return call([Setup.program, *map(str, arguments)], **how)


def read_json(*path):
    with open(os.path.join(*path), encoding='utf-8') as f:
        return json.load(f)


def sha256(path):
    digest = hashlib.sha256()
    with open(path, 'rb') as f:
        for block in iter(lambda: f.read(1 << 20), b''):
            digest.update(block)
    return digest.hexdigest()


def files_of(folder, *ends):
    """Relative paths of all files below, sorted; only those with one of the ends if any are given."""
    found = []
    for place, _, names in os.walk(folder):
        found += [os.path.relpath(os.path.join(place, n), folder) for n in names if not ends or n.endswith(ends)]
    return sorted(found)


def hashes(folder, *parts):
    """{relative path: sha256}; of the given files and subfolders only, where any are given."""
    return {p: sha256(os.path.join(folder, p)) for p in files_of(folder)
            if not parts or any(p == part or p.startswith(part + '/') for part in parts)}


def stray_siblings(target):
    """Staging folders and old builds that a run left beside its output."""
    parent, name = os.path.split(os.path.abspath(target))
    if not os.path.isdir(parent):
        return []
    return sorted(n for n in os.listdir(parent) if n.startswith('.' + name + '.'))


class BuildTest(unittest.TestCase):
    """A test with a temporary folder and with words for what a build must be. `maxDiff` shows whole differences."""
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        if not Setup.program:
            raise AssertionError('blockrand is not built: give --program')
        cls.folder = tempfile.mkdtemp(prefix='blockrand-e2e-')
        if Setup.keep:
            print('kept:', cls.folder)
        else:
            cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def place(self, name, content):
        """Writes a small file into the temporary folder."""
        path = self.path(name)
        with open(path, 'wb') as f:
            f.write(content if isinstance(content, bytes) else content.encode())
        return path

    def build(self, source, name, *options, **how):
        """A build that must succeed; returns its folder. build.last is the run. LoD 2 where the options do not say one: facades take ten times as long."""
        target = self.path(name)
        if not any(o in ('--lod', '--config') or str(o).startswith('--lod=') for o in options):
            options = ('--lod', '2', *options)
        run = blockrand('build', source, '-o', target, '--progress', 'none', *options, **how)
        self.assertEqual(run.code, 0, run)
        self.assertEqual(stray_siblings(target), [], f'left beside the output\n{run}')
        type(self).last = run
        return target

    def refused(self, run, code, *words, target=None):
        """A run that ended with `code`, said why in words, and left nothing at `target`."""
        self.assertEqual(run.code, code, run)
        for word in words:
            self.assertIn(word.lower(), run.err.lower(), run)
        self.assertGreater(len(run.err.strip()), 20, f'no reason given\n{run}')
        if target:
            self.assertFalse(os.path.lexists(target), f'half a result was left\n{run}')
            self.assertEqual(stray_siblings(target), [], f'left beside the output\n{run}')

    def counts_add_up(self, folder):
        """buildings + parts in = models + represented + reported, in build.json and row by row in report.json."""
        build, report = read_json(folder, 'build.json'), read_json(folder, 'report.json')
        c = build['counts']
        self.assertEqual(c['buildings_in'] + c['parts_in'], c['models'] + c['represented'] + c['reported'], c)
        self.assertEqual(c['models'], sum(c[f'models_lod{level}'] for level in range(4)), c)
        states = {'reported': 0, 'represented': 0, 'duplicate': 0}
        for row in report['objects']:
            states[row['state']] += 1
            if row['state'] == 'reported':
                self.assertIn(row['code'], report['codes'], row)
        self.assertEqual(states['reported'], c['reported'])
        self.assertEqual(states['duplicate'], c['represented_as_duplicates'])
        self.assertEqual(states['duplicate'] + states['represented'], c['represented'])
        ids = [row['id'] for row in report['objects']]
        self.assertEqual(len(ids), len(set(ids)), 'an object stands twice in the report')
        issues = {}
        for row in [r for r in report['objects'] if r['state'] == 'reported'] + report['fallbacks'] + report['notices']:
            issues[row['code']] = issues.get(row['code'], 0) + 1
        self.assertEqual(build['issues'], dict(sorted(issues.items())))
        return build, report

    def hashes_match(self, folder):
        """build.json names every file but itself and run.json, with its size and hash."""
        listed = read_json(folder, 'build.json')['files']
        self.assertEqual(sorted(listed), [p for p in files_of(folder) if p not in ('build.json', 'run.json')])
        for path, entry in listed.items():
            full = os.path.join(folder, path)
            self.assertEqual((entry['bytes'], entry['sha256']), (os.path.getsize(full), sha256(full)), path)

    def same_files(self, a, b, *parts, but=('run.json',)):
        """Both folders hold the same files with the same bytes."""
        first, second = ({p: h for p, h in hashes(f, *parts).items() if p not in but} for f in (a, b))
        self.assertTrue(first, f'nothing to compare in {a}')
        differing = sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p))
        self.assertEqual(differing, [], f'{len(differing)} of {len(first)} files differ between {a} and {b}')


def pictures_folder(arguments):
    """The absolute folder after --pictures, made where it is absent, and the other arguments; None without the option."""
    if '--pictures' not in arguments:
        return None, arguments
    at = arguments.index('--pictures')
    folder = os.path.abspath(arguments[at + 1])
    os.makedirs(folder, exist_ok=True)
    return folder, arguments[:at] + arguments[at + 2:]


class CountingResult(unittest.TextTestResult):
    """Knows how many tests really ran to their end: a skipped class counts for none."""
    passed = 0

    def addSuccess(self, test):
        self.passed += 1
        super().addSuccess(test)


def main(argv=None):
    """unittest.main with the options above; exit code 77 when every test was skipped."""
    rest = Setup.read(sys.argv[1:] if argv is None else argv)
    runner = unittest.TextTestRunner(resultclass=CountingResult, verbosity=2)
    result = unittest.main(argv=[sys.argv[0], *rest], testRunner=runner, exit=False).result
    if not result.wasSuccessful():
        sys.exit(1)
    if result.passed == 0:
        print('nothing was tested' + (': every test was skipped' if result.skipped else ''))
        sys.exit(SKIPPED if result.skipped else 1)
