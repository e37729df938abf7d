"""Readers of what a build wrote, in plain Python: enough of CityGML, GLB and 3D Tiles to ask where things stand."""
import ctypes
import ctypes.util
import gzip
import json
import os
import struct
import xml.etree.ElementTree as ElementTree

from blockrand_run import files_of, read_json

NAMES = {'gml': 'http://www.opengis.net/gml', 'core': 'http://www.opengis.net/citygml/2.0',
         'bldg': 'http://www.opengis.net/citygml/building/2.0', 'gen': 'http://www.opengis.net/citygml/generics/2.0'}
GML_ID = '{%s}id' % NAMES['gml']


# ---- CityGML

def citygml_trees(folder):
    """(relative path, root element) of every CityGML file."""
    for name in files_of(os.path.join(folder, 'citygml'), '.gml', '.gml.gz'):
        path = os.path.join(folder, 'citygml', name)
        with (gzip.open if name.endswith('.gz') else open)(path, 'rb') as f:
            yield name, ElementTree.parse(f).getroot()


def buildings(folder):
    """{gml:id: element} of every Building, parts left inside."""
    found = {}
    for _, root in citygml_trees(folder):
        for element in root.iterfind('core:cityObjectMember/bldg:Building', NAMES):
            found[element.get(GML_ID)] = element
    return found


def points(element):
    """Every (x, y, z) of the posLists below."""
    for pos in element.iterfind('.//gml:posList', NAMES):
        n = [float(t) for t in pos.text.split()]
        yield from zip(n[0::3], n[1::3], n[2::3])


def attributes(element):
    """{name: text} of the generic attributes of one building or part."""
    return {a.get('name'): a.findtext('gen:value', '', NAMES) for a in element if a.tag.startswith('{%s}' % NAMES['gen'])}


# ---- GLB

MESHOPT = 'EXT_meshopt_compression'


def unpack_views(glb, binary):
    """The binary chunk with the buffer views that meshopt packed unpacked behind it; `glb` names the new places. By the library
    that programs link."""
    library = None
    for view in glb.get('bufferViews', []):
        packed = view.get('extensions', {}).pop(MESHOPT, None)
        if packed is None:
            continue
        library = library or ctypes.CDLL(ctypes.util.find_library('meshoptimizer'))
        size, count, start = packed['byteStride'], packed['count'], packed.get('byteOffset', 0)
        source = binary[start:start + packed['byteLength']]
        target = ctypes.create_string_buffer(size * count)
        decode = {'ATTRIBUTES': library.meshopt_decodeVertexBuffer, 'TRIANGLES': library.meshopt_decodeIndexBuffer}[packed['mode']]
        arguments = (target, ctypes.c_size_t(count), ctypes.c_size_t(size), source, ctypes.c_size_t(len(source)))
        assert decode(*arguments) == 0, view
        filtered = packed.get('filter', 'NONE')
        if filtered != 'NONE':
            assert filtered == 'EXPONENTIAL', filtered
            library.meshopt_decodeFilterExp(*arguments[:3])
        binary += bytes(-len(binary) % 8)
        view.update(buffer=0, byteOffset=len(binary))
        binary += target.raw
    return binary


