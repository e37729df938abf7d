#!/usr/bin/env python3
"""This program beside an older build of it and beside OSM2World, on the same files, one run of each in turn.

    compare_peers.py [--program build/release/blockrand] [--before OLDER] [--osm2world OSM2World.jar] [--repeat 5]
                     [--options "--lod 3 --formats gltf"] [--gate] EXTRACT-OR-NAME-PART…

Names are those of ../shared/data/osm. Prints Markdown. Times are CPU seconds of the whole process, the median of the runs, which
alternate, so that other work on the machine meets all alike; wall seconds stand beside. The rival reads buildings alone, filtered by osmium-tool
before, and writes one GLB at its level of detail 4: what it has no window for, it draws none, hence the second table: per displayed
window and per displayed triangle.

With --before the last column is our CPU time as a part of the older program's, and REGRESSION where that is above 1.05, or where draws,
bytes or stored triangles have grown by as much. --gate makes that exit code 1; without, it is only said.
"""
import argparse
import json
import os
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import glb_counts

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DATA = os.path.join(SOURCE, '..', 'shared', 'data', 'osm')
WORSE = 1.05  # below it, differences of the same program from run to run were seen
ENDS = ('.osm', '.osm.gz', '.osm.bz2', '.osm.pbf')


class Contender:
    """A program that makes GLBs of an extract."""

    def __init__(self, name, command, windows):
        self.name, self.command, self.windows = name, command, windows
        self.runs = []

    def run(self, extract, folder):
        """One run: (CPU seconds, wall seconds, bytes of memory at the peak)."""
        out = os.path.join(folder, 'out')
        shutil.rmtree(out, ignore_errors=True)
        os.makedirs(out)
        started = time.monotonic()
        with tempfile.TemporaryFile() as said:
            process = subprocess.Popen(self.command(extract, out), stdout=said, stderr=said)
            _, status, usage = os.wait4(process.pid, 0)
            wall = time.monotonic() - started
            if status != 0:
                said.seek(0)
                sys.exit(f'{self.name} failed on {extract}:\n{said.read().decode(errors="replace")[-2000:]}')
        self.runs.append((usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss * 1024))
        return out

    def row(self, out):
        counts = glb_counts.counts(out)
        cpu, wall, memory = (statistics.median(r[i] for r in self.runs) for i in range(3))
        return {'program': self.name, 'cpu_seconds': cpu, 'wall_seconds': wall, 'memory_bytes': memory, 'windows': self.windows(out), **counts}


def windows_of_build(out):
    with open(os.path.join(out, 'build', 'build.json'), encoding='utf-8') as f:
        return json.load(f)['counts'].get('windows', 0)


def ours(name, program, options):
    return Contender(name, lambda extract, out: [program, 'build', extract, '-o', os.path.join(out, 'build'), '-q', *options], windows_of_build)


def buildings_of(extract, folder):
    """What the rival reads: buildings and their parts."""
    path = os.path.join(folder, 'buildings.osm.pbf')
    subprocess.run(['osmium', 'tags-filter', extract, 'wr/building', 'wr/building:part', '-o', path, '--overwrite'], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return path


def rival(jar, folder):
    def command(extract, out):
        return ['java', '-Xmx8g', '-jar', jar, 'convert', '-i', os.path.join(folder, 'buildings.osm.pbf'), '-o', os.path.join(out, 'out.glb'), '--lod', '4']
    return Contender('OSM2World', command, lambda out: None)


def measured(extract, contenders, repeat, folder):
    rows = {}
    for c in contenders:
        c.runs = []
    for turn in range(repeat):
        for c in contenders:
            out = c.run(extract, folder)
            if turn == repeat - 1:
                rows[c.name] = c.row(out)
    return rows


def is_worse(now, before):
    return [key for key in ('cpu_seconds', 'draws', 'bytes', 'gzip_bytes', 'stored_triangles') if now[key] > WORSE * before[key]]


def found(names):
    for name in names:
        if os.path.isfile(name):
            yield name
            continue
        files = [f for f in sorted(os.listdir(DATA)) if name in f and f.endswith(ENDS)] if os.path.isdir(DATA) else []
        if not files:
            sys.exit(f'{name}: neither a file nor part of a name in {DATA}')
        yield from (os.path.join(DATA, f) for f in files)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition('\n')[0])
    parser.add_argument('--program', default=os.path.join(SOURCE, 'build', 'release', 'blockrand'))
    parser.add_argument('--before', help='an older build of this program')
    parser.add_argument('--osm2world', metavar='JAR')
    parser.add_argument('--options', default='--lod 3 --surroundings off --formats gltf')
    parser.add_argument('--repeat', type=int, default=5)
    parser.add_argument('--gate', action='store_true')
    parser.add_argument('--json', help='a file for the figures')
    parser.add_argument('names', nargs='+')
    args = parser.parse_args()
    options = shlex.split(args.options)
    folder = tempfile.mkdtemp(prefix='blockrand-peers-')
    contenders = [ours('this', args.program, options)]
    if args.before:
        contenders.append(ours('before', args.before, options))
    if args.osm2world:
        contenders.append(rival(args.osm2world, folder))
    all_rows, worse = {}, False
    print(f'`build {args.options}`, {args.repeat} runs each in turn, {os.cpu_count()} cores.\n')
    print('| extract | program | CPU s | wall s | peak MB | GLBs MB | gzip -9 MB | draws | most a file | stored tri | displayed tri | windows | this : it |')
    print('|---|---|---|---|---|---|---|---|---|---|---|---|---|')
    try:
        for extract in found(args.names):
            if args.osm2world:
                buildings_of(extract, folder)
            rows = measured(extract, contenders, args.repeat, folder)
            all_rows[os.path.basename(extract)] = rows
            now = rows['this']
            for name, r in rows.items():
                ratio = '' if name == 'this' else f'{now["cpu_seconds"] / r["cpu_seconds"]:.2f}'
                if name == 'before' and (grown := is_worse(now, r)):
                    ratio, worse = f'{ratio} REGRESSION: {", ".join(grown)}', True
                print(f'| {os.path.basename(extract)} | {name} | {r["cpu_seconds"]:.2f} | {r["wall_seconds"]:.2f} | {r["memory_bytes"] / 1e6:.0f} | {r["bytes"] / 1e6:.2f} '
                      f'| {r["gzip_bytes"] / 1e6:.2f} | {r["draws"]:,} | {r["most_file_draws"]:,} | {r["stored_triangles"]:,} | {r["displayed_triangles"]:,} '
                      f'| {"-" if r["windows"] is None else format(r["windows"], ",")} | {ratio} |', flush=True)
        print('\n| extract | program | CPU us a displayed triangle | bytes a displayed triangle | CPU us a window | bytes a window |')
        print('|---|---|---|---|---|---|')
        for extract, rows in all_rows.items():
            for name, r in rows.items():
                def per(count, value):
                    return f'{value / count:.2f}' if count else '-'
                cpu = 1e6 * r['cpu_seconds']
                print(f'| {extract} | {name} | {per(r["displayed_triangles"], cpu)} | {per(r["displayed_triangles"], r["bytes"])} | {per(r["windows"], cpu)} | {per(r["windows"], r["bytes"])} |')
        if args.json:
            with open(args.json, 'w', encoding='utf-8') as f:
                json.dump(all_rows, f, indent=1)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 1 if worse and args.gate else 0


if __name__ == '__main__':
    sys.exit(main())
