"""samples/debian_source_file.sh against package sources on this disk: no network, no root, nothing of apt's changed.

Skips where apt is absent."""
import hashlib
import io
import os
import shutil
import sys
import tarfile
import tempfile
import unittest

from blockrand_run import SOURCE, call, main

SCRIPT = os.path.join(SOURCE, 'samples', 'debian_source_file.sh')
CONTENT = b'one house\n' * 1000


class DebianSource(unittest.TestCase):
    def setUp(self):
        if not shutil.which('apt-get') or not shutil.which('apt-cache'):
            self.skipTest('apt is absent')
        self.folder = tempfile.mkdtemp(prefix='blockrand-apt-test-')
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        os.chmod(self.folder, 0o755)
        self.repository = self.path('repository')
        os.mkdir(self.repository)
        self.offer('pretend_1.0.orig.tar.gz')
        os.mkdir(self.path('sources.list.d'))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def offer(self, name, damaged=False):
        """A repository of one source package, whose archive holds pretend-1.0/data/town.osm."""
        archive = io.BytesIO()
        with tarfile.open(fileobj=archive, mode='w:gz') as tar:
            for path, content in (('pretend-1.0/README', b'-'), ('pretend-1.0/other/data/town.osm', b'not this'),
                                  ('pretend-1.0/data/town.osm', CONTENT)):
                entry = tarfile.TarInfo(path)
                entry.size = len(content)
                tar.addfile(entry, io.BytesIO(content))
        data = archive.getvalue()
        digest = hashlib.sha256(data).hexdigest()
        with open(os.path.join(self.repository, name), 'wb') as f:
            f.write(data[:-1] + b'?' if damaged else data)
        description = f' {digest} {len(data)} {name}\n'
        with open(os.path.join(self.repository, 'Sources'), 'w') as f:
            f.write('Package: pretend\nBinary: pretend\nVersion: 1.0-1\nArchitecture: any\nFormat: 3.0 (quilt)\n'
                    f'Directory: .\nChecksums-Sha256:\n{description}\n')

    def run_with(self, lines='', stanzas='', package='pretend', path='data/town.osm'):
        """Runs the script on a machine whose sources are `lines` in sources.list and `stanzas` in a .sources file."""
        files = {'sources.list': lines, 'sources.list.d/test.sources': stanzas}
        for name, text in files.items():
            with open(self.path(name), 'w') as f:
                f.write(text)
        config = self.path('apt.conf')
        with open(config, 'w') as f:
            f.write(f'Dir::Etc::sourcelist "{self.path("sources.list")}";\n'
                    f'Dir::Etc::sourceparts "{self.path("sources.list.d")}";\n'
                    f'Dir::State::lists "{self.path("lists of the system")}";\n'
                    # What a system's configuration may do after an update.
                    f'APT::Update::Post-Invoke {{ "touch {self.path("hook")}"; }};\n')
        temporary = self.path('tmp')
        os.makedirs(temporary, exist_ok=True)
        os.chmod(temporary, 0o755)
        self.target = self.path('out', 'town.osm')
        run = call(['sh', SCRIPT, package, path, self.target], env={'APT_CONFIG': config, 'TMPDIR': temporary})
        self.assertEqual(os.listdir(temporary), [], f'left behind\n{run}')
        self.assertFalse(os.path.exists(self.path('hook')), 'the system\'s hooks ran')
        self.assertFalse(os.path.exists(self.path('lists of the system')), 'the system\'s lists were touched')
        for name, text in files.items():
            with open(self.path(name)) as f:
                self.assertEqual(f.read(), text, 'the system\'s sources were changed')
        return run

    def fetched(self, run):
        self.assertEqual(run.code, 0, run)
        with open(self.target, 'rb') as f:
            self.assertEqual(f.read(), CONTENT)

    def refused(self, run, *words):
        self.assertEqual(run.code, 1, run)
        for word in words:
            self.assertIn(word, run.err, run)
        self.assertFalse(os.path.exists(self.target))

    def test_entries_in_lines(self):
        self.fetched(self.run_with(lines=f'# a comment\n  deb [trusted=yes] file:{self.repository} ./\n'
                                         'deb cdrom:[Debian]/ bookworm main\n'))

    def test_entries_in_stanzas(self):
        self.fetched(self.run_with(stanzas='# a comment\nEnabled: no\nTypes: deb\nURIs: file:/nowhere\nSuites: ./\n\n'
                                           f'Types:\n deb\n deb-src\nURIs: file:{self.repository}\nSuites: ./\nTrusted: yes\n'))

    def test_a_source_without_sources_does_no_harm(self):
        self.fetched(self.run_with(lines=f'deb [trusted=yes] file:{self.folder}/absent ./\n'
                                         f'deb [trusted=yes] file:{self.repository} ./\n'))

    def test_unsigned_sources_are_refused(self):
        self.refused(self.run_with(lines=f'deb file:{self.repository} ./\n'), 'no package source offers', 'Release file')

    def test_a_wrong_checksum_is_refused(self):
        self.offer('pretend_1.0.orig.tar.gz', damaged=True)
        self.refused(self.run_with(lines=f'deb [trusted=yes] file:{self.repository} ./\n'), 'could not fetch')

    def test_absent_things_are_named(self):
        lines = f'deb [trusted=yes] file:{self.repository} ./\n'
        self.refused(self.run_with(lines, package='absent'), 'the source package absent')
        self.refused(self.run_with(lines, path='data/village.osm'), 'holds no data/village.osm')
        self.refused(self.run_with(), 'no package source offers', 'Offline?')


if __name__ == '__main__':
    main()
