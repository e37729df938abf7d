"""Surveyed buildings as OSM: the input from which a build should come out like the survey, and ways to spoil it.

After docs/sources.md, Other programs 4.6: ground surfaces become ways and multipolygons, height = ridge - ground, roof:height =
ridge - eaves, levels from the eaves, roof:shape from the form of the roof. Outlines and the directions of roofs are read
here, from the files themselves; heights, forms and volumes come from `blockrand compare REFERENCE REFERENCE`.
"""
import collections
import copy
import json
import math
import os
import xml.etree.ElementTree as ElementTree

from osm_files import Node, Relation, Way, write_xml

STOREY = 3.2  # m
SHAPES = {'flat': 'flat', 'gabled': 'gabled', 'hipped': 'hipped', 'shed': 'skillion'}


class House:
    """One reference building. Rings in the reference's CRS, the outer one counter-clockwise, holes clockwise."""

    def __init__(self, id, outer, holes, height, roof_height, shape, direction):
        self.id, self.outer, self.holes = id, outer, holes
        self.height, self.roof_height = height, roof_height  # m
        self.levels = max(1, round((height - roof_height) / STOREY))
        self.shape, self.direction = shape, direction  # roof:shape; degrees from north clockwise, or None

    def tags(self):
        tags = {'building': 'yes', 'height': f'{self.height:.3f}', 'building:levels': str(self.levels),
                'roof:shape': self.shape}
        if self.shape != 'flat':
            tags['roof:height'] = f'{self.roof_height:.3f}'
            if self.direction is not None:
                tags['roof:direction'] = f'{self.direction:.1f}'
        return tags


# ---- files of reference models

def local(element):
    return element.tag.rpartition('}')[2]


def descendants(element, *names):
    return [e for e in element.iter() if isinstance(e.tag, str) and local(e) in names]


def numbers(text):
    return [float(t) for t in text.split()]


def ring_points(ring):
    """(x, y, z) of a LinearRing without its closing point."""
    flat = [n for e in descendants(ring, 'posList', 'pos') for n in numbers(e.text)]
    points = list(zip(flat[0::3], flat[1::3], flat[2::3]))
    return points[:-1] if points and points[0] == points[-1] else points


def citygml_surfaces(path):
    """{building: {class: [polygon: [ring: [(x, y, z)]]]}} of boundary surfaces."""
    found = {}
    for building in descendants(ElementTree.parse(path).getroot(), 'Building'):
        id = next((v for k, v in building.attrib.items() if k.endswith('}id')), None)
        surfaces = found.setdefault(id, collections.defaultdict(list))
        for surface in descendants(building, 'GroundSurface', 'RoofSurface'):
            for polygon in descendants(surface, 'Polygon'):
                surfaces[local(surface)].append([ring_points(r) for r in descendants(polygon, 'LinearRing')])
    return found


def cityjson_surfaces(path):
    """Likewise, parts with their building. Solids with semantics only."""
    with open(path, encoding='utf-8') as f:
        city = json.load(f)
    scale, move = city['transform']['scale'], city['transform']['translate']
    vertices = [tuple(round(v * s + m, 6) for v, s, m in zip(vertex, scale, move)) for vertex in city['vertices']]
    found = {}
    for id, thing in city['CityObjects'].items():
        if thing['type'] not in ('Building', 'BuildingPart'):
            continue
        surfaces = found.setdefault(thing.get('parents', [id])[0], collections.defaultdict(list))
        for geometry in thing.get('geometry', []):
            if geometry['type'] != 'Solid' or 'semantics' not in geometry:
                continue
            classes = geometry['semantics']['surfaces']
            for shell, values in zip(geometry['boundaries'], geometry['semantics']['values']):
                for polygon, value in zip(shell, values):
                    if value is not None:
                        surfaces[classes[value]['type']].append([[vertices[i] for i in ring] for ring in polygon])
    return found


# ---- outlines

def area(ring):
    """Signed: positive where counter-clockwise. Taken from the first point, since coordinates are large."""
    x0, y0 = ring[0][:2]
    return sum((a[0] - x0) * (b[1] - y0) - (b[0] - x0) * (a[1] - y0) for a, b in zip(ring, ring[1:] + ring[:1])) / 2


