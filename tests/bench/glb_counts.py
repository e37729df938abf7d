"""What a tileset costs those who fetch and draw it: glb_counts.py BUILD… prints a row for each folder (or GLB).

Columns: files; draws and most draws of one file, both of the finest level of detail alone, since viewers show each tile at one
level; triangles as stored and as displayed of the same files (an instanced element counts once stored, and displayed at each
place); placed elements; bytes of all GLBs as they are, of their JSON, and of all GLBs each packed by gzip -9, as web servers send
them. A draw is a primitive of a node of the scene; an instanced node draws each of its primitives once.

--json prints the same as a list of objects. --most-draws N, --most-file-draws N and --most-bytes N make counts of which one is
above its limit an error (exit code 1).
"""
import argparse
import json
import os
import re
import struct
import sys
import zlib

JSON_CHUNK = 0x4E4F534A
COARSER = re.compile(r'_lod\d\.glb$')


def read_json(data):
    """The JSON of a GLB, and how many bytes it takes."""
    length, kind = struct.unpack_from('<II', data, 12)
    if data[:4] != b'glTF' or kind != JSON_CHUNK:
        raise ValueError('not a GLB')
    return json.loads(data[20:20 + length]), length


def gzip_size(data):
    """Bytes of gzip -9: of a header of 18 bytes and what zlib makes."""
    return len(zlib.compress(data, 9)) - 6 + 18


def count_scene(glb):
    """(draws, stored triangles, displayed triangles, placed elements) of the default scene."""
    accessors, nodes, meshes = (glb.get(key, []) for key in ('accessors', 'nodes', 'meshes'))

    def triangles(primitive):
        of = primitive.get('indices', primitive['attributes']['POSITION'])
        return accessors[of]['count'] // 3
    by_mesh = [[triangles(p) for p in mesh['primitives']] for mesh in meshes]
    draws = displayed = places = 0
    used = set()
    scenes = glb.get('scenes', [])
    left = list(scenes[glb.get('scene', 0)].get('nodes', [])) if scenes else []
    while left:
        node = nodes[left.pop()]
        left.extend(node.get('children', []))
        if 'mesh' not in node:
            continue
        instances = node.get('extensions', {}).get('EXT_mesh_gpu_instancing', {}).get('attributes')
        number = accessors[next(iter(instances.values()))]['count'] if instances else 1
        draws += len(by_mesh[node['mesh']])
        displayed += number * sum(by_mesh[node['mesh']])
        places += number if instances else 0
        used.add(node['mesh'])
    # Primitives that share indices and positions are stored once.
    stored = {}
    for mesh in used:
        for primitive, number in zip(meshes[mesh]['primitives'], by_mesh[mesh]):
            stored[primitive.get('indices'), primitive['attributes']['POSITION']] = number
    return draws, sum(stored.values()), displayed, places


def glbs_of(path):
    """GLBs of a build's tiles, or the file itself."""
    if os.path.isfile(path):
        return [path]
    tiles = os.path.join(path, 'tiles')
    found = []
    for folder, _, names in os.walk(tiles if os.path.isdir(tiles) else path):
        found += [os.path.join(folder, name) for name in names if name.endswith('.glb')]
    return sorted(found)


def counts(path):
    """All counts of a folder or file, by name."""
    total = dict.fromkeys(('files', 'finest_files', 'draws', 'most_file_draws', 'stored_triangles', 'displayed_triangles',
                           'places', 'bytes', 'json_bytes', 'gzip_bytes'), 0)
    for name in glbs_of(path):
        with open(name, 'rb') as f:
            data = f.read()
        glb, length = read_json(data)
        total['files'] += 1
        total['bytes'] += len(data)
        total['json_bytes'] += length
        total['gzip_bytes'] += gzip_size(data)
        if COARSER.search(name):
            continue
        draws, stored, displayed, places = count_scene(glb)
        total['finest_files'] += 1
        total['draws'] += draws
        total['most_file_draws'] = max(total['most_file_draws'], draws)
        total['stored_triangles'] += stored
        total['displayed_triangles'] += displayed
        total['places'] += places
    return total


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('paths', nargs='+', metavar='BUILD')
    parser.add_argument('--json', action='store_true')
    parser.add_argument('--most-draws', type=int)
    parser.add_argument('--most-file-draws', type=int)
    parser.add_argument('--most-bytes', type=int)
    args = parser.parse_args()
    rows = [{'path': path, **counts(path)} for path in args.paths]
    if args.json:
        print(json.dumps(rows, indent=1))
    else:
        titles = ('files', 'draws', 'most a file', 'stored tri', 'displayed tri', 'places', 'bytes', 'JSON', 'gzip -9')
        print(f'{"":28}' + ''.join(f'{t:>15}' for t in titles))
        for r in rows:
            share = f'{100 * r["json_bytes"] / max(1, r["bytes"]):.1f} %'
            cells = [f'{r[k]:,}' for k in ('files', 'draws', 'most_file_draws', 'stored_triangles', 'displayed_triangles',
                                           'places', 'bytes')] + [share, f'{r["gzip_bytes"]:,}']
            print(f'{r["path"][-28:]:28}' + ''.join(f'{c:>15}' for c in cells))
    above = [f'{r["path"]}: {key} {r[key]:,} > {most:,}' for r in rows
             for key, most in (('draws', args.most_draws), ('most_file_draws', args.most_file_draws), ('bytes', args.most_bytes))
             if most is not None and r[key] > most]
    print('\n'.join(above), end='\n' if above else '')
    return 1 if above else 0


if __name__ == '__main__':
    sys.exit(main())
