#!/usr/bin/env python3
"""Which way ridges run, where the map does not say: right how often?

    tests/bench/ridge_direction.py [--program P [--program Q …]] EXTRACT…

Of buildings that are tagged roof:orientation or roof:direction the tags are taken away (both, on all objects), the extract is
built at LoD2, and ridges are set against those of a build with the tags: right within 30 degrees. Roofs without a ridge in
either build are left out. Several programs are asked the same: before and after. Needs osmium-tool for .pbf.
"""
import argparse
import glob
import gzip
import json
import os
import re
import subprocess
import tempfile

KEYS = re.compile(r'''\s*<tag k=["']roof:(orientation|direction)["'] v=("[^"]*"|'[^']*')\s*/>''')


def text_of(path):
    if path.endswith('.pbf'):
        return subprocess.run(['osmium', 'cat', path, '-f', 'osm', '-o', '-'], stdout=subprocess.PIPE, check=True).stdout.decode()
    with (gzip.open if path.endswith('.gz') else open)(path, 'rt', encoding='utf-8') as f:
        return f.read()


def ridges(program, path, out):
    subprocess.run([program, 'build', path, '-o', out, '--lod', '2', '--formats', 'cityjson'], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    found = {}
    for name in glob.glob(os.path.join(out, 'cityjson', '*.jsonl')):
        with open(name, encoding='utf-8') as f:
            for line in f:
                for key, o in json.loads(line)['CityObjects'].items():
                    a = o.get('attributes', {})
                    if 'ridge_direction' in a:
                        found[key] = (a['ridge_direction'], a.get('ridge_direction_source'), a.get('built_roof'))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--program', action='append')
    parser.add_argument('extract', nargs='+')
    options = parser.parse_args()
    programs = options.program or ['build/release/blockrand']
    totals = [[0, 0] for _ in programs]
    for path in options.extract:
        with tempfile.TemporaryDirectory() as folder:
            text = text_of(path)
            tagged, hidden = os.path.join(folder, 'tagged.osm'), os.path.join(folder, 'hidden.osm')
            with open(tagged, 'w', encoding='utf-8') as f:
                f.write(text)
            with open(hidden, 'w', encoding='utf-8') as f:
                f.write(KEYS.sub('', text))
            truth = {k: v for k, v in ridges(programs[-1], tagged, os.path.join(folder, 'truth')).items() if v[1] == 'tag'}
            for i, program in enumerate(programs):
                told = ridges(program, hidden, os.path.join(folder, f'told{i}'))
                asked = [k for k in truth if k in told]
                right = sum(abs((told[k][0] - truth[k][0] + 90) % 180 - 90) <= 30 for k in asked)
                totals[i][0] += right
                totals[i][1] += len(asked)
                print(f'{os.path.basename(path)}\t{program}\t{right} of {len(asked)} right ({len(truth)} tagged)', flush=True)
    for program, (right, of) in zip(programs, totals):
        print(f'all\t{program}\t{right} of {of} right')


if __name__ == '__main__':
    main()
