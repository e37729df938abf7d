#!/usr/bin/env python3
"""What each kind of thing on roofs adds to a packed tileset: bytes a building, draws, CPU.

    tests/bench/roof_bytes.py [--program P] EXTRACT…

Each extract is built at LoD3 (glTF, meshopt) as shipped, and once for each kind with that kind turned off in a copy of
configs/grammars/roofscape.cga. The difference is what the kind costs.
"""
import argparse
import json
import os
import re
import resource
import shutil
import struct
import subprocess
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
OFF = {'dormers': {'dormer_share': '0'}, 'cross gables': {'cross_gable_share': '0'}, 'windows of gables': {'gable_window_share': '0'},
       'eaves and gutters': {'eaves_overhang': '0'}, 'gutters': {'gutters': '0'}, 'verges': {'verge_overhang': '0'},
       'caps': {'ridge_caps': '0'}, 'parapets': {'parapet_height': '0'}}


def measured(program, extract, values, folder):
    configs, out = os.path.join(folder, 'configs'), os.path.join(folder, 'out')
    for old in (configs, out):
        shutil.rmtree(old, ignore_errors=True)
    shutil.copytree(os.path.join(SOURCE, 'configs'), configs)
    path = os.path.join(configs, 'grammars', 'roofscape.cga')
    with open(path, encoding='utf-8') as f:
        text = f.read()
    for name, value in values.items():
        # An attribute goes on over lines that begin with white space.
        text, found = re.subn(rf'^attr {name} = .*(?:\n[ \t]+.*)*', f'attr {name} = {value}', text, flags=re.M)
        assert found == 1, name
    with open(path, 'w', encoding='utf-8') as f:
        f.write(text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, 'build', extract, '-o', out, '--lod', '3', '--surroundings', 'off', '--formats', 'gltf', '--compress', 'meshopt', '--configs', configs],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    size = draws = 0
    for place, _, names in os.walk(os.path.join(out, 'tiles')):
        for name in names:
            if not name.endswith('.glb'):
                continue
            with open(os.path.join(place, name), 'rb') as f:
                data = f.read()
            size += len(data)
            if '_lod' in name:
                continue
            document = json.loads(data[20:20 + struct.unpack('<I', data[12:16])[0]])
            draws += sum(len(document['meshes'][n['mesh']]['primitives']) for n in document['nodes'] if 'mesh' in n)
    with open(os.path.join(out, 'build.json'), encoding='utf-8') as f:
        buildings = json.load(f)['counts']['buildings']
    return size, draws, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, buildings


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--program', default=os.path.join(SOURCE, 'build', 'release', 'blockrand'))
    parser.add_argument('extract', nargs='+')
    options = parser.parse_args()
    for extract in options.extract:
        with tempfile.TemporaryDirectory() as folder:
            size, draws, cpu, buildings = measured(options.program, extract, {}, folder)
            print(f'{os.path.basename(extract)}: {buildings} buildings, {size / buildings:.0f} bytes a building, {draws} draws, {cpu:.2f} CPU s', flush=True)
            for kind, values in OFF.items():
                without, fewer, less, _ = measured(options.program, extract, values, folder)
                print(f'  {kind}: {(size - without) / buildings:.0f} bytes a building, {draws - fewer} draws, {cpu - less:+.2f} CPU s', flush=True)


if __name__ == '__main__':
    main()
