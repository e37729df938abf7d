"""The installed program: below any prefix, out of the archive, out of the Debian package, with an empty environment; and
what it says to man and to shells."""
import gzip
import os
import pty
import re
import select
import shutil
import subprocess
import time
import unittest

from blockrand_run import SAMPLE, SOURCE, BuildTest, Setup, call, files_of, main, read_json, sha256

INSTALLED = ['bin/blockrand', 'share/bash-completion/completions/blockrand', 'share/blockrand/configs/defaults/uses.toml',
             'share/blockrand/configs/materials/materials.toml', 'share/blockrand/configs/materials/textures.toml',
             'share/blockrand/configs/surroundings.toml', 'share/doc/blockrand/CHANGELOG.md',
             'share/doc/blockrand/LICENSE', 'share/doc/blockrand/LICENSE.DejaVu', 'share/doc/blockrand/LICENSES.viewer',
             'share/doc/blockrand/README.md',
             'share/doc/blockrand/examples/blockrand-viertel.osm', 'share/fish/vendor_completions.d/blockrand.fish',
             'share/man/man1/blockrand.1', 'share/zsh/site-functions/_blockrand']
# The program holds jemalloc where that was installed when it was built.
if os.path.exists('/usr/share/doc/libjemalloc-dev/copyright'):
    INSTALLED.append('share/doc/blockrand/LICENSES.jemalloc')
# Styles, district rules, grammars, profiles and elements are many and grow: whatever the source tree holds.
INSTALLED += ['share/blockrand/' + os.path.relpath(os.path.join(folder, name), SOURCE)
              for part in ('styles', 'districts', 'grammars', 'profiles', 'elements') for folder, _, names in os.walk(os.path.join(SOURCE, 'configs', part))
              for name in names]
# Of what the Debian package holds, what is called otherwise there, or stands in another file (None).
DEBIAN = {'share/man/man1/blockrand.1': 'share/man/man1/blockrand.1.gz',
          'share/doc/blockrand/CHANGELOG.md': 'share/doc/blockrand/changelog.gz',
          'share/doc/blockrand/LICENSE': 'share/doc/blockrand/copyright',
          'share/doc/blockrand/LICENSE.DejaVu': None}


def need(*tools):
    for tool in tools:
        if not shutil.which(tool):
            raise unittest.SkipTest(f'{tool} is not installed')


