#!/usr/bin/env python3
"""How long `blockrand compare` takes and how much memory: hand-built models of ../shared/data/reference against
themselves, without pictures and with them.

    tests/bench/compare.py [--program build/release/bin/blockrand] [--jobs N] [NAME-PART …]

Prints Markdown to stdout. Times are of this machine on this day: compare rows of one run with each other only. The bar
(issue 7): 500 reference buildings in 60 s on two cores, pictures apart, below 1 GB.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MODELS = {'Den Haag, CityJSON': ['cityjson', 'DenHaag_01.json'], 'Berlin, LoD2': ['berlin-lod2'],
          'Pariser Platz': ['berlin-pariser-platz'], 'Ingolstadt, LoD3': ['ingolstadt-lod3']}


def measured(command):
    """Seconds, seconds of all threads, bytes at the peak. In a process of its own, whose only child it is."""
    started = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f'failed: {" ".join(command)}')
    return time.monotonic() - started, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition('\n')[0])
    parser.add_argument('--program', default=os.path.join(SOURCE, 'build', 'release', 'bin', 'blockrand'))
    parser.add_argument('--shared', default=os.path.join(SOURCE, '..', 'shared'))
    parser.add_argument('--jobs', default='0')
    parser.add_argument('names', nargs='*')
    options = parser.parse_args()
    data = os.path.join(options.shared, 'data', 'reference')
    if not os.path.isdir(data):
        sys.exit(f'bench: no hand-built models at {data}; nothing measured')
    print('| model against itself | buildings | matches | pictures | s | s of all threads | buildings/s | peak MB | compare.html MB |')
    print('|---|---|---|---|---|---|---|---|---|')
    folder = tempfile.mkdtemp(prefix='blockrand-bench-')
    try:
        for name, path in MODELS.items():
            if options.names and not any(n.lower() in name.lower() for n in options.names):
                continue
            model, out = os.path.join(data, *path), os.path.join(folder, 'out')
            for pictures in (0, 200):
                seconds, busy, peak = measured([options.program, 'compare', model, model, '-o', out, '--force', '-q',
                                                '--pictures', str(pictures), '--jobs', options.jobs])
                with open(os.path.join(out, 'compare.json'), encoding='utf-8') as f:
                    result = json.load(f)
                buildings, matches = result['reference']['buildings'], result['counts']['matches']
                page = os.path.getsize(os.path.join(out, 'compare.html'))
                print(f'| {name} | {buildings} | {matches} | {min(pictures, matches)} | {seconds:.1f} | {busy:.1f} '
                      f'| {buildings / seconds:.0f} | {peak / 1e6:.0f} | {page / 1e6:.1f} |', flush=True)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == '__main__':
    main()
