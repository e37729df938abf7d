"""A build that does not end well: killed, interrupted, out of disk. The old build stays byte for byte, always."""
import contextlib
import errno
import os
import resource
import signal
import subprocess
import time
import unittest

from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, call, hashes, main, read_json, stray_siblings
from osm_files import town, write_pbf


def staging_of(target):
    """The staging folder of a running build, or None."""
    found = [n for n in stray_siblings(target) if '.part-' in n]
    return os.path.join(os.path.dirname(target), found[0]) if found else None


def count_files(folder):
    return sum(len(names) for _, _, names in os.walk(folder)) if folder else 0


@contextlib.contextmanager
def small_disk(folder, options):
    """A tmpfs of its own; skips where mounting is not allowed."""
    os.makedirs(folder, exist_ok=True)
    mounted = call(['mount', '-t', 'tmpfs', '-o', options, 'blockrand-test', folder])
    if mounted.code != 0:
        raise unittest.SkipTest(f'mounting a tmpfs is not allowed here: {mounted.err.strip()}')
    try:
        yield folder
    finally:
        call(['umount', folder])


class InterruptionTest(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # Large enough that a signal finds the run in its middle on any machine; many tiles.
        cls.town = write_pbf(os.path.join(cls.folder, 'town.osm.pbf'), town(12000))

    def start(self, target, *options):
        return subprocess.Popen([Setup.program, 'build', self.town, '-o', target, '--force', '--lod', '2', '--progress', 'none', *options],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)

    def wait_for_files(self, process, target, at_least):
        """Until the staging folder holds so many files; False when the run ended before."""
        while process.poll() is None:
            if count_files(staging_of(target)) >= at_least and staging_of(target):
                return True
            time.sleep(0.002)
        return False


class Interruption(InterruptionTest):
    def interrupt(self, name, number, at_least, old):
        """Sends a signal when `at_least` files are written. Returns (target, hashes before, ended process, stderr)."""
        target = self.path(name)
        before = {}
        if old:
            self.build(SAMPLE, name, '--force')
            before = hashes(target)
        process = self.start(target)
        in_the_middle = self.wait_for_files(process, target, at_least)
        process.send_signal(number)
        _, err = process.communicate(timeout=300)
        self.assertTrue(in_the_middle, f'the run ended before it was interrupted: {err.decode()}')
        return target, before, process, err.decode()

    def test_signals(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for at_least in (0, 1, 4, 9):
                with self.subTest(signal=number.name, files=at_least):
                    target, before, process, err = self.interrupt('signal', number, at_least, old=True)
                    self.assertEqual(process.returncode, 128 + number, err)
                    self.assertIn('interrupted', err)
                    self.assertEqual(hashes(target), before)
                    self.assertEqual(stray_siblings(target), [])

    def test_signal_without_an_old_build(self):
        target, _, process, err = self.interrupt(os.path.join('made', 'parents', 'out'), signal.SIGINT, 3, old=False)
        self.assertEqual(process.returncode, 128 + signal.SIGINT, err)
        self.assertFalse(os.path.exists(self.path('made')), 'folders made on the way stay behind')

    def test_kill(self):
        """Nothing can clean up after kill -9 but the next run."""
        for at_least in (0, 3, 8):
            with self.subTest(files=at_least):
                target, before, process, _ = self.interrupt('killed', signal.SIGKILL, at_least, old=True)
                self.assertEqual(process.returncode, -signal.SIGKILL)
                self.assertEqual(hashes(target), before)
                self.assertNotEqual(stray_siblings(target), [], 'the test did not hit the middle')
                # A later run for the same place removes what is left, even one that itself is refused.
                self.build(SAMPLE, 'killed', '--force')
                self.assertEqual(hashes(target).keys(), before.keys())

    def test_kill_at_any_time(self):
        """At moments spread over the whole run, publishing included: the old build or the new one, never between."""
        target = self.path('anytime')
        self.build(SAMPLE, 'anytime')
        old = {p: h for p, h in hashes(target).items() if p != 'run.json'}
        self.build(self.town, 'reference')
        new = {p: h for p, h in hashes(self.path('reference')).items() if p != 'run.json'}
        started = time.monotonic()
        process = self.start(target)
        process.communicate()
        whole = time.monotonic() - started
        for i in range(8):
            self.build(SAMPLE, 'anytime', '--force', '--allow-shrink', '100')
            process = self.start(target)
            try:
                process.communicate(timeout=whole * (0.15 + 0.115 * i))
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
            now = {p: h for p, h in hashes(target).items() if p != 'run.json'}
            self.assertIn(now, (old, new), f'neither the old build nor the new one at {0.15 + 0.115 * i:.0%}')
        self.build(SAMPLE, 'anytime', '--force', '--allow-shrink', '100')

    def test_a_running_build_is_left_alone(self):
        """A second run for the same place must not take the first one's staging folder for a dead one's."""
        target = self.path('shared')
        first = self.start(target)
        self.assertTrue(self.wait_for_files(first, target, 1))
        staging = staging_of(target)
        second = blockrand('build', SAMPLE, '-o', target, '--force', '--lod', '2', '--progress', 'none')
        self.assertIn(second.code, (0, 4), second)
        if first.poll() is None:
            self.assertTrue(os.path.isdir(staging), 'the staging folder of a living process was removed')
        _, err = first.communicate(timeout=300)
        self.assertIn(first.returncode, (0, 4), err)
        build = read_json(target, 'build.json')
        self.assertIn(build['counts']['buildings_in'], (12000, read_json(self.build(SAMPLE, 'alone'), 'build.json')['counts']['buildings_in']))
        self.hashes_match(target)
        self.assertEqual(stray_siblings(target), [])


class FullDisk(InterruptionTest):
    def ended_badly(self, run, target, before, *words):
        """Exit code 4, a reason, the old build intact, nothing beside it."""
        self.assertEqual(run.code, 4, run)
        for word in words:
            self.assertIn(word, run.err.lower(), run)
        self.assertEqual(hashes(target), before)
        self.assertEqual(stray_siblings(target), [])

    def rebuild(self, target, *options, **how):
        return blockrand('build', SAMPLE, '-o', target, '--force', '--lod', '2', '--progress', 'none', *options, **how)

    def test_file_size_limit(self):
        """ulimit -f stands for a quota: needs no rights. In every format the largest file is over the limit."""
        for options in ([], ['--formats', 'gltf'], ['--formats', 'citygml'], ['--gzip'], ['--single-glb']):
            with self.subTest(options=options):
                target = self.build(SAMPLE, 'limited', '--force', '--lod', '0')
                before = hashes(target)
                run = self.rebuild(target, *options, preexec=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000)))
                self.ended_badly(run, target, before, 'too large', 'ulimit')

    def test_file_size_limit_without_an_old_build(self):
        target = self.path('nothing', 'out')
        run = blockrand('build', SAMPLE, '-o', target, '--lod', '2', preexec=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000)))
        self.refused(run, 4, target=target)
        self.assertFalse(os.path.exists(self.path('nothing')))

    def test_too_little_space_is_said_beforehand(self):
        """Free space is looked at before anything is written."""
        with small_disk(self.path('small'), 'size=1700k') as disk:
            target = os.path.join(disk, 'out')
            old = blockrand('build', SAMPLE, '-o', target, '--lod', '2', '--bbox', '11.0290,51.4690,11.0300,51.4700', '--formats', 'gltf')
            self.assertEqual(old.code, 0, old)
            self.ended_badly(self.rebuild(target), target, hashes(target), 'needed', 'free')

    def test_no_inodes_left(self):
        """ENOSPC at the creation of the n-th file, although there is space enough: from the first to the last but one."""
        with small_disk(self.path('inodes'), 'size=64m') as disk:
            target = os.path.join(disk, 'out')
            self.assertEqual(blockrand('build', SAMPLE, '-o', target, '--lod', '2').code, 0)
            before, used = hashes(target), os.statvfs(disk)
            used = used.f_files - used.f_ffree
            refused = 0
            for spare in range(1, 40, 2):  # every second: each try is a build
                changed = call(['mount', '-o', f'remount,size=64m,nr_inodes={used + spare}', disk])
                self.assertEqual(changed.code, 0, changed)
                run = self.rebuild(target)
                if run.code == 0:
                    break
                refused += 1
                self.ended_badly(run, target, before, 'no space left', 'full')
            self.assertEqual(run.code, 0, 'with room enough it must work')
            self.assertGreater(refused, 3)

    def test_disk_fills_up_meanwhile(self):
        """Another program takes the space after the check: ENOSPC in the middle of a write."""
        with small_disk(self.path('filling'), 'size=900m') as disk:
            target = os.path.join(disk, 'out')
            self.assertEqual(blockrand('build', SAMPLE, '-o', target, '--lod', '2').code, 0)
            before = hashes(target)
            process = self.start(target)
            self.assertTrue(self.wait_for_files(process, target, 1))
            with open(os.path.join(disk, 'ballast'), 'wb', buffering=0) as ballast:
                try:
                    while True:
                        ballast.write(bytes(1 << 22))
                except OSError as error:
                    self.assertEqual(error.errno, errno.ENOSPC)
                # Keep it full: what the program writes between two checks must not fit.
                while process.poll() is None:
                    with contextlib.suppress(OSError):
                        ballast.write(bytes(4096))
                    time.sleep(0.001)
            _, err = process.communicate()
            self.assertEqual(process.returncode, 4, err.decode())
            self.assertIn('full', err.decode().lower())
            self.assertEqual(hashes(target), before)
            self.assertEqual(stray_siblings(target), [])

    def test_read_only_disk(self):
        with small_disk(self.path('readonly'), 'size=64m') as disk:
            target = os.path.join(disk, 'out')
            self.assertEqual(blockrand('build', SAMPLE, '-o', target, '--lod', '2').code, 0)
            before = hashes(target)
            self.assertEqual(call(['mount', '-o', 'remount,ro', disk]).code, 0)
            run = self.rebuild(target)
            self.assertIn(run.code, (1, 4), run)
            self.assertIn('read-only', run.err.lower())
            self.assertEqual(hashes(target), before)

    def test_few_open_files(self):
        """A limit on descriptors is no reason to lose anything: it works, or says why not."""
        target = self.build(SAMPLE, 'descriptors', '--lod', '0')
        before = hashes(target)
        run = self.rebuild(target, preexec=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (12, 12)))
        if run.code == 0:
            self.hashes_match(target)
        else:
            self.assertIn(run.code, (2, 4), run)
            self.assertEqual(hashes(target), before)
        self.assertEqual(stray_siblings(target), [])

    def test_stdout_that_is_full(self):
        """The summary cannot be printed: exit code not 0, the build is there all the same."""
        target = self.path('stdout')
        with open('/dev/full', 'wb') as full:
            done = subprocess.run([Setup.program, 'build', SAMPLE, '-o', target, '--lod', '2'], stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.hashes_match(target)


if __name__ == '__main__':
    main()
