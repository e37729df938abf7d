#!/usr/bin/env python3
"""Random edit scripts, one night after the other: after each the region's build must be that of a clean build, byte for byte.

    python3 tests/bench/region/random_edits.py EXTRACT.osm[.gz] --nights 200 [--lod 3] [--seed 1] [--areas 13] [--around 0.5] [--work FOLDER] [--program P]

An extract as XML, as tests/end_to_end/osm_files.py reads it. Prints a line a night: edits, tiles built and kept, CPU seconds of the
update and of the clean build. Stops at the first difference, names the files, and leaves the folder to look at.
"""
import argparse
import gzip
import json
import os
import random
import resource
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, '..', '..', 'end_to_end'))
from blockrand_run import hashes  # noqa: E402
from osm_files import read_xml  # noqa: E402
from region_run import LIMITS_OFF, Map  # noqa: E402
from surroundings_edits import Surroundings  # noqa: E402


def cpu_of(arguments):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(arguments, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if run.returncode:
        sys.exit(f'{" ".join(arguments)}\n{run.stdout}{run.stderr}exit code {run.returncode}')
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('extract')
    parser.add_argument('--nights', type=int, default=20)
    parser.add_argument('--lod', default='3')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--edits', help='of a night, for example 1,3,20', default='1,2,5,20')
    parser.add_argument('--areas', default='none', help='level of the areas that are built one by one')
    parser.add_argument('--around', type=float, default=0, help='share of the edits that are of what stands around houses')
    parser.add_argument('--work', default='region-edits')
    parser.add_argument('--program', default=os.path.join(HERE, '..', '..', '..', 'build', 'release', 'blockrand'))
    options = parser.parse_args()
    shutil.rmtree(options.work, ignore_errors=True)
    folder = os.path.join(options.work, 'region')
    areas = '0' if options.areas == 'none' else options.areas
    surroundings = 'on' if options.around > 0 else 'auto'
    os.makedirs(folder)
    with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
        f.write(LIMITS_OFF + f'[build]\nlod = {options.lod}\nareas = {areas}\nsurroundings = "{surroundings}"\n[region]\nkeep = 2\n')
    source = options.extract
    if source.endswith('.gz'):
        source = os.path.join(options.work, 'extract.osm')
        with gzip.open(options.extract) as packed, open(source, 'wb') as plain:
            shutil.copyfileobj(packed, plain)
    map_, rng = Surroundings(read_xml(source)), random.Random(options.seed)
    first = cpu_of([options.program, 'update', folder, map_.write(os.path.join(options.work, 'begin.osm')), '--progress', 'none'])
    print(f'first build {first:.1f} CPU s', flush=True)
    sums = [0.0, 0.0]
    for night in range(1, options.nights + 1):
        count = rng.choice([int(n) for n in options.edits.split(',')])
        around = sum(rng.random() < options.around for _ in range(count)) if options.around else 0
        map_.random_edits(rng, around)
        Map.random_edits(map_, rng, count - around)
        changes = map_.write_changes(os.path.join(options.work, 'night.osc'))
        update = cpu_of([options.program, 'update', folder, changes, '--progress', 'none'])
        with open(os.path.join(folder, 'log', 'runs.jsonl'), encoding='utf-8') as f:
            last = json.loads(f.readlines()[-1])
        if last['state'] == 'unchanged':
            continue
        tiles = last['tiles']
        clean = cpu_of([options.program, 'build', map_.write(os.path.join(options.work, 'region.osm')), '-o', os.path.join(options.work, 'clean'),
                           '--force', '--allow-shrink', '100', '--lod', options.lod, '--areas', areas, '--surroundings', surroundings, '--progress', 'none'])
        sums[0] += update
        sums[1] += clean
        print(f'night {night}: {count} edits, {tiles["built"]} tiles built, {tiles["kept"]} kept, update {update:.1f} CPU s, clean {clean:.1f}', flush=True)
        mine, its = (hashes(os.path.realpath(f)) for f in (os.path.join(folder, 'current'), os.path.join(options.work, 'clean')))
        for files in (mine, its):
            for path in [p for p in files if os.path.basename(p) == 'run.json']:
                del files[path]
        if mine != its:
            sys.exit('differ: ' + ', '.join(sorted(k for k in set(mine) | set(its) if mine.get(k) != its.get(k))[:20]))
    print(f'{options.nights} nights, all equal; update / clean = {sums[0] / sums[1]:.3f}')


main()
