"""Damage planted into a finished build: opens what the program wrote, changes one thing, and seals it again.

`Damaged` is a copy of a build. Its changes leave hashes wrong until seal() writes them anew, so that what a change breaks
must be found by what it is, not by a hash.
"""
import gzip
import json
import os
import re
import shutil
import sqlite3
import struct

from blockrand_run import files_of, read_json, sha256


class Damaged:
    def __init__(self, source, folder):
        shutil.copytree(source, folder)
        self.folder = folder

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def read(self, name):
        with open(self.path(name), 'rb') as f:
            return f.read()

    def write(self, name, data):
        with open(self.path(name), 'wb') as f:
            f.write(data)

    def change(self, name, change):
        """Replaces a file's bytes by what `change` makes of them; it must make something else."""
        before = self.read(name)
        after = change(before)
        assert after != before, f'nothing changed in {name}'
        self.write(name, after)

    def json(self, name, change):
        document = json.loads(self.read(name))
        before = json.dumps(document)
        change(document)
        assert json.dumps(document) != before, f'nothing changed in {name}'
        self.write(name, json.dumps(document, indent=1).encode())

    def replace(self, name, old, new, count=1):
        self.change(name, lambda data: data.replace(old.encode(), new.encode(), count))

    def remove(self, name):
        os.remove(self.path(name))

    def seal(self):
        """Sizes, hashes and the list of files in build.json as they are now; sizes of tiles in the GeoPackage, too."""
        for name in files_of(self.folder, '.glb'):
            size = os.path.getsize(self.path(name))
            if name.startswith('tiles/') and size != read_json(self.folder, 'build.json')['files'][name]['bytes']:
                self.sql(f"UPDATE tiles SET bytes = {size} WHERE uri = '{name}'")
        build = read_json(self.folder, 'build.json')
        build['files'] = {name: {'bytes': os.path.getsize(self.path(name)), 'sha256': sha256(self.path(name))}
                          for name in files_of(self.folder) if name not in ('build.json', 'run.json')}
        with open(self.path('build.json'), 'w', encoding='utf-8') as f:
            json.dump(build, f, indent=1)

    # ---- what there is

    def largest(self, start, end):
        return max((n for n in files_of(self.folder, end) if n.startswith(start)), key=lambda n: os.path.getsize(self.path(n)))

    @property
    def gml(self):
        return self.largest('citygml', '.gml')

    @property
    def glb(self):
        return self.largest('tiles', '.glb')

    @property
    def cityjson(self):
        return self.largest('cityjson', '.jsonl')

    @property
    def explained(self):
        return self.largest('explain', '.jsonl.gz')

    # ---- CityGML

    def building(self, change, wanted=lambda text: True):
        """Changes the text of the first building that `wanted` accepts; returns its id."""
        data = self.read(self.gml).decode()
        for found in re.finditer(r'<core:cityObjectMember>.*?</core:cityObjectMember>', data, re.S):
            text = found.group()
            if 'consistsOfBuildingPart' in text or not wanted(text):
                continue
            changed = change(text)
            assert changed != text
            self.write(self.gml, (data[:found.start()] + changed + data[found.end():]).encode())
            return re.search(r'<bldg:Building gml:id="([^"]*)"', text).group(1)
        raise AssertionError('no such building')

    def ring(self, change, surface='RoofSurface', wanted=lambda text: True):
        """Changes the points of the first ring of a boundary surface."""
        def of(text):
            # The surface refers to its polygon, which stands in the solid.
            polygon = re.search(r'xlink:href="#([^"]*)"', text[text.index(f'<bldg:{surface}'):]).group(1)
            start = text.index('<posList>', text.index(f'<Polygon gml:id="{polygon}"')) + len('<posList>')
            end = text.index('</posList>', start)
            n = [float(v) for v in text[start:end].split()]
            points = change([n[i:i + 3] for i in range(0, len(n), 3)])
            return text[:start] + ' '.join(f'{v:.4f}' for p in points for v in p) + text[end:]
        return self.building(of, lambda text: f'<bldg:{surface}' in text and wanted(text))

    # ---- GLB

    def glb_parts(self, name=None):
        data = self.read(name or self.glb)
        length = struct.unpack_from('<I', data, 12)[0]
        document = json.loads(data[20:20 + length])
        return document, bytearray(data[28 + length:])

    def write_glb(self, document, binary, name=None):
        text = json.dumps(document, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        binary = bytes(binary) + b'\0' * (-len(binary) % 4)
        self.write(name or self.glb, struct.pack('<4sIIII', b'glTF', 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A)
                   + text + struct.pack('<II', len(binary), 0x004E4942) + binary)

    def change_glb(self, change):
        document, binary = self.glb_parts()
        before = json.dumps(document), bytes(binary)
        result = change(document, binary)
        assert (json.dumps(document), bytes(binary)) != before, 'nothing changed'
        self.write_glb(document, binary)
        return result

    # ---- GeoPackage

    def sql(self, *statements):
        """Runs statements with SQLite; triggers that call functions of other programs are put aside for the while."""
        db = sqlite3.connect(self.path('buildings.gpkg'))
        triggers = db.execute("SELECT name, sql FROM sqlite_master WHERE type = 'trigger'").fetchall()
        for name, _ in triggers:
            db.execute(f'DROP TRIGGER "{name}"')
        changed = 0
        for statement in statements:
            changed += db.execute(statement).rowcount
        for _, text in triggers:
            db.execute(text)
        db.commit()
        db.close()
        assert changed, 'nothing changed'

    # ---- explanations

    def explanations(self, change, name=None):
        name = name or self.explained
        lines = gzip.decompress(self.read(name)).decode().splitlines()
        records = [json.loads(line) for line in lines]
        records = change(records) or records
        data = ''.join(json.dumps(r, ensure_ascii=False, separators=(',', ':')) + '\n' for r in records).encode()
        assert data.decode().splitlines() != lines, 'nothing changed'
        self.write(name, gzip.compress(data, mtime=0))


def accessor(document, primitive, attribute):
    """(accessor, place of its first element, stride) of an attribute; `indices` are one, too."""
    index = primitive['indices'] if attribute == 'indices' else primitive['attributes'][attribute]
    a = document['accessors'][index]
    view = document['bufferViews'][a['bufferView']]
    size = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}[a['componentType']]
    width = {'SCALAR': 1, 'VEC3': 3, 'VEC4': 4}[a['type']]
    return a, view.get('byteOffset', 0) + a.get('byteOffset', 0), view.get('byteStride', size * width)


def primitive_of(document):
    return document['meshes'][0]['primitives'][0]


def index_format(document):
    return '<H' if accessor(document, primitive_of(document), 'indices')[0]['componentType'] == 5123 else '<I'


def table_of(document):
    return document['extensions']['EXT_structural_metadata']['propertyTables'][0]


def column_start(document, name, part='values'):
    return document['bufferViews'][table_of(document)['properties'][name][part]].get('byteOffset', 0)


def first_leaf(tileset):
    """The tile of the tileset whose content is the largest box."""
    leaves = []

    def walk(tile):
        if 'content' in tile:
            leaves.append(tile)
        for child in tile.get('children', []):
            walk(child)
    walk(tileset['root'])
    return max(leaves, key=lambda t: t['boundingVolume']['box'][3])