def outline(polygons, snap=0.002):
    """Rings around polygons that lie side by side: edges that two of them share go. Corners that lie on another's
    edge are put into it first. Exact for a partition of the plan; what overlaps gives rings that the caller must check
    by their area."""
    rings = []
    for polygon in polygons:
        for i, ring in enumerate(polygon):
            ring = [(round(p[0] / snap), round(p[1] / snap)) for p in ring]
            ring = [p for p, q in zip(ring, ring[1:] + ring[:1]) if p != q]
            if len(ring) > 2 and area(ring) != 0:
                rings.append(ring if (area(ring) > 0) == (i == 0) else ring[::-1])
    corners = sorted({p for ring in rings for p in ring})
    edges = collections.Counter()
    for ring in rings:
        for a, b in zip(ring, ring[1:] + ring[:1]):
            dx, dy = b[0] - a[0], b[1] - a[1]
            length = math.hypot(dx, dy)
            on = []
            for p in corners:
                along = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length
                across = abs((p[0] - a[0]) * dy - (p[1] - a[1]) * dx) / length
                if 1 < along < length - 1 and across < 2 and p != a and p != b:
                    on.append((along, p))
            way = [a] + [p for _, p in sorted(on)] + [b]
            for edge in zip(way, way[1:]):
                if edges[edge[::-1]] > 0:
                    edges[edge[::-1]] -= 1
                else:
                    edges[edge] += 1
    outgoing = collections.defaultdict(list)
    for (a, b), n in edges.items():
        outgoing[a] += [b] * n
    found = []
    for start in sorted(outgoing):
        while outgoing[start]:
            ring, here = [start], outgoing[start].pop()
            while here != start:
                ring.append(here)
                if not outgoing[here]:
                    return []
                before = ring[-2]
                turn = lambda to: (math.atan2(to[1] - here[1], to[0] - here[0])
                                   - math.atan2(before[1] - here[1], before[0] - here[0])) % (2 * math.pi)
                following = max(outgoing[here], key=turn)  # the sharpest left: rings that touch in a corner stay two
                outgoing[here].remove(following)
                here = following
            if len(ring) > 2 and area(ring) != 0:
                found.append([(x * snap, y * snap) for x, y in ring])
    return found


def slope_direction(polygons):
    """Azimuth in degrees to which the largest sloped roof polygon falls, or None."""
    best, direction = 0, None
    for polygon in polygons:
        ring = polygon[0]
        o = ring[0]
        n = [0, 0, 0]
        for a, b in zip(ring, ring[1:] + ring[:1]):
            a, b = [a[i] - o[i] for i in range(3)], [b[i] - o[i] for i in range(3)]
            n = [n[0] + a[1] * b[2] - a[2] * b[1], n[1] + a[2] * b[0] - a[0] * b[2], n[2] + a[0] * b[1] - a[1] * b[0]]
        if n[2] < 0:
            n = [-c for c in n]
        flat = math.hypot(n[0], n[1])
        if flat > 0.05 * n[2] and n[2] > best:
            best, direction = n[2], math.degrees(math.atan2(n[0], n[1])) % 360
    return direction


def houses_of(files, comparison):
    """Houses of those reference buildings that one outline with one roof describes, so that a build of them is faithful:
    one outer ring whose area is the footprint's, a simple form of the roof, and a volume as that form has (flat:
    area x height; gable and shed: half of the roof's box, hipped: between a third and a half of it).

    comparison: the compare.json of the files against themselves. Returns (houses, {reason: buildings left out}).
    """
    surfaces = {}
    for path in files:
        surfaces.update((cityjson_surfaces if path.endswith('.json') else citygml_surfaces)(path))
    houses, left = [], collections.Counter()
    for match in comparison['matches']:
        facts = match['reference']
        id, form = facts['buildings'][0], facts['roof_form']
        if len(facts['buildings']) > 1:
            left['shares its place'] += 1
            continue
        if form not in SHAPES:
            left[f'roof: {form}'] += 1
            continue
        rings = outline(surfaces.get(id, {}).get('GroundSurface', []))
        outer = [r for r in rings if area(r) > 0]
        holes = [r for r in rings if area(r) < 0]
        if len(outer) != 1 or abs(sum(map(area, rings)) / facts['footprint_area'] - 1) > 0.002:
            left['outline in pieces or overlapping'] += 1
            continue
        if facts['volume'] is None or facts['footprint_area'] < 20:
            left['no volume or a shed'] += 1
            continue
        eaves, ridge = facts['eaves'], facts['ridge']
        share = {'flat': (0, 0), 'hipped': (1 / 3, 1 / 2)}.get(SHAPES[form], (1 / 2, 1 / 2))
        low, high = (facts['footprint_area'] * (eaves + s * (ridge - eaves)) for s in share)
        if form == 'flat':
            low = high = facts['footprint_area'] * ridge
        if not 0.97 * low < facts['volume'] < 1.03 * high:
            left['several heights'] += 1
            continue
        roof = 0 if form == 'flat' else ridge - eaves
        direction = None if form in ('flat', 'hipped') else slope_direction(surfaces[id]['RoofSurface'])
        houses.append(House(id, outer[0], holes, ridge, roof, SHAPES[form], direction))
    return houses, dict(left)


