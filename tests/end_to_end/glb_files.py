"""What tests read from GLB files themselves, apart from the program and its validators."""
import json
import os
import struct

from blockrand_run import files_of


def glb_json(path):
    with open(path, 'rb') as f:
        f.read(12)
        length, = struct.unpack('<I4x', f.read(8))
        return json.loads(f.read(length))


def places(folder):
    """Placed elements of all GLBs below tiles/, by how they are written."""
    found = {'ext': 0, 'nodes': 0, 'meshes': 0}
    for name in files_of(folder, '.glb'):
        if not name.startswith('tiles'):
            continue
        glb = glb_json(os.path.join(folder, name))
        for node in glb.get('nodes', []):
            instancing = node.get('extensions', {}).get('EXT_mesh_gpu_instancing')
            if instancing:
                found['ext'] += glb['accessors'][instancing['attributes']['TRANSLATION']]['count']
            elif 'extras' in node:
                found['nodes'] += 1
        found['meshes'] += len(glb.get('meshes', []))
    return found
