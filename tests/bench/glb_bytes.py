"""Where the bytes of GLBs are: glb_bytes.py FILE.glb… prints sums over all files.

Buffer views count with the bytes they have in the file: compressed ones compressed.
"""
import collections
import json
import os
import struct
import sys

WIDTH = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}
SIZE = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
MESHOPT = 'EXT_meshopt_compression'


def views_by_use(glb):
    """What each buffer view holds: 'POSITION', 'indices', 'place ROTATION', 'table' …"""
    use = {}
    accessors = glb.get('accessors', [])

    def note(accessor, what):
        use.setdefault(accessors[accessor]['bufferView'], what)
    for node in glb.get('nodes', []):
        for name, accessor in node.get('extensions', {}).get('EXT_mesh_gpu_instancing', {}).get('attributes', {}).items():
            note(accessor, f'place {name}')
    for mesh in glb.get('meshes', []):
        for primitive in mesh['primitives']:
            note(primitive['indices'], 'indices')
            for name, accessor in primitive['attributes'].items():
                a = accessors[accessor]
                note(accessor, f'{name} of {SIZE[a["componentType"]] * 8} bits')
    return use


def main(files):
    total = collections.Counter()
    for name in files:
        with open(name, 'rb') as f:
            data = f.read()
        length, = struct.unpack_from('<I', data, 12)
        glb = json.loads(data[20:20 + length])
        total['files'] += 1
        total['bytes'] += os.path.getsize(name)
        total['JSON'] += length
        for key in ('accessors', 'meshes', 'nodes', 'materials'):
            total[f'number of {key}'] += len(glb.get(key, []))
            total[f'JSON of {key}'] += len(json.dumps(glb.get(key, []), separators=(',', ':')))
        for node in glb.get('nodes', []):
            attributes = node.get('extensions', {}).get('EXT_mesh_gpu_instancing', {}).get('attributes')
            total['number of placed elements'] += glb['accessors'][attributes['TRANSLATION']]['count'] if attributes else 0
        total['number of primitives'] += sum(len(m['primitives']) for m in glb.get('meshes', []))
        use = views_by_use(glb)
        for i, view in enumerate(glb.get('bufferViews', [])):
            total[use.get(i, 'property table')] += view.get('extensions', {}).get(MESHOPT, view)['byteLength']
    for what in sorted(total):
        print(f'{what:32} {total[what]:>12,}')


if __name__ == '__main__':
    main(sys.argv[1:])