# ---- OSM

def write_houses(path, houses, to_degrees):
    """An .osm file; to_degrees: (x, y) to (lon, lat). Ways where there is no courtyard, else multipolygons."""
    objects, places = [], {}
    things = []

    def way(id, ring, tags):
        refs = []
        for x, y in ring:
            key = (round(x, 2), round(y, 2))  # neighbours share nodes, as mappers draw them
            if key not in places:
                places[key] = len(places) + 1
                objects.append(Node(places[key], *to_degrees(x, y)[:2]))
            if not refs or refs[-1] != places[key]:
                refs.append(places[key])
        things.append(Way(id, refs + refs[:1] if refs[0] != refs[-1] else refs, tags))

    for i, house in enumerate(houses):
        number = 1000 * (i + 1)
        way(number, house.outer, {} if house.holes else house.tags())
        for k, hole in enumerate(house.holes):
            way(number + 1 + k, hole, {})
        if house.holes:
            members = [('way', number, 'outer')] + [('way', number + 1 + k, 'inner') for k in range(len(house.holes))]
            things.append(Relation(number, members, {'type': 'multipolygon', **house.tags()}))
    things.sort(key=lambda t: isinstance(t, Relation))
    return write_xml(path, objects + things)


# ---- degradations of a list of houses

def changed(houses, change):
    out = copy.deepcopy(houses)
    for house in out:
        change(house)
    return out


def one_storey_more(houses):
    def change(h):
        h.height, h.levels = h.height + STOREY, h.levels + 1
    return changed(houses, change)


def flat_roofs(houses):
    def change(h):
        h.shape = 'flat'
    return changed(houses, change)


def moved_east(houses, metres=1.0):
    def change(h):
        h.outer, *h.holes = [[(x + metres, y) for x, y in r] for r in [h.outer, *h.holes]]
    return changed(houses, change)


def without_courtyards(houses):
    def change(h):
        h.holes = []
    return changed(houses, change)


def mirrored(houses):
    """Each about the north-south line through the middle of its own bounding box."""
    def change(h):
        double_middle = min(x for x, _ in h.outer) + max(x for x, _ in h.outer)
        h.outer, *h.holes = [[(double_middle - x, y) for x, y in reversed(r)] for r in [h.outer, *h.holes]]
        if h.direction is not None:
            h.direction = -h.direction % 360
    return changed(houses, change)


# ---- a hand-built model with its windows doubled

def double_windows(source, target):
    """A copy of a CityGML file in which beside every window stands a second one, moved along the wall by half the
    window's width: far enough that the two are no match (IoU 1/3), near enough that the second is still on the wall.
    Returns the number of windows doubled."""
    with open(source, 'rb') as f:
        for event, (prefix, uri) in ElementTree.iterparse(f, events=('start-ns',)):
            ElementTree.register_namespace(prefix, uri) if not prefix.startswith('ns') else None
    tree = ElementTree.parse(source)
    doubled = 0
    for wall in list(tree.getroot().iter()):
        for opening in [e for e in wall if isinstance(e.tag, str) and local(e) == 'opening']:
            if not descendants(opening, 'Window'):
                continue
            points = [p for ring in descendants(opening, 'LinearRing') for p in ring_points(ring)]
            if not points:
                continue
            # Along the wall: the plan's direction in which the window is widest.
            a, b = max(((p, q) for p in points for q in points), key=lambda pq: math.dist(pq[0][:2], pq[1][:2]))
            second = copy.deepcopy(opening)
            for e in second.iter():
                for name in e.attrib:
                    if name.endswith('}id'):
                        e.attrib[name] += '_second'
                if isinstance(e.tag, str) and local(e) in ('posList', 'pos'):
                    n = numbers(e.text)
                    n[0::3] = [x + (b[0] - a[0]) / 2 for x in n[0::3]]
                    n[1::3] = [y + (b[1] - a[1]) / 2 for y in n[1::3]]
                    e.text = ' '.join(f'{c:.6f}' for c in n)
            wall.append(second)
            doubled += 1
    tree.write(target, encoding='UTF-8', xml_declaration=True)
    return doubled