class Glb:
    """A GLB with its first property table."""
    FORMATS = {5120: ('b', 127), 5121: ('B', 255), 5122: ('h', 32767), 5123: ('H', 65535), 5125: ('I', 1), 5126: ('f', 1)}
    WIDTHS = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}
    OFFSETS = {'UINT8': 'B', 'UINT16': 'H', 'UINT32': 'I', 'UINT64': 'Q'}

    def __init__(self, path):
        with open(path, 'rb') as f:
            data = f.read()
        magic, version, length = struct.unpack_from('<4sII', data)
        assert (magic, version, length) == (b'glTF', 2, len(data)), path
        self.json, self.bin, at = None, b'', 12
        while at < len(data):
            size, kind = struct.unpack_from('<I4s', data, at)
            chunk = data[at + 8:at + 8 + size]
            if kind == b'JSON':
                self.json = json.loads(chunk)
            elif kind == b'BIN\0':
                self.bin = chunk
            at += 8 + size
        self.bin = unpack_views(self.json, self.bin)

    def accessor(self, index):
        a = self.json['accessors'][index]
        view = self.json['bufferViews'][a['bufferView']]
        code, scale = self.FORMATS[a['componentType']]
        width = self.WIDTHS[a['type']]
        stride = view.get('byteStride') or width * struct.calcsize(code)
        start = view.get('byteOffset', 0) + a.get('byteOffset', 0)
        values = [struct.unpack_from(f'<{width}{code}', self.bin, start + i * stride) for i in range(a['count'])]
        return [tuple(v / scale for v in value) for value in values] if a.get('normalized') else values

    def colours(self, primitive):
        """Linear (r, g, b) of its vertices: one for all where the material alone has a colour."""
        material = self.json['materials'][primitive['material']]
        factor = material.get('pbrMetallicRoughness', {}).get('baseColorFactor', (1, 1, 1, 1))
        own = primitive['attributes'].get('COLOR_0')
        values = self.accessor(own) if own is not None else [(1, 1, 1, 1)]
        return [tuple(a * b for a, b in zip(value[:3], factor)) for value in values]

    def texts(self, name):
        """A STRING column of the property table, or an ENUM of a byte."""
        table = self.json['extensions']['EXT_structural_metadata']['propertyTables'][0]
        column = table['properties'][name]
        if 'stringOffsets' not in column:
            schema = self.json['extensions']['EXT_structural_metadata']['schema']
            kind = schema['classes'][table['class']]['properties'][name]
            names = {v['value']: v['name'] for v in schema['enums'][kind['enumType']]['values']}
            start = self.json['bufferViews'][column['values']].get('byteOffset', 0)
            found = [names[v] for v in self.bin[start:start + table['count']]]
            return ['' if n == kind.get('noData') else n for n in found]
        values, offsets = (self.json['bufferViews'][column[k]] for k in ('values', 'stringOffsets'))
        code = self.OFFSETS[column.get('stringOffsetType', 'UINT32')]
        ends = struct.unpack_from(f'<{table["count"] + 1}{code}', self.bin, offsets.get('byteOffset', 0))
        start = values.get('byteOffset', 0)
        return [self.bin[start + a:start + b].decode('utf-8') for a, b in zip(ends, ends[1:])]

    def columns(self):
        """Names of the columns of the property table, in the order of the file."""
        return self.json['extensions']['EXT_structural_metadata']['propertyTables'][0]['properties']

    def numbers(self, name):
        """A column of FLOAT64 of the property table."""
        table = self.json['extensions']['EXT_structural_metadata']['propertyTables'][0]
        view = self.json['bufferViews'][table['properties'][name]['values']]
        return struct.unpack_from(f'<{table["count"]}d', self.bin, view.get('byteOffset', 0))

    def placed_meshes(self):
        """(node, where its origin lies, the mesh) of every node with a mesh, from the scene's roots down. Nodes that turn or
        scale are none of those that are asked for here."""
        waiting = [(number, (0, 0, 0)) for number in reversed(self.json.get('scenes', [{'nodes': []}])[0]['nodes'])]
        while waiting:
            number, parent = waiting.pop()
            node = self.json['nodes'][number]
            assert 'rotation' not in node and 'scale' not in node and 'matrix' not in node, node
            origin = tuple(a + b for a, b in zip(parent, node.get('translation', (0, 0, 0))))
            if 'mesh' in node:
                yield node, origin, self.json['meshes'][node['mesh']]
            waiting += [(child, origin) for child in reversed(node.get('children', []))]

    def vertices(self):
        """(row of the property table, (x, y, z)) of every vertex, in the file's frame with z up."""
        for node, origin, mesh in self.placed_meshes():
            for primitive in mesh['primitives']:
                places = self.accessor(primitive['attributes']['POSITION'])
                own = primitive['attributes'].get('_FEATURE_ID_0')
                rows = self.accessor(own) if own is not None else [(node['extras']['feature'],)] * len(places)
                for (row,), p in zip(rows, places):
                    x, y, z = (c + o for c, o in zip(p, origin))
                    yield int(row), (x, -z, y)


def tile_contents(folder):
    """(column-major transform, path of the content) of every tile of tileset.json."""
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]

    def walk(tile, matrix):
        own = tile.get('transform', identity)
        matrix = [sum(matrix[k * 4 + r] * own[c * 4 + k] for k in range(4)) for c in range(4) for r in range(4)]
        if 'content' in tile:
            yield matrix, os.path.join(folder, tile['content']['uri'])
        for child in tile.get('children', []):
            yield from walk(child, matrix)
    return list(walk(read_json(folder, 'tileset.json')['root'], identity))


def placed(matrix, p):
    return tuple(matrix[r] * p[0] + matrix[4 + r] * p[1] + matrix[8 + r] * p[2] + matrix[12 + r] for r in range(3))
