"""The same input gives the same bytes: whatever the threads, the call, the file format, the order of objects, the CPU."""
import bz2
import gzip
import os
import shutil
import unittest

from blockrand_run import SAMPLE, BuildTest, call, extract, main
from osm_files import read_xml, shuffle_xml, write_pbf

MODEL = ('tiles', 'tileset.json', 'citygml')
OTHER_CPU = {'GLIBC_TUNABLES': 'glibc.cpu.hwcaps=-AVX2,-FMA'}


def cpu_has_them():
    """Whether this CPU has what OTHER_CPU takes away: without it there is nothing to compare."""
    try:
        with open('/proc/cpuinfo') as f:
            flags = next(line for line in f if line.startswith('flags')).split()
    except (OSError, StopIteration):
        return False
    return 'avx2' in flags and 'fma' in flags


class Determinism(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.plain = cls().build(SAMPLE, 'plain', '--jobs', '1')

    def test_threads(self):
        self.same_files(self.plain, self.build(SAMPLE, 'jobs4', '--jobs', '4'))

    def test_two_calls(self):
        """With every output there is, and into another folder at another time."""
        options = ['--single-glb', '--gzip', '--ground-height', '100']
        first, second = (self.build(SAMPLE, name, *options) for name in ('first', 'second'))
        self.same_files(first, second)

    @unittest.skipUnless(cpu_has_them(), 'this CPU has no AVX2 and FMA to switch off')
    def test_other_cpu(self):
        self.same_files(self.plain, self.build(SAMPLE, 'cpu', env=OTHER_CPU))

    def test_shuffled_objects(self):
        for seed in (1, 2):
            source = shuffle_xml(SAMPLE, self.path(f'shuffled{seed}.osm'), seed)
            out = self.build(source, f'shuffled{seed}')
            self.same_files(self.plain, out, *MODEL, 'report.json')

    def test_formats_of_the_extract(self):
        """The sample as .osm.pbf, .osm.bz2 and .osm.gz, written here without any OSM library."""
        with open(SAMPLE, 'rb') as f:
            data = f.read()
        half = len(data) // 2
        sources = [write_pbf(self.path('own.osm.pbf'), read_xml(SAMPLE)),
                   self.place('own.osm.gz', gzip.compress(data)),
                   self.place('own.osm.bz2', bz2.compress(data)),
                   # Parallel packers write several streams one after the other.
                   self.place('two.osm.gz', gzip.compress(data[:half]) + gzip.compress(data[half:])),
                   self.place('two.osm.bz2', bz2.compress(data[:half]) + bz2.compress(data[half:]))]
        for source in sources:
            with self.subTest(os.path.basename(source)):
                out = self.build(source, os.path.basename(source) + '-out')
                self.same_files(self.plain, out, *MODEL, 'report.json')

    @unittest.skipUnless(shutil.which('osmium'), 'osmium-tool is not installed')
    def test_formats_by_osmium(self):
        self.convert_and_compare(SAMPLE, self.plain)

    def convert_and_compare(self, source, plain):
        stem = os.path.basename(source).split('.')[0]
        for end in ('osm', 'osm.pbf', 'osm.bz2', 'osm.gz'):
            with self.subTest(f'{stem} as {end}'):
                copy = self.path(f'{stem}.{end}')
                made = call(['osmium', 'cat', source, '-o', copy, '--overwrite'])
                self.assertEqual(made.code, 0, made)
                out = self.build(copy, f'{stem}-{end}')
                self.same_files(plain, out, *MODEL, 'report.json')
                shutil.rmtree(out)


class DeterminismOfRealExtracts(BuildTest):
    """The same on real dirt: rounding on the edge, broken rings, thousands of roofs."""

    def check(self, name, formats):
        source = extract(name)
        if not source:
            self.skipTest(f'{name} is not in the shared data')
        plain = self.build(source, 'plain-' + name, '--jobs', '1')
        for label, options, env in (('jobs 4', ['--jobs', '4'], None), ('other CPU', [], OTHER_CPU)):
            with self.subTest(label):
                out = self.build(source, 'again-' + name, *options, env=env)
                self.same_files(plain, out)
                shutil.rmtree(out)
        if formats and shutil.which('osmium'):
            Determinism.convert_and_compare(self, source, plain)

    def test_frankfurter_allee(self):
        self.check('berlin_frankfurter_allee.osm.pbf', formats=True)

    def test_lauf(self):
        self.check('lauf-2020-clipped.osm.pbf', formats=False)

    def test_ingolstadt(self):
        self.check('ingolstadt-altstadt.osm', formats=True)


if __name__ == '__main__':
    main()