class Installed(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        need('cmake')
        cls.build_tree = os.path.dirname(os.path.abspath(Setup.program))
        for needed in ('CPackConfig.cmake', 'documents/blockrand.1'):
            if not os.path.exists(os.path.join(cls.build_tree, needed)):
                raise unittest.SkipTest(f'{cls.build_tree} has no {needed}: it is no build tree, or not all of it is built')
        # What the program in the build tree makes is what the installed one has to make.
        cls.expected = cls().build(SAMPLE, 'expected')

    def install(self, name):
        """cmake --install, then moved to another folder: the path it was installed to exists no more."""
        run = call(['cmake', '--install', self.build_tree, '--prefix', self.path(name + '-before')])
        self.assertEqual(run.code, 0, run)
        shutil.move(self.path(name + '-before'), self.path(name))
        return self.path(name)

    def pack(self, generator, name, **env):
        """cpack with this generator; the package's path."""
        folder = self.path(name)
        run = call(['cpack', '--config', os.path.join(self.build_tree, 'CPackConfig.cmake'), '-G', generator, '-B', folder],
                   env=env)
        self.assertEqual(run.code, 0, run)
        packages = [f for f in os.listdir(folder) if os.path.isfile(os.path.join(folder, f))]
        self.assertEqual(len(packages), 1, packages)
        return os.path.join(folder, packages[0])

    def bare(self, prefix, *arguments):
        """The program of a prefix, called in another folder with nothing in the environment."""
        return call(['env', '-i', os.path.join(prefix, 'bin', 'blockrand'), *arguments], cwd='/')

    def builds_the_sample(self, prefix):
        """With an empty environment, in another folder, and with the configs of this prefix."""
        uses = os.path.join(prefix, 'share/blockrand/configs/defaults/uses.toml')
        with open(uses, 'a', encoding='utf-8') as f:
            f.write('# other bytes than those of the source tree\n')
        target = os.path.join(prefix, 'out')
        run = self.bare(prefix, 'build', os.path.join(prefix, 'share/doc/blockrand/examples/blockrand-viertel.osm'), '-o',
                        target, '--lod', '2', '--progress', 'none')
        self.assertEqual(run.code, 0, run)
        read = {i['path']: i['sha256'] for i in read_json(target, 'build.json')['inputs'] if i['role'] == 'config'}
        self.assertEqual(read['defaults/uses.toml'], sha256(uses))
        self.same_files(target, self.expected, 'tiles', 'citygml', 'tileset.json')

    def test_prefix_can_be_moved(self):
        prefix = self.install('moved')
        self.assertEqual(files_of(prefix), sorted(INSTALLED))
        for path in INSTALLED:
            mode = os.stat(os.path.join(prefix, path)).st_mode & 0o777
            self.assertEqual(mode, 0o755 if path.startswith('bin/') else 0o644, path)
        self.builds_the_sample(prefix)

    def test_configs_come_from_the_prefix_or_not_at_all(self):
        """Neither the source tree nor the build tree of the machine that built it is ever asked."""
        prefix = self.install('without')
        shutil.rmtree(os.path.join(prefix, 'share/blockrand'))
        run = self.bare(prefix, 'build', SAMPLE, '-o', self.path('never'), '--progress', 'none')
        self.refused(run, 1, os.path.join(prefix, 'share/blockrand/configs'), '--configs', target=self.path('never'))
        run = self.bare(prefix, 'build', SAMPLE, '-o', self.path('given'), '--lod', '2', '--progress', 'none', '--configs',
                        os.path.join(SOURCE, 'configs'))
        self.assertEqual(run.code, 0, run)
        self.same_files(self.path('given'), self.expected, 'tiles', 'citygml')
        with open(os.path.join(prefix, 'bin/blockrand'), 'rb') as f:
            program = f.read()
        for folder in (SOURCE, self.build_tree):
            self.assertNotIn(os.path.realpath(folder).encode() + b'/', program, 'a path of this machine is in the program')

    def test_links_to_the_program_work(self):
        prefix = self.install('linked')
        os.mkdir(self.path('elsewhere'))
        os.symlink(os.path.join(prefix, 'bin/blockrand'), self.path('elsewhere', 'brand'))
        run = call([self.path('elsewhere', 'brand'), 'build', SAMPLE, '-o', self.path('by-link'), '--lod', '0',
                    '--formats', 'gltf', '--progress', 'none'])
        self.assertEqual(run.code, 0, run)

    def test_archive(self):
        need('cpack', 'tar', 'gzip')
        package = self.pack('TGZ', 'tgz')
        name = re.fullmatch(r'blockrand-[\d.]+-Linux-\w+\.tar\.gz', os.path.basename(package))
        self.assertTrue(name, package)
        shutil.unpack_archive(package, self.path('unpacked'))
        [folder] = os.listdir(self.path('unpacked'))
        self.assertEqual(folder + '.tar.gz', os.path.basename(package), 'unpacks into one folder of its own name')
        self.assertEqual(files_of(self.path('unpacked', folder)), sorted(INSTALLED))
        self.builds_the_sample(self.path('unpacked', folder))

    def test_archive_is_reproducible(self):
        need('cpack', 'tar', 'gzip')
        packages = [self.pack('TGZ', f'again{n}', SOURCE_DATE_EPOCH='1700000000') for n in (1, 2)]
        self.assertEqual(*map(sha256, packages))
        listing = call(['tar', '--utc', '--full-time', '-tvzf', packages[0]]).out
        self.assertEqual(set(re.findall(r'\d{4}-\d\d-\d\d \d\d:\d\d:\d\d', listing)), {'2023-11-14 22:13:20'})


class DebianPackage(Installed):
    """The .deb; what `Installed` tests is not run twice."""
    test_prefix_can_be_moved = test_configs_come_from_the_prefix_or_not_at_all = None
    test_links_to_the_program_work = test_archive = test_archive_is_reproducible = None

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        need('cpack', 'dpkg-deb', 'dpkg-shlibdeps', 'file')
        cls.package = cls().pack('DEB', 'deb', SOURCE_DATE_EPOCH='1700000000')

    def field(self, name):
        return call(['dpkg-deb', '-f', self.package, name]).out.strip()

    def test_control_fields(self):
        version = call([Setup.program, '--version']).out.split()[1]
        self.assertEqual(self.field('Package'), 'blockrand')
        self.assertEqual(self.field('Version'), version + '-1')
        self.assertEqual(self.field('Section'), 'science')
        self.assertEqual(self.field('Architecture'), call(['dpkg', '--print-architecture']).out.strip())
        self.assertRegex(self.field('Maintainer'), r'.+ <.+@.+>')
        self.assertRegex(self.field('Description'), r'^[^\n]{20,80}\n [^\n]{20,80}\n')
        depends = self.field('Depends')
        for needed in (r'proj-data', r'libgdal\d+', r'libproj\d+', r'libgeos-c1\w*', r'libtinygltf\w+', r'libmeshoptimizer\w+', r'libxml2\w*', r'libfreetype6\w*', r'libcpp-httplib[\d.]+', r'libc6'):
            self.assertRegex(depends, rf'(^|, ){needed}( \(|,|$)')
        self.assertNotRegex(depends, r'-dev|libcgal', 'what only building needs')

    def test_files_lie_where_debian_wants_them(self):
        root = self.path('tree')
        self.assertEqual(call(['dpkg-deb', '-x', self.package, root]).code, 0)
        wanted = [os.path.join('usr', DEBIAN.get(p, p)) for p in INSTALLED if DEBIAN.get(p, p)] + ['usr/share/doc/blockrand/changelog.Debian.gz']
        self.assertEqual(files_of(root), sorted(wanted))
        with open(os.path.join(root, 'usr/share/doc/blockrand/copyright'), encoding='utf-8') as f:
            self.assertIn('/usr/share/common-licenses/GPL-3', f.read())
        with gzip.open(os.path.join(root, 'usr/share/doc/blockrand/changelog.Debian.gz'), 'rt') as f:
            self.assertRegex(f.read(), r'^blockrand \([\d.]+-1\) .*\n\n(.*\n)+\n -- .* <.*>  Tue, 14 Nov 2023 22:13:20 \+0000\n')
        with gzip.open(os.path.join(root, 'usr/share/man/man1/blockrand.1.gz'), 'rt') as f:
            self.assertIn('.TH BLOCKRAND 1', f.read())
        with open(os.path.join(root, 'usr/bin/blockrand'), 'rb') as f:
            self.assertNotIn(b'.debug_info', f.read())
        self.builds_the_sample(os.path.join(root, 'usr'))

    def test_package_is_reproducible(self):
        self.assertEqual(sha256(self.package), sha256(self.pack('DEB', 'deb-again', SOURCE_DATE_EPOCH='1700000000')))

    def test_lintian(self):
        need('lintian')
        run = call(['lintian', '--allow-root', '--no-cfg', '--fail-on', 'error', self.package])
        self.assertEqual(run.code, 0, run)


class Manual(unittest.TestCase):
    """blockrand(1): checked by those who print it."""

    def setUp(self):
        run = call([Setup.program, 'help', 'man'])
        self.assertEqual((run.code, run.err), (0, ''), run)
        self.page = run.out

    def printed_by(self, *command):
        done = subprocess.run(command, input=self.page.encode(), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        return done.returncode, done.stdout.decode(), done.stderr.decode()

    def test_it_is_plain_text(self):
        self.assertTrue(self.page.isascii())
        self.assertFalse([line for line in self.page.split('\n') if line != line.rstrip()])

    def test_groff_has_no_warning(self):
        need('groff')
        code, text, warnings = self.printed_by('groff', '-man', '-Tascii', '-ww', '-P-cbou')
        self.assertEqual((code, warnings), (0, ''))
        for heading in ('NAME', 'SYNOPSIS', 'COMMANDS', 'OPTIONS', 'OUTPUT', 'FILES', 'EXIT STATUS', 'EXAMPLES'):
            self.assertRegex(text, rf'(?m)^{heading}$')
        plain = re.sub(r'\s+', ' ', text)
        commands = re.findall(r'(?m)^  (\w+) +\S', call([Setup.program, '--help']).out.split('Commands:\n')[1].split('\n\n')[0])
        self.assertLessEqual({'build', 'info', 'help'}, set(commands))
        for command in commands:
            self.assertIn(f'blockrand {command} ', plain)
            for option in re.findall(r'(?m)^ +(?:-\w, )?(--[\w-]+)', call([Setup.program, command, '--help']).out):
                self.assertIn(option, plain)
        self.assertIn('Default: gltf,citygml', plain)

    def test_mandoc_has_no_complaint(self):
        need('mandoc')
        code, complaints, _ = self.printed_by('mandoc', '-T', 'lint')
        # There is no date: it would be the clock's.
        left = [line for line in complaints.split('\n') if line and 'missing date' not in line]
        self.assertEqual(left, [])


class Completion(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.here = cls().path('here')
        os.makedirs(os.path.join(cls.here, 'folder'))
        for name in ('a.osm', 'b c.osm'):
            open(os.path.join(cls.here, name), 'w').close()

    def script(self, shell):
        run = call([Setup.program, 'help', 'completion', shell])
        self.assertEqual((run.code, run.err), (0, ''), run)
        return self.place('completion.' + shell, run.out)

    # What stands before the cursor, what must be offered, what must not.
    QUESTIONS = [
        (['blockrand', ''], ['build', 'info', 'help'], ['codes', 'a.osm']),
        (['blockrand', 'bu'], ['build'], ['info']),
        (['blockrand', 'build', '--fo'], ['--formats', '--force'], ['--lod']),
        (['blockrand', 'build', '--no-r'], ['--no-report'], []),
        (['blockrand', 'build', '--formats', 'gltf,ci'], ['gltf,citygml', 'gltf,cityjson'], ['gltf,gpkg']),
        (['blockrand', 'build', '--progress', ''], ['auto', 'bar', 'plain', 'none'], ['a.osm']),
        (['blockrand', 'build', 'a'], ['a.osm'], []),
        (['blockrand', 'build', '-o', ''], ['folder'], ['a.osm']),
        (['blockrand', 'info', '--'], ['--json', '--bbox'], ['--force']),
        (['blockrand', 'help', ''], ['build', 'options', 'codes', 'man', 'completion'], []),
        (['blockrand', 'help', 'completion', ''], ['bash', 'zsh', 'fish'], ['build']),
    ]

    def ask(self, offers):
        """offers(words): what the shell offers for the last of the words."""
        for words, wanted, unwanted in self.QUESTIONS:
            with self.subTest(' '.join(words)):
                offered = offers(words)
                self.assertLessEqual(set(wanted), offered)
                self.assertFalse(set(unwanted) & offered, offered)

    def bash(self, words):
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))\n'
                  '_blockrand; [ ${#COMPREPLY[@]} -eq 0 ] || printf "%s\\n" "${COMPREPLY[@]}"')
        run = call(['bash', '--norc', '-u', '-c', script, 'bash', self.script('bash'), *words], cwd=self.here)
        self.assertEqual((run.code, run.err), (0, ''), run)
        return set(run.out.split('\n')) - {''}

    def test_bash(self):
        need('bash')
        self.ask(self.bash)
        self.assertEqual(self.bash(['blockrand', 'build', '--formats', '=', 'gp']), {'gpkg'})
        self.assertEqual(self.bash(['blockrand', 'build', '--progress', '=']), {'auto', 'bar', 'plain', 'none'})
        self.assertEqual(self.bash(['blockrand', 'build', '']), {'a.osm', 'b c.osm', 'folder'})
        self.assertEqual(self.bash(['blockrand', 'build', '--lod', '1', '-o', 'x', 'a']), {'a.osm'})
        self.assertEqual(self.bash(['blockrand', 'build', 'a.osm', '']), set(), 'one input only')
        self.assertEqual(self.bash(['blockrand', 'build', '--lod', '']), set(), 'a number is for people to know')
        self.assertEqual(self.bash(['blockrand', 'help', 'options', '--']), {'--markdown', '--toml'})

    def test_bash_registers_itself(self):
        need('bash')
        run = call(['bash', '--norc', '-c', 'source "$1" && complete -p blockrand', 'bash', self.script('bash')])
        self.assertEqual(run.out, 'complete -F _blockrand blockrand\n', run)

    def test_fish(self):
        need('fish')

        def fish(words):
            line = ' '.join(words)
            run = call(['fish', '--no-config', '-c', 'source $argv[1]; complete -C $argv[2]', self.script('fish'), line],
                       cwd=self.here, env={'HOME': self.folder, 'XDG_DATA_HOME': self.folder})
            self.assertEqual((run.code, run.err), (0, ''), run)
            return {offer.split('\t')[0].rstrip('/') for offer in run.out.split('\n')} - {''}
        self.ask(fish)

    def test_zsh(self):
        """zsh completes on a terminal only: one is played to it."""
        need('zsh')
        os.makedirs(self.path('functions'), exist_ok=True)
        shutil.copy(self.script('zsh'), self.path('functions', '_blockrand'))

        def zsh(words):
            pid, terminal = pty.fork()
            if pid == 0:
                os.chdir(self.here)
                os.execvpe('zsh', ['zsh', '-f', '-i'], {'PATH': os.environ['PATH'], 'TERM': 'dumb', 'HOME': self.folder})

            def read(until, seconds, quiet=None):
                text, end = '', time.monotonic() + seconds
                while until not in text and time.monotonic() < end:
                    if select.select([terminal], [], [], quiet or 0.1)[0]:
                        try:
                            text += os.read(terminal, 65536).decode('utf-8', 'replace')
                        except OSError:
                            break
                    elif quiet:
                        break
                return text
            try:
                os.write(terminal, 'PS1=; unsetopt zle_bracketed_paste; stty cols 300 -echo; '
                         f'fpath=({self.path("functions")} $fpath); '
                         'autoload -Uz compinit && compinit -u -D; setopt list_rows_first; print re""ady\n'.encode())
                self.assertIn('ready', read('ready', seconds=30))
                # The second one lists what the first one could not decide; the line is then thrown away, and what
                # the shell says next ends the list.
                os.write(terminal, (' '.join(words) + '\t\t').encode())
                text = read('\0', seconds=30, quiet=1.5)
                os.write(terminal, b'\x15print do""ne\n')
                text += read('done', seconds=30)
            finally:
                os.close(terminal)
                os.waitpid(pid, 0)
            # Meanings stand behind two dashes. Of a list separated by commas, the items are listed.
            shown = set(re.findall(r'[\w./-]+', '\n'.join(line.partition(' -- ')[0] for line in text.splitlines())))
            return shown | {words[-1].rpartition(',')[0] + ',' + s for s in shown} | {s.rstrip('/') for s in shown}
        self.ask(zsh)


if __name__ == '__main__':
    main()
