"""What `blockrand info` tells of memory and disk, against builds: estimate.py BLOCKRAND EXTRACT… [--lod 2,3] [--kept FILE]

Builds every extract (a process of its own each time, --jobs 2, unless --jobs says otherwise), takes peak memory and bytes from its
run.json and its files, and prints them beside what `info` tells, with the ratio told / real. --formats chooses formats as of the program;
several sets, separated by spaces, are measured one after the other. --kept FILE keeps what builds took, so that a later run of
the script with another program need not build again.

Exit code 1 when a ratio lies outside of 1/1.5 … 1.5 on more than --may-miss rows (0).
"""
import argparse
import collections
import json
import os
import shutil
import subprocess
import sys
import tempfile

FACTOR = 1.5
# Where a file's bytes belong to, by the beginning of its path: the format's name.
FORMAT_OF = {'tiles/': 'gltf', 'tileset.json': 'gltf', 'citygml/': 'citygml', 'cityjson/': 'cityjson', 'buildings.': 'gpkg',
             'report.html': 'report', 'report.json': 'report.json', 'explain/': 'explain', 'plan.png': 'report'}


def bytes_by_format(folder):
    found = collections.Counter()
    for place, _, files in os.walk(folder):
        for name in files:
            path = os.path.relpath(os.path.join(place, name), folder)
            format_ = next((f for start, f in FORMAT_OF.items() if path.startswith(start)), 'other')
            found[format_] += os.path.getsize(os.path.join(place, name))
    return dict(found)


def build(program, extract, lod, jobs, formats, scratch):
    out = os.path.join(scratch, 'build')
    command = [program, 'build', extract, '-o', out, '--lod', str(lod), '--jobs', str(jobs), '--quiet']
    subprocess.run(['nice', *command, *(['--formats', formats] if formats else [])], check=True, stderr=subprocess.DEVNULL)
    with open(os.path.join(out, 'run.json'), encoding='utf-8') as f:
        run = json.load(f)
    with open(os.path.join(out, 'build.json'), encoding='utf-8') as f:
        record = json.load(f)
    real = {'memory_bytes': run['peak_rss_bytes'], 'store_bytes': run['store_bytes'], 'seconds': run['seconds'],
            'tiles_in_flight': run['tiles_in_flight'], 'counts': record['counts'], 'by_format': bytes_by_format(out)}
    real['disk_bytes'] = sum(real['by_format'].values())
    shutil.rmtree(out)
    return real


def told(program, extract, lod, jobs, formats):
    command = [program, 'info', extract, '--lod', str(lod), '--jobs', str(jobs), '--json', '--progress', 'none']
    text = subprocess.run([*command, *(['--formats', formats] if formats else [])], check=True, stdout=subprocess.PIPE).stdout
    return json.loads(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('program')
    parser.add_argument('extracts', nargs='+')
    parser.add_argument('--lod', default='2,3')
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--formats', default='', help='sets of formats, separated by spaces; without: the default')
    parser.add_argument('--kept', help='file of what builds took')
    parser.add_argument('--only-build', action='store_true', help='measure, compare with nothing')
    parser.add_argument('--may-miss', type=int, default=0)
    asked = parser.parse_args()
    kept = {}
    if asked.kept and os.path.exists(asked.kept):
        with open(asked.kept, encoding='utf-8') as f:
            kept = json.load(f)
    missed = 0
    print(f'{"extract":32} lod {"formats":10} {"memory MB":>9} {"told":>7} {"ratio":>6} {"disk MB":>9} {"told":>7} {"ratio":>6} '
          f'{"seconds":>8} {"told":>7}')
    for extract in asked.extracts:
        for lod in asked.lod.split(','):
            for formats in asked.formats.split() or ['']:
                name = os.path.basename(extract).split('.')[0]
                key = f'{name} {lod} {asked.jobs} {formats or "default"}'
                if key not in kept:
                    with tempfile.TemporaryDirectory(dir=os.environ.get('TMPDIR')) as scratch:
                        kept[key] = build(asked.program, extract, lod, asked.jobs, formats, scratch)
                    if asked.kept:
                        with open(asked.kept, 'w', encoding='utf-8') as f:
                            json.dump(kept, f, indent=1)
                real = kept[key]
                if asked.only_build:
                    print(f'{key}: {real["memory_bytes"] / 1e6:.0f} MB, {real["disk_bytes"] / 1e6:.0f} MB', flush=True)
                    continue
                e = told(asked.program, extract, lod, asked.jobs, formats)['estimate']
                ratios = [e[k] / max(1, real[k]) for k in ('memory_bytes', 'disk_bytes')]
                missed += sum(not 1 / FACTOR <= r <= FACTOR for r in ratios)
                print(f'{name:32} {lod:3} {formats or "default":10} {real["memory_bytes"] / 1e6:9.0f} {e["memory_bytes"] / 1e6:7.0f} '
                      f'{ratios[0]:6.2f} {real["disk_bytes"] / 1e6:9.1f} {e["disk_bytes"] / 1e6:7.1f} {ratios[1]:6.2f} '
                      f'{real["seconds"]:8.1f} {e["seconds"]:7.1f}', flush=True)
    print(f'{missed} figures are off by more than a factor of {FACTOR}')
    return 0 if missed <= asked.may_miss else 1


if __name__ == '__main__':
    sys.exit(main())
