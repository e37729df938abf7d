"""Validators of a build: blockrand validate, and those that are no part of the program (OGC schemas, Khronos, tile checks).

Each returns '' when all is well, else what is wrong. Absent tools raise unittest.SkipTest with the reason.
"""
import json
import os
import shutil
import struct
import tempfile
import unittest

from blockrand_run import SOURCE, Setup, blockrand, call, files_of
from model_files import MESHOPT, unpack_views

VALIDATORS = os.path.join(SOURCE, 'tests', 'validators')


def xmllint(folder):
    """Every CityGML file of a build against the OGC schema of CityGML 2.0, offline."""
    tool = shutil.which('xmllint')
    schema = os.path.join(Setup.shared or '', 'schemas', 'citygml2.xsd')
    if not tool:
        raise unittest.SkipTest('xmllint is not installed')
    if not os.path.exists(schema):
        raise unittest.SkipTest(f'no CityGML schemas at {schema}')
    files = [os.path.join(folder, f) for f in files_of(folder, '.gml', '.gml.gz')]
    if not files:
        return f'{folder}: no CityGML file'
    env = {'XML_CATALOG_FILES': os.path.join(Setup.shared, 'schemas', 'catalog.xml')}
    for first in range(0, len(files), 200):
        some = files[first:first + 200]
        run = call([tool, '--nonet', '--noout', '--schema', schema, *some], env=env, timeout=3600)
        valid = sum(line.endswith(' validates') for line in run.err.splitlines())
        if run.code != 0 or valid != len(some):
            wrong = [line for line in run.err.splitlines() if not line.endswith(' validates')]
            return f'xmllint: exit code {run.code}, {valid} of {len(some)} files validate\n' + '\n'.join(wrong[:20])
    return ''


def node(script, *arguments, needs_modules=False):
    """A check written for Node; '' when it ends with 0."""
    tool = shutil.which('node') or shutil.which('nodejs')
    if not tool:
        raise unittest.SkipTest('node is not installed')
    cwd = None
    if needs_modules:
        if not Setup.node_modules:
            raise unittest.SkipTest('gltf-validator is not installed: npm install with tests/validators/package.json')
        cwd = os.path.dirname(os.path.abspath(Setup.node_modules))
    run = call([tool, '--max-old-space-size=4096', os.path.join(VALIDATORS, script), *arguments], cwd=cwd, timeout=3600)
    return '' if run.code == 0 else str(run)


def khronos(folder, every=1):
    """The Khronos validator on every n-th GLB: no error, no warning."""
    files = [os.path.abspath(os.path.join(folder, f)) for f in files_of(folder, '.glb')][::every]
    return node('validate_gltf.mjs', '--warnings-are-errors', *files, needs_modules=True) if files else 'no GLB file'


def unpacked(folder, target):
    """A copy of tileset.json and the GLBs in which nothing is compressed: check_*.mjs know no meshopt."""
    for name in (*files_of(folder, '.glb'), 'tileset.json'):
        path = os.path.join(target, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(os.path.join(folder, name), 'rb') as f:
            data = f.read()
        if data[:4] == b'glTF' and MESHOPT.encode() in data:
            length, = struct.unpack_from('<I', data, 12)
            document = json.loads(data[20:20 + length])
            binary = unpack_views(document, data[28 + length:])
            for key in ('extensionsUsed', 'extensionsRequired'):
                document[key] = [e for e in document[key] if e != MESHOPT]
            document['buffers'] = [{'byteLength': len(binary)}]
            text = json.dumps(document).encode()
            text += b' ' * (-len(text) % 4)
            binary += bytes(-len(binary) % 4)
            data = struct.pack('<4sIIII', b'glTF', 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A) + text + \
                struct.pack('<II', len(binary), 0x004E4942) + binary
        with open(path, 'wb') as f:
            f.write(data)
    return target


def tileset(folder):
    """The rules of 3D Tiles 1.1: volumes, errors, addresses."""
    with tempfile.TemporaryDirectory() as target:
        return node('check_tileset.mjs', unpacked(folder, target))


def metadata(folder, *files):
    """Property tables, feature ids and georeference of the GLBs, and their agreement with the tileset."""
    folder = os.path.abspath(folder)
    files = [os.path.join(folder, f) for f in files or files_of(folder, '.glb')]
    if not files:
        return 'no GLB file'
    with tempfile.TemporaryDirectory() as target:
        unpacked(folder, target)
        files = [os.path.join(target, os.path.relpath(f, folder)) for f in files]
        return node('check_metadata.mjs', '--tileset', os.path.join(target, 'tileset.json'), *files)


def validate(folder, *options):
    """The program's own validators, which share no code with what writes: blockrand validate."""
    run = blockrand('validate', folder, '--progress', 'none', *options, timeout=7200)
    return '' if run.code == 0 else str(run)


def problems(folder, khronos_every=1):
    """All validators that apply to what the build holds. Tools that are absent are named on stdout and passed over."""
    wrong = []
    checks = [lambda: validate(folder)]
    if files_of(folder, '.gml', '.gml.gz'):
        checks.append(lambda: xmllint(folder))
    if os.path.exists(os.path.join(folder, 'tileset.json')):
        checks.append(lambda: tileset(folder))
    if files_of(folder, '.glb'):
        checks += [lambda: khronos(folder, khronos_every), lambda: metadata(folder)]
    for check in checks:
        try:
            wrong.append(check())
        except unittest.SkipTest as absent:
            print(f'passed over: {absent}')
    return '\n'.join(w for w in wrong if w)
