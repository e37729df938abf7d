"""Small OSM files for the tests: objects, XML and PBF written by hand, extracts converted and shuffled.

PBF is written here without any library, so that strings can hold what no editor would let through.
"""
import random
import struct
import xml.etree.ElementTree as ElementTree
import zlib
from xml.sax.saxutils import quoteattr


STAMP, STAMP_SECONDS = '2024-05-01T00:00:00Z', 1714521600  # of every object


class Node:
    def __init__(self, id, lon, lat, tags=None, version=1):
        self.id, self.lon, self.lat, self.tags, self.version = id, lon, lat, tags or {}, version


class Way:
    def __init__(self, id, refs, tags=None, version=1):
        self.id, self.refs, self.tags, self.version = id, list(refs), tags or {}, version


class Relation:
    def __init__(self, id, members, tags=None, version=1):
        """members: (kind, id, role) with kind node, way or relation"""
        self.id, self.members, self.tags, self.version = id, list(members), tags or {}, version


METRE = 1 / 111300.0  # degrees of latitude


def ring(first_id, way_id, points, tags):
    """A closed way over new nodes at (lon, lat) points."""
    nodes = [Node(first_id + i, lon, lat) for i, (lon, lat) in enumerate(points)]
    refs = [n.id for n in nodes]
    return nodes + [Way(way_id, refs + refs[:1], tags)]


def house(number, lon, lat, tags=None, size=12.0, stretch=1.0):
    """A square house of `size` m with its south-west corner at lon, lat; `stretch`: 1 / cos(latitude)."""
    d, e = size * METRE, size * METRE * stretch
    corners = [(lon, lat), (lon + e, lat), (lon + e, lat + d), (lon, lat + d)]
    return ring(100000 + 10 * number, 1000 + number, corners, {'building': 'yes', **(tags or {})})


def town(count, lon=11.0, lat=51.5):
    """`count` houses in rows, large enough to give a run a middle."""
    objects = []
    for i in range(count):
        objects += house(i, lon + (i % 100) * 30 * METRE, lat + (i // 100) * 30 * METRE,
                         {'roof:shape': ('gabled', 'hipped', 'flat')[i % 3], 'building:levels': str(2 + i % 4)},
                         stretch=1.6)
    return objects


# ---- XML

def write_xml(path, objects, head='<osm version="0.6" generator="blockrand tests">'):
    out = ["<?xml version='1.0' encoding='UTF-8'?>", head]
    for o in objects:
        common = f'id="{o.id}" version="{o.version}" timestamp="{STAMP}"'
        tags = [f'<tag k={quoteattr(k)} v={quoteattr(v)}/>' for k, v in o.tags.items()]
        if isinstance(o, Node):
            out.append(f'<node {common} lat="{o.lat:.7f}" lon="{o.lon:.7f}">' + ''.join(tags) + '</node>')
        elif isinstance(o, Way):
            out.append(f'<way {common}>' + ''.join(f'<nd ref="{r}"/>' for r in o.refs) + ''.join(tags) + '</way>')
        else:
            members = [f'<member type="{k}" ref="{i}" role={quoteattr(r)}/>' for k, i, r in o.members]
            out.append(f'<relation {common}>' + ''.join(members + tags) + '</relation>')
    with open(path, 'w', encoding='utf-8') as f:
        f.write('\n'.join(out + ['</osm>', '']))
    return path


def read_xml(path):
    """The objects of an .osm file in its order."""
    objects = []
    for e in ElementTree.parse(path).getroot():
        tags = {t.get('k'): t.get('v') for t in e.iter('tag')}
        number, version = int(e.get('id', 0)), int(e.get('version', 1))
        if e.tag == 'node':
            objects.append(Node(number, float(e.get('lon')), float(e.get('lat')), tags, version))
        elif e.tag == 'way':
            objects.append(Way(number, [int(n.get('ref')) for n in e.iter('nd')], tags, version))
        elif e.tag == 'relation':
            members = [(m.get('type'), int(m.get('ref')), m.get('role')) for m in e.iter('member')]
            objects.append(Relation(number, members, tags, version))
    return objects


def shuffle_xml(source, target, seed=7):
    """The same elements in random order: relations before ways before nodes, and all between."""
    tree = ElementTree.parse(source)
    root = tree.getroot()
    head = [e for e in root if e.tag not in ('node', 'way', 'relation')]
    rest = [e for e in root if e.tag in ('node', 'way', 'relation')]
    random.Random(seed).shuffle(rest)
    root[:] = head + rest
    tree.write(target, encoding='UTF-8', xml_declaration=True)
    return target


# ---- PBF (https://wiki.openstreetmap.org/wiki/PBF_Format)

def varint(n):
    n &= (1 << 64) - 1
    out = bytearray()
    while n > 127:
        out.append(n & 127 | 128)
        n >>= 7
    out.append(n)
    return bytes(out)


def zigzag(n):
    return varint((n << 1) ^ (n >> 63))


def number_field(field, n):
    return varint(field << 3) + varint(n)


def bytes_field(field, data):
    return varint(field << 3 | 2) + varint(len(data)) + data


def packed(field, values):
    return bytes_field(field, b''.join(values)) if values else b''


def deltas(values):
    return [zigzag(b - a) for a, b in zip([0, *values], values)]


def blob(kind, content, compress=True):
    body = (number_field(2, len(content)) + bytes_field(3, zlib.compress(content))) if compress else bytes_field(1, content)
    head = bytes_field(1, kind) + number_field(3, len(body))
    return struct.pack('>I', len(head)) + head + body


def primitive_block(objects):
    table = {b'': 0}

    def text(s):
        data = s if isinstance(s, bytes) else s.encode('utf-8')
        return varint(table.setdefault(data, len(table)))

    groups = []
    for o in objects:
        tags = packed(2, [text(k) for k in o.tags]) + packed(3, [text(v) for v in o.tags.values()])
        info = bytes_field(4, number_field(1, o.version) + number_field(2, STAMP_SECONDS))
        if isinstance(o, Node):
            lat, lon = (zigzag(round(v * 1e7)) for v in (o.lat, o.lon))
            body = varint(1 << 3) + zigzag(o.id) + tags + info + varint(8 << 3) + lat + varint(9 << 3) + lon
            groups.append(bytes_field(1, body))
        elif isinstance(o, Way):
            groups.append(bytes_field(3, number_field(1, o.id) + tags + info + packed(8, deltas(o.refs))))
        else:
            kinds = [varint(('node', 'way', 'relation').index(k)) for k, _, _ in o.members]
            body = (packed(8, [text(r) for _, _, r in o.members]) + packed(9, deltas([i for _, i, _ in o.members]))
                    + packed(10, kinds))
            groups.append(bytes_field(4, number_field(1, o.id) + tags + info + body))
    strings = b''.join(bytes_field(1, s) for s in table)
    return bytes_field(1, strings) + b''.join(bytes_field(2, g) for g in groups)


def pbf_bytes(objects, block_size=4000):
    """[header, block, block …]: the places between them are the only ones where a cut is no damage."""
    header = bytes_field(4, b'OsmSchema-V0.6') + bytes_field(16, b'blockrand tests')
    out = [blob(b'OSMHeader', header)]
    for i in range(0, len(objects), block_size):
        out.append(blob(b'OSMData', primitive_block(objects[i:i + block_size])))
    return out


def write_pbf(path, objects):
    with open(path, 'wb') as f:
        f.write(b''.join(pbf_bytes(objects)))
    return path
