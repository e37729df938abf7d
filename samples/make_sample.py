#!/usr/bin/env python3
"""Write blockrand-viertel.osm: an invented quarter, mapped the way OSM mappers map.

Usage:  python3 make_sample.py [output.osm]      (default: blockrand-viertel.osm beside this file)

Nothing here comes from OpenStreetMap or from any other map; the place is an open field.
Everything is laid out in metres in a local frame: x runs along the long streets, y across
them.  The frame is turned 17 degrees clockwise, so local +y has the compass bearing 17 and
local +x the bearing 107.  The output is byte-identical on every run.

    y                 railway
   280  ------------- Am Bahndamm -----------------
        |   park    |  school    |   factory      |
   180  ------------- Kastanienzeile --------------
        |   G3      |    G4      | church, market |        G1-G4: Gruenderzeit blocks
    91  ============= Grosse Salzhaendlerstrasse ===       (Blockrandbebauung)
        |   G1      |    G2      |   tenements    |
    -8  ------------- Kupferhammerstrasse ---------
        |   houses  |  slab estate (Zeilenbau)    |
  -118  ------------- Haferkampweg ----------------
       x=-8        108          214              340
"""
import math
import os
import sys
from xml.sax.saxutils import quoteattr

LON0, LAT0, TURN = 11.0300, 51.4700, 17.0
STAMP = '2024-05-01T00:00:00Z'
SIN, COS = math.sin(math.radians(TURN)), math.cos(math.radians(TURN))
M_PER_LAT, M_PER_LON = 111258.0, 69486.0                 # metres per degree at 51.47 N


def tags(text, **more):
    """'a=b;c=d' -> {'a': 'b', 'c': 'd'}"""
    return {**dict(item.split('=', 1) for item in text.split(';') if item), **more}


def bearing(dx, dy):
    """Compass bearing, in whole degrees, of a local direction."""
    return str(round(math.degrees(math.atan2(dx, dy)) + TURN) % 360)


class Dice:
    """A small generator of our own, so no Python release can change the output."""
    state = 1887

    def roll(self, n):
        self.state = (self.state * 1103515245 + 12345) % 2**31
        return (self.state >> 12) % n

    def pick(self, *options):
        return options[self.roll(len(options))]


class Osm:
    """The objects of the file.  A node asked for twice at one place is one shared node."""

    def __init__(self):
        self.nodes, self.ways, self.relations = {}, {}, {}
        self.cells, self.joined, self.addresses = {}, set(), []

    def node(self, p, t=None, fixed_id=None):
        cx, cy = round(p[0] * 100), round(p[1] * 100)
        if not fixed_id:
            for key in ((cx + i, cy + j) for i in (0, -1, 1) for j in (0, -1, 1)):
                if key in self.cells:
                    self.nodes[self.cells[key]][1].update(t or {})
                    return self.cells[key]
        new = fixed_id or 10001 + len(self.cells)
        self.nodes[new] = (p, dict(t or {}))
        self.cells.setdefault((cx, cy), new)
        return new

    def way(self, points, t, closed=False, join=False, fixed_id=None):
        refs = [p if isinstance(p, int) else self.node(p) for p in points]
        new = fixed_id or 1001 + sum(1 for w in self.ways if w < 9000)
        self.ways[new] = (refs + refs[:1] if closed else refs, dict(t))
        if join:
            self.joined.add(new)
        return new

    def building(self, ring, t, addr=None):
        """A closed way that shares nodes with whatever touches it; addr: (street, parity, key)."""
        new = self.way(ring, t, closed=True, join=True)
        if addr:
            self.addresses.append((*addr, new))
        return new

    def relation(self, members, t, fixed_id=None):
        new = fixed_id or 101 + sum(1 for r in self.relations if r < 900)
        self.relations[new] = (members, dict(t))
        return new

    def join_touching(self):
        """Where a node lies on an edge of a joined way, make it a vertex of that way too."""
        used = {r for w in self.joined for r in self.ways[w][0]}
        used |= {n for n, (_, t) in self.nodes.items() if 'entrance' in t}
        for w in sorted(self.joined):
            refs, out = self.ways[w][0], []
            for a, b in zip(refs, refs[1:]):
                (ax, ay), (bx, by) = self.nodes[a][0], self.nodes[b][0]
                length, hits = math.hypot(bx - ax, by - ay), []
                ux, uy = (bx - ax) / length, (by - ay) / length
                for n in used - {a, b}:
                    dx, dy = self.nodes[n][0][0] - ax, self.nodes[n][0][1] - ay
                    if abs(dx * uy - dy * ux) < 0.02 and 0.05 < dx * ux + dy * uy < length - 0.05:
                        hits.append((dx * ux + dy * uy, n))
                out += [a] + [n for _, n in sorted(hits)]
            self.ways[w] = (out + refs[-1:], self.ways[w][1])

    def number_houses(self):
        """Odd numbers on one side of each street, even on the other, along the street."""
        count = {}
        for street, parity, _, w in sorted(self.addresses):
            number = count.get((street, parity), parity)
            count[street, parity] = number + 2
            if w % 9 != 4:                               # a few houses have no address, as in life
                self.ways[w][1].update({'addr:street': street, 'addr:housenumber': str(number),
                                        'addr:postcode': '00999', 'addr:city': 'Blockrand'})

    def write(self, path):
        def place(p):
            return (LON0 + (p[0] * COS + p[1] * SIN) / M_PER_LON,
                    LAT0 + (p[1] * COS - p[0] * SIN) / M_PER_LAT)

        def element(kind, i, extra, children, t):
            head = f'  <{kind} id="{i}" version="1" timestamp="{STAMP}"{extra}'
            body = children + [f'    <tag k={quoteattr(k)} v={quoteattr(v)}/>' for k, v in sorted(t.items())]
            return [head + '>', *body, f'  </{kind}>'] if body else [head + '/>']

        at = {n: place(p) for n, (p, _) in self.nodes.items()}
        low, high = [[f'{f(c[k] for c in at.values()):.7f}' for k in (0, 1)] for f in (min, max)]
        out = ["<?xml version='1.0' encoding='UTF-8'?>", '<osm version="0.6" generator="make_sample.py">',
               f'  <bounds minlon="{low[0]}" minlat="{low[1]}" maxlon="{high[0]}" maxlat="{high[1]}"/>']
        for n in sorted(self.nodes):
            out += element('node', n, f' lat="{at[n][1]:.7f}" lon="{at[n][0]:.7f}"', [], self.nodes[n][1])
        for w, (refs, t) in sorted(self.ways.items()):
            out += element('way', w, '', [f'    <nd ref="{r}"/>' for r in refs], t)
        for r, (members, t) in sorted(self.relations.items()):
            out += element('relation', r, '', [f'    <member type="{k}" ref="{i}" role="{role}"/>'
                                               for k, i, role in members], t)
        with open(path, 'w', encoding='utf-8', newline='\n') as f:
            f.write('\n'.join(out + ['</osm>', '']))


def box(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def turned(cx, cy, w, h, deg):
    """A w by h rectangle around (cx, cy), turned counter-clockwise."""
    s, c = math.sin(math.radians(deg)), math.cos(math.radians(deg))
    return [(cx + x * c - y * s, cy + x * s + y * c) for x, y in box(-w / 2, -h / 2, w / 2, h / 2)]


def ellipse(cx, cy, rx, ry, n, start=0.0):
    return [(cx + rx * math.cos(start + 2 * math.pi * i / n), cy + ry * math.sin(start + 2 * math.pi * i / n))
            for i in range(n)]


m, dice = Osm(), Dice()

# ------------------------------------------------------------------------------ streets
WEST, MILL, BELL, EAST = 'Ziegelscheunenweg', 'Tuchwalkerstraße', 'Glockengießerstraße', 'Ostwall'
OATS, COPPER, SALT = 'Haferkampweg', 'Kupferhammerstraße', 'Große Salzhändlerstraße'
CHESTNUT, RAILSIDE, LARK = 'Kastanienzeile', 'Am Bahndamm', 'Lerchenwinkel'


def on_west(y):                                          # the western street runs askew
    return (-8 + 0.075 * y, y)


def on_north(x):                                         # and so does Kastanienzeile
    return (x, 179.4 + 0.046 * x)


def street(points, name, kind='residential', more=''):
    return m.way(points, tags(f'highway={kind};{more}', **({'name': name} if name else {})), join=True)


WEST_NORTH = on_west(179.032 / 0.99655)
LONG_X = (108, 214, 340)
street([on_west(y) for y in (-118, -63, -8, 91)] + [WEST_NORTH, on_west(278)], WEST, more='maxspeed=30')
street([(108, y) for y in (-118, -8, 91)] + [on_north(108), (108, 278)], MILL, more='maxspeed=30;surface=sett')
street([(214, -8), (214, 91)], BELL)
street([(214, 91), on_north(214)], 'Glockengießergasse', 'pedestrian', 'surface=paving_stones')
street([on_north(214), (214, 278)], BELL)
street([(340, y) for y in (-118, -8, 91)] + [on_north(340), (340, 278)], EAST, more='maxspeed=50')
street([on_west(-118), (108, -118), (340, -118)], OATS)
street([on_west(-8)] + [(x, -8) for x in LONG_X], COPPER, more='lit=yes')
street([(-90, 91), on_west(91)] + [(x, 91) for x in LONG_X] + [(420, 97)], SALT, 'secondary',
       'ref=L 999;lanes=2;maxspeed=50')
street([WEST_NORTH] + [on_north(x) for x in LONG_X], CHESTNUT, more='oneway=yes')
street([on_west(278)] + [(x, 278) for x in LONG_X], RAILSIDE)
street([on_west(-63), (40, -64), (88, -61)], LARK, 'living_street')
m.node((88, -61), tags('highway=turning_circle'))
for x, kind in ((108, 'traffic_signals'), (340, 'traffic_signals')):
    m.node((x, 91), tags(f'highway={kind}'))
m.node((214, 91), tags('highway=crossing;crossing=marked'))
for k, y in enumerate((292, 296.5)):
    m.way([(-100, y - 6), (40, y), (230, y), (430, y + 3)],
          tags(f'railway=rail;gauge=1435;electrified=contact_line;usage=main;railway:track_ref={k + 1}'))

# --------------------------------------------------------------- Gruenderzeit perimeter blocks
# One of these is dealt to two of every three houses in a row: tags in the many forms found in the wild.
EXTRAS = iter("""height=18|height=18 m|height=59'|height=62'4"|height=19.5;roof:height=4.5
roof:colour=#a33;building:colour=#e8dcc0|roof:colour=DarkRed;roof:material=roof_tiles
building:material=brick;roof:shape=gabled;roof:orientation=across|building:colour=#CDBA96;roof:angle=45
roof:material=slate;roof:colour=grey|roof:shape=mansard;roof:levels=2;roof:height=6|start_date=1898
roof:shape=gabled;roof:angle=48;roof:orientation=along|building:material=plaster;building:colour=LightYellow
roof:shape=skillion;start_date=~1905|roof:shape=flat;building:levels=6;start_date=1962;roof:material=tar_paper
building:facade:colour=#d8c8a0;roof:levels=1|roof:shape=gambrel;roof:levels=1|start_date=C19;heritage=4
roof:colour=#803020;roof:material=roof_tiles|building:colour=rosybrown;roof:shape=mansard
height=21 m;min_height=0|building:material=sandstone|roof:shape=gabled;roof:orientation=across;roof:height=5 m
roof:material=metal;roof:colour=#6d7f78;roof:shape=round|est_height=17""".replace('\n', '|').split('|'))
SHOPS = iter("""shop=bakery;name=Bäckerei Krume|shop=hairdresser;name=Schnittmuster|shop=kiosk
amenity=cafe;name=Café Hinterhof|shop=bicycle;name=Radspeicher|amenity=pub;name=Zum krummen Maß|shop=books
amenity=pharmacy;name=Salz-Apotheke|shop=convenience|shop=tailor|amenity=restaurant;name=Treppenhaus
shop=florist;name=Blumen Wicke|shop=shoes|shop=antiques|amenity=bar;name=Souterrain|shop=butcher
shop=optician|shop=laundry;name=Waschküche""".replace('\n', '|').split('|'))
row_houses = 0


def front_tags(corner):
    global row_houses
    t = tags('building=' + dice.pick('apartments', 'apartments', 'residential', 'yes'))
    if dice.roll(12):
        t['building:levels'] = dice.pick('4', '4', '5', '5', '5')
    if dice.roll(4):
        t['roof:shape'] = dice.pick('hipped', 'mansard', 'half-hipped') if corner else \
            dice.pick('gabled', 'gabled', 'gabled', 'mansard', 'mansard', 'flat')
        if dice.roll(2) and t['roof:shape'] != 'flat':
            t['roof:levels'] = '1'
    if not dice.roll(6):
        t['start_date'] = str(1874 + dice.roll(36))
    row_houses += not corner
    if not corner and row_houses % 3:
        t.update(tags(next(EXTRAS, '')))
    return t


def perimeter(quad, streets, rear, chamfers, legs=17.0, gap=None):
    """Houses wall to wall round a quadrilateral block.

    quad: street-side corners SW SE NE NW.  streets: per side (name, parity, half street width).
    rear: {(side, index): letters}: l, r side wing (Seitenfluegel) at the left or right party wall,
    h rear house (Hinterhaus) closing the court, p carriage passage (building_passage).
    chamfers: cut of each corner in metres.  gap: the (side, index) of an empty lot (Bauluecke).
    """
    frames = []                                          # per side: (distance along, distance inward) -> point
    for k in range(4):
        (ax, ay), (bx, by) = quad[k], quad[(k + 1) % 4]
        n = math.hypot(bx - ax, by - ay)
        ux, uy = (bx - ax) / n, (by - ay) / n
        frames.append((n, lambda t, d, ax=ax, ay=ay, ux=ux, uy=uy: (ax + ux * t - uy * d, ay + uy * t + ux * d),
                       (ux, uy)))

    def address(k, p):
        name, parity, _ = streets[k]
        return (name, parity, round(p[k % 2], 1))        # south and north sides count along x, else y

    made = {}
    for k in range(4):
        length, at, (ux, uy) = frames[k]
        before, at_before, (vx, vy) = frames[k - 1]
        # The corner house between this side and the one before: L-shaped, often with a cut corner.
        cut, deep = chamfers[k], 12.0
        (px, py), (qx, qy) = at(0, deep), at_before(0, deep)     # where the two rear walls meet
        s = ((qx - px) * vy - (qy - py) * vx) / (ux * vy - uy * vx)
        ring = [at(legs, 0), at(legs, deep), (px + ux * s, py + uy * s), at_before(before - legs, deep),
                at_before(before - legs, 0)] + ([at_before(before - cut, 0), at(cut, 0)] if cut else [at(0, 0)])
        made[k] = m.building(ring, front_tags(True), address(k, at(legs / 2, 0)))
        door = ((ring[-1][0] + ring[-2][0]) / 2, (ring[-1][1] + ring[-2][1]) / 2) if cut else at(legs / 2, 0)
        m.node(door, tags('entrance=' + dice.pick('yes', 'shop', 'main')))
        if dice.roll(3):
            m.node(at(4.5 + cut, 3.5), tags(next(SHOPS, 'shop=vacant')))
        # The houses between this corner and the next.
        count = round((length - 2 * legs) / 18)
        cuts = [legs] + [legs + (length - 2 * legs) * i / count + (dice.roll(5) - 2) * 0.6
                         for i in range(1, count)] + [length - legs]
        for i, (a, b) in enumerate(zip(cuts, cuts[1:])):
            d, mid = dice.pick(11.0, 12.0, 12.0, 12.5, 13.0), (a + b) / 2
            if (k, i) == gap:
                m.way([at(a + 0.1, 0.5), at(b - 0.1, 0.5)], tags('barrier=fence;fence_type=wood'))
                continue
            made[k, i] = m.building([at(a, 0), at(b, 0), at(b, d), at(a, d)], front_tags(False),
                                    address(k, at(mid, 0)))
            code = rear.get((k, i), '')
            m.node(at(mid + (4 if 'p' in code else 0), 0), tags('entrance=main'))
            if dice.roll(3) == 0:
                m.node(at(mid + 1, d), tags('entrance=yes'))
            if dice.roll(5) == 0:
                m.node(at(mid - 3, 3), tags(next(SHOPS, 'shop=vacant')))
            if 'p' in code:
                half = streets[k][2]
                m.way([at(mid, -half), at(mid, 0)], tags('highway=service;service=driveway'), join=True)
                m.way([at(mid, 0), at(mid, d)], tags('highway=service;tunnel=building_passage;layer=-1'
                                                     ';maxheight=3.2;covered=yes' if dice.roll(2) else
                                                     'highway=service;tunnel=building_passage'), join=True)
                m.way([at(mid, d), at(mid, d + 8)], tags('highway=service;service=driveway'), join=True)
            wing = dice.pick(9.0, 10.0, 11.0)
            for side, x0, x1, fall in (('l', a, a + 5.5, 1), ('r', b - 5.5, b, -1)):
                if side in code:                         # a lean-to roof falling into the court
                    t = tags('building=yes;building:levels=' + dice.pick('3', '4'))
                    if dice.roll(3):
                        t.update({'roof:shape': 'skillion', 'roof:direction': bearing(fall * ux, fall * uy)})
                    m.building([at(x0, d), at(x1, d), at(x1, d + wing), at(x0, d + wing)], t)
            if 'h' in code:
                t = tags(dice.pick('building=apartments;building:levels=4;roof:shape=gabled',
                                   'building=yes;building:levels=3', 'building=yes;roof:shape=skillion',
                                   "building=warehouse;height=40';building:material=brick"))
                m.building([at(a, d + wing), at(b, d + wing), at(b, d + wing + 9), at(a, d + wing + 9)], t)
    return made


g1 = perimeter([(0, 0), (100, 0), (100, 80), (6, 80)],
               [(COPPER, 1, 8), (MILL, 2, 8), (SALT, 2, 11), (WEST, 1, 8)],
               {(0, 0): 'l', (0, 1): 'rh', (0, 2): 'lh', (0, 3): 'rp', (2, 0): 'lrhp', (2, 2): 'l'},
               (3.5, 0, 4, 3))
g2 = perimeter([(116, 0), (206, 0), (206, 80), (116, 80)],
               [(COPPER, 1, 8), (BELL, 2, 8), (SALT, 2, 11), (MILL, 1, 8)],
               {(0, 0): 'rp', (0, 1): 'l', (0, 2): 'lrh', (2, 0): 'rh', (2, 1): 'lh', (2, 2): 'lp'},
               (0, 3, 4, 3))
g3 = perimeter([(7.6, 102), (100, 102), (100, 176), (12.9, 172)],
               [(SALT, 1, 11), (MILL, 2, 8), (CHESTNUT, 2, 8), (WEST, 1, 8)],
               {(0, 0): 'l', (0, 1): 'lrhp', (0, 2): 'r', (2, 0): 'r', (2, 1): 'lh'},
               (4, 4, 0, 0))
g4 = perimeter([(116, 102), (206, 102), (206, 180.9), (116, 176.7)],
               [(SALT, 1, 11), ('Glockengießergasse', 2, 8), (CHESTNUT, 2, 8), (MILL, 1, 8)],
               {(0, 0): 'lh', (0, 2): 'lrp', (2, 0): 'rh', (2, 2): 'l'},
               (4, 3, 3, 3), gap=(2, 1))
m.ways[g1[2, 1]][1].update(tags('name=Salzhof;roof:levels=1'))
# A corner turret as a lone building:part: no relation, and the parts do not fill the outline.
m.way(ellipse(202, 6.3, 2.4, 2.4, 8, math.pi / 8),
      tags('building:part=yes;height=27;roof:shape=dome;roof:height=3;roof:colour=#4f7f6b'), closed=True)
# A workshop alone in the court of G3.
m.building(box(72, 136, 84, 143), tags('building=workshop;building:levels=1;roof:shape=sawtooth;craft=carpenter'))

# ---------------------------------------------------------------- tenements of the 1920s
# A whole block as one ring: multipolygon, tags on the relation, closed outer and inner way.
outer = m.building(box(222, 0, 274, 80), {})
inner = m.building(box(234, 12, 262, 68), {})
m.relation([('way', outer, 'outer'), ('way', inner, 'inner')],
           tags('type=multipolygon;building=apartments;building:levels=4;roof:shape=hipped;roof:levels=1;'
                'name=Bauhütte-Hof;start_date=1927;building:material=brick;roof:colour=#7a3b2e'))
for x, y, tag in ((248, 0, 'main'), (222, 40, 'main'), (274, 40, 'yes'), (248, 12, 'yes'), (234, 30, 'staircase')):
    m.node((x, y), tags('entrance=' + tag))
for k, x in enumerate((286, 302, 318)):
    m.building(box(x, 0, x + 16 if k < 2 else 332, 12), tags('building=apartments;building:levels=4;'
               'roof:shape=hipped;start_date=1926-05'), (COPPER, 1, float(x)))
for k, y in enumerate((18, 33, 48)):
    m.building(box(320, y, 332, y + 15), tags('building=apartments;building:levels=4' +
               (';roof:shape=half-hipped', ';roof:shape=gabled', '')[k]), (EAST, 1, float(y)))

# ---------------------------------------------------------------------- slab estate
for k, x in enumerate((134, 162, 190, 218, 246)):
    roof = ('roof:shape=flat', 'roof:shape=flat;roof:colour=lightgrey', 'roof:shape=gabled;roof:angle=15',
            'roof:shape=gabled;roof:height=2', '')[k]
    m.building(turned(x, -66, 12, 60, 8), tags('building=apartments;building:levels=5;' + roof),
               (OATS, 1, float(x)))
tower = turned(306, -96, 22, 22, 8)
m.building(tower, tags('building=apartments;building:levels=12;roof:shape=flat;name=Hochhaus Ostwall;'
                       'start_date=1971;building:material=concrete'), (EAST, 1, -96.0))
m.way(tower, tags('building:part=yes;building:levels=12;roof:shape=flat'), closed=True)  # same nodes
m.way(turned(306, -96, 10, 8, 8), tags('building:part=yes;building:levels=13;building:min_level=12;'
                                       'roof:shape=flat;building:colour=#888888'), closed=True)
m.building(box(266, -78, 293, -72), tags('building=garages;building:levels=1;roof:shape=flat'))
m.way(box(298, -78, 316, -73), tags('building=roof;amenity=parking;parking=carports;height=2.6;roof:shape=skillion;'
                                    f'roof:direction={bearing(0, 1)};roof:height=0.4;layer=1'), closed=True)
m.way(turned(176, -66, 11, 40, 8), tags('building=garage;location=underground;layer=-1;amenity=parking;'
                                        'parking=underground;building:levels:underground=1'), closed=True)
m.building(box(296, -58, 328, -34), tags('building=retail;shop=supermarket;name=Kaufhalle;building:levels=1;'
                                         'height=5.5;roof:shape=flat'), (EAST, 1, -46.0))
m.node((296, -45), tags('entrance=main;automatic_door=yes'))
m.way(box(266, -60, 293, -26), tags('amenity=parking;parking=surface;capacity=34'), closed=True)
m.way(box(264, -66, 331.5, -17), tags('landuse=retail'), closed=True)
street([(340, -30), (294.5, -30), (294.5, -69), (262, -69)], None, 'service')
for x in (148, 204, 232):
    street([(x, -118), (x - 1, -66), (x - 4, -8)], None, 'footway', 'surface=concrete')

# ------------------------------------------------- church (outline, parts, relation) and square
NAVE, AISLE = box(242, 132, 276, 146), 'height=9;roof:shape=skillion;roof:height=3;roof:material=slate'
APSE = [(276, 134), (279.5, 134), (283, 137), (283, 141), (279.5, 144), (276, 144)]
TOWER = box(233, 134.5, 242, 143.5)
outline = m.building([(242, 127), (276, 127), (276, 132), *APSE, (276, 146), (276, 151), (242, 151), (242, 146),
                      (242, 143.5), (233, 143.5), (233, 134.5), (242, 134.5), (242, 132)],
                     tags('building=church;name=Zwölfbotenkirche;amenity=place_of_worship;religion=christian;'
                          'building:material=sandstone;start_date=1881;height=52'))
parts = [m.building(ring, tags('building:part=yes;' + text)) for ring, text in (
    (NAVE, 'height=20;roof:shape=gabled;roof:height=8;roof:orientation=along;roof:material=slate'),
    (TOWER, 'height=52;roof:shape=pyramidal;roof:height=20;roof:material=copper;roof:colour=#5f8f7f'),
    (APSE, 'height=15;roof:shape=pyramidal;roof:height=4'),
    (box(242, 146, 276, 151), AISLE + ';roof:direction=' + bearing(0, 1)),
    (box(242, 127, 276, 132), AISLE + ';roof:direction=' + bearing(0, -1)))]
m.relation([('way', outline, 'outline')] + [('way', p, 'part') for p in parts],
           tags('type=building;building=church;name=Zwölfbotenkirche'))
m.node((233, 139), tags('entrance=main'))
m.way([(222.5, 105), (331, 105), (331, 183), (222.5, 178)],
      tags('highway=pedestrian;area=yes;name=Zwölfbotenplatz;surface=sett'), closed=True)
street([(214, 139), (228, 139), (233, 139)], None, 'footway')
m.node((228, 158), tags('amenity=drinking_water'))
m.node((236, 112), tags('amenity=bench;backrest=yes'))
# The market hall: an old-style multipolygon, the tags on the outer way and not on the relation.
outer = m.building(box(292, 110, 326, 146), tags('building=public;name=Markthalle;amenity=marketplace;'
                   'building:levels=2;roof:shape=hipped;roof:material=metal'), (SALT, 1, 300.0))
inner = m.building(box(303, 121, 315, 135), {})
m.relation([('way', outer, 'outer'), ('way', inner, 'inner')], tags('type=multipolygon'))
m.building(turned(300, 166, 16, 11, 3), tags('building=house;name=Pfarrhaus;building:levels=2;roof:shape=half-hipped;'
                                             'roof:colour=brown;roof:levels=1'), (CHESTNUT, 2, 300.0))

# ------------------------------------------------------------------- school, two courtyards
outer = m.building([(122, 202), (200, 202), (200, 244), (168, 244), (168, 248), (154, 248), (154, 244), (122, 244)], {})
courts = [m.building(box(x, 214, x + 21, 232), {}) for x in (134, 167)]
m.relation([('way', outer, 'outer')] + [('way', c, 'inner') for c in courts],
           tags('type=multipolygon;building=school;name=Schule am Viadukt;building:levels=3;roof:shape=hipped;'
                'roof:levels=1;roof:material=roof_tiles;start_date=1904'))
m.node((161, 202), tags('entrance=main'))
m.building(box(128, 254, 156, 270), tags('building=sports_hall;height=9 m;roof:shape=round;roof:height=2.5'))
m.way(box(118, 192.8, 205, 272), tags('amenity=school;name=Schule am Viadukt'), closed=True)

# ------------------------------------------------------------------------------- factory
# The spinning mill: a multipolygon whose outer ring is two open ways.
half1 = m.way([(228, 208), (280, 208), (280, 242), (262, 242)], {}, join=True)
half2 = m.way([(262, 242), (262, 236), (244, 236), (244, 242), (228, 242), (228, 208)], {}, join=True)
inner = m.building(box(242, 218, 266, 228), {})
m.relation([('way', half1, 'outer'), ('way', half2, 'outer'), ('way', inner, 'inner')],
           tags('type=multipolygon;building=industrial;name=Alte Spinnerei;building:levels=4;roof:shape=flat;'
                'building:material=brick;building:colour=#9c4a34'))
m.building(box(288, 208, 326, 240), tags('building=industrial;height=9;roof:shape=sawtooth;roof:height=3;'
                                         'building:material=brick'))
# The bridge between mill and hall begins above the second storey; the yard lane runs under it.
m.building(box(280, 220, 288, 225), tags('building=bridge;building:levels=4;building:min_level=2;'
                                         'roof:shape=flat;layer=1'))
street([on_north(284), (284, 220)], None, 'service')
street([(284, 220), (284, 225)], None, 'service', 'covered=yes')
street([(284, 225), (284, 262), (320, 262), (320, 278)], None, 'service')
m.way(ellipse(300, 252, 2.2, 2.2, 12), tags('man_made=chimney;building=chimney;height=45;building:material=brick'),
      closed=True)
m.way(box(232, 250, 264, 264), tags('demolished:building=industrial;building:levels=2;note=pulled down 2019'),
      closed=True)
m.building(turned(274, 258, 8, 6, 0), tags('building=transformer_tower;height=11;power=substation;roof:shape=hipped'))
m.way([(224, 200.5), (281, 203)], tags('barrier=wall;height=2.5;material=brick'))
m.way([(287, 203.4), (330, 205.4), (330, 272), (323, 272)], tags('barrier=wall;height=2.5'))
m.way([(317, 272), (224, 272), (224, 200.5)], tags('barrier=fence;fence_type=chain_link'))
m.way([(223, 199), (331, 204), (331, 273), (223, 273)], tags('landuse=industrial;name=Alte Spinnerei'), closed=True)

# ---------------------------------------------------------------- detached and terraced houses
for k, (x, w, d, turn, text) in enumerate((
        (9, 11, 9, 0, 'building=detached;building:levels=2;roof:shape=hipped'), (28, 10, 10, 4, 'building=yes'),
        (46, 12, 9, -3, 'building=house;building:levels=1;roof:shape=gabled;roof:levels=1;roof:colour=#b5523b'),
        (66, 9, 9, 0, 'building=house;building:levels=2;roof:shape=pyramidal;roof:angle=30'),
        (87, 12, 8, 2, 'building=detached;building:levels=1.5;roof:shape=half-hipped;roof:orientation=along'))):
    m.building(turned(x, -24, w, d, turn), tags(text), (COPPER, 2, float(x)))
for k in range(7):                                       # a terrace: shared party walls again
    m.building(box(6 + 6.5 * k, -54, 12.5 + 6.5 * k, -44), tags('building=' + ('terrace', 'house', 'yes')[k % 3] + (
        ';building:levels=2;roof:shape=gabled' if k % 3 < 2 else '')), (LARK, 1, float(k)))
for k in range(2):
    m.building(box(64 + 8 * k, -53, 72 + 8 * k, -43), tags('building=semidetached_house;building:levels=2;'
               f'roof:shape=gabled;roof:colour={("Maroon", "#444")[k]}'), (LARK, 1, 64.0 + k))
# Skillion roof, direction as a compass word: it falls towards NNE, which is near local +y.
m.building(turned(8, -79, 10, 9, 0), tags('building=house;building:levels=2;roof:shape=skillion;'
                                          'roof:direction=NNE;roof:angle=12'), (LARK, 2, 8.0))
m.building(turned(27, -79, 9, 12, 6), tags('building=house'), (LARK, 2, 27.0))
# A house with its roof drawn: ridge and edges as ways that use the corners of the outline.
hip = box(40, -84, 53, -75)
m.building(hip, tags('building=detached;building:levels=2;roof:height=3.5'), (LARK, 2, 46.0))
m.way([(44.5, -79.5), (48.5, -79.5)], tags('roof:ridge=yes'))
for corner, end in zip(hip, ((44.5, -79.5), (48.5, -79.5), (48.5, -79.5), (44.5, -79.5))):
    m.way([corner, end], tags('roof:edge=yes'))
m.building([(0, -107), (12, -107), (12, -99), (6, -99), (6, -95), (0, -95)],
           tags('building=bungalow;building:levels=1;roof:shape=flat'), (OATS, 1, 0.0))
m.building(turned(46, -102, 11, 9, 5), tags('building=construction;construction=house'))
m.building(turned(66, -101, 10, 9, -4), tags('building=yes'), (OATS, 1, 66.0))
for x, y in ((18, -24), (37, -24), (98, -50), (16, -84)):
    m.building(box(x - 1.5, y - 3, x + 1.5, y + 3), tags('building=garage' if x != 37 else 'building=yes'))
m.way(turned(60, -34, 3, 2.5, 20), tags('building=shed'), closed=True)
m.way([(-1, -37), (98, -36)], tags('barrier=hedge'))

# --------------------------------------------------------------- park, water, trees, land use
m.way([(17, 191), (100, 195), (100, 268), (23, 268)], tags('leisure=park;name=Kastanienpark'), closed=True)
m.way(ellipse(62, 238, 19, 11, 18), tags('natural=water;water=pond'), closed=True)
street([WEST_NORTH, (40, 215), (72, 222), (108, 225)], None, 'footway', 'surface=gravel')
street([(40, 215), (36, 240), (52, 256), (80, 258), (108, 250)], None, 'path', 'surface=gravel')
m.building(ellipse(88, 208, 4.5, 4.5, 8), tags('building=pavilion;height=5;roof:shape=cone;building:material=wood'))
m.way([(20, 194), (55, 195.6), (97, 197.6)], tags('natural=tree_row;leaf_type=broadleaved'))
for k in range(26):                                      # park trees, kept off the pond and the paths
    x, y = 24 + 3.0 * k % 73, 200 + 37 * k % 66
    if min(math.hypot((x - 62) / 24, (y - 238) / 15), math.hypot(x - 88, y - 208) / 9) > 1:
        m.node((x, y), tags('natural=tree') if k % 3 else tags('natural=tree;leaf_type=broadleaved;height=14'))
for x in range(14, 330, 13):                             # two rows of street trees
    for y in (83.5, 98.5):
        if min(abs(x - c) for c in LONG_X) > 12:
            m.node((x, y), tags('natural=tree;denotation=avenue' + (';genus=Tilia;height=12' if x % 2 else '')))
for x, y in ((50, 40), (56, 46), (160, 42), (166, 36), (248, 30), (248, 50), (160, 140), (155, 150), (310, 50)):
    m.node((x, y), tags('natural=tree;leaf_type=broadleaved'))
for ring in ([(-1.5, -1), (101, -1), (101, 81), (4.5, 81)], box(115, -1, 207, 81), box(221, -1, 333, 81),
             [(6.5, 101), (101, 101), (101, 177.3), (11.5, 173.2)],
             [(115, 101), (207, 101), (207, 182.2), (115, 177.9)], box(-7, -111, 101, -15), box(115, -111, 262, -15)):
    m.way(ring, tags('landuse=residential'), closed=True)
centre = m.node((110, 86), tags('place=quarter;name=Blockrandviertel;population=2900'))
edge = [m.way(p, tags('boundary=administrative;admin_level=10')) for p in (
    [(-40, -130), (352, -130), (352, 300)], [(352, 300), (-20, 300), (-40, -130)])]
m.relation([('way', e, 'outer') for e in edge] + [('node', centre, 'label')],
           tags('type=boundary;boundary=administrative;admin_level=10;name=Blockrandviertel'))

# Neighbours that touch share nodes from here on.  What follows is wrong on purpose and is not mended.
m.join_touching()
m.number_houses()

# ------------------------------------------------------------------ planted mapping errors
# They have ids of their own (ways and nodes 9001 and up, relation 901) and say so in a note tag.


def wrong(i, points, text, what, closed=True):
    return m.way(points, tags(text, note='planted error: ' + what), closed, fixed_id=i)


# 9001: a bow-tie; the third and fourth corner were clicked in the wrong order.
wrong(9001, [(76, -34), (80, -34), (76, -31), (80, -31)], 'building=shed', 'bow-tie')
# 9002: the same node twice in a row.
twice = [m.node(p) for p in turned(66, -79, 10, 9, 0)]
wrong(9002, twice[:2] + twice[1:], 'building=house;building:levels=2;roof:shape=gabled', 'node twice in a row')
# 9003: a spike; the outline runs out to a stray node and back to the same corner.
spiked = [m.node(p) for p in turned(86, -80, 11, 9, 0)]
wrong(9003, spiked[:3] + [m.node((95.5, -70.5)), spiked[2], spiked[3]], 'building=house;roof:shape=hipped', 'spike')
# 9004: not closed; the last segment was forgotten.
wrong(9004, turned(27, -101, 11, 9, 0), 'building=house;building:levels=2', 'way not closed', closed=False)
# 9005 and 9006: one house traced twice over the same nodes, with different tags.
double = [m.node(p) for p in turned(86, -102, 12, 9, 0)]
wrong(9005, double, 'building=yes', 'traced twice')
wrong(9006, double, 'building=detached;building:levels=2;roof:shape=gabled', 'traced twice')
# Node 9007: a building that is only a point.
m.node((92, -46), tags('building=hut;note=planted error: building as a node'), fixed_id=9007)
# Relation 901: its inner way 9999 was left out of the extract.  9008 is its outer way.
wrong(9008, box(278, 24, 300, 44), '', 'outer way of relation 901')
m.relation([('way', 9008, 'outer'), ('way', 9999, 'inner')],
           tags('type=multipolygon;building=kindergarten;building:levels=2;roof:shape=flat;'
                'note=planted error: member 9999 is missing'), fixed_id=901)
# 9009: a number in words.  9010: a height no program can read.
wrong(9009, box(292, 68, 306, 80), 'building=apartments;building:levels=four;roof:shape=hipped', 'building:levels=four')
# 9010 also overlaps 9011 by 0.4 m: two mappers, two aerial images.
wrong(9010, [(310, 68.1), (321, 68.2), (321, 80.1), (310, 80)],
      'building=apartments;height=about as high as next door', 'height unreadable, overlaps 9011 by 0.4 m')
wrong(9011, box(320.6, 68, 332, 80), 'building=apartments;building:levels=4', 'overlaps 9010 by 0.4 m')
# 9012: stops 0.2 m short of the tenement at x = 286; the party wall was not shared.
wrong(9012, box(276.5, 0, 285.8, 12), 'building=apartments;building:levels=4;roof:shape=hipped',
      'gap of 0.2 m to the neighbour')

HERE = os.path.dirname(os.path.abspath(__file__))
m.write(sys.argv[1] if len(sys.argv) > 1 else os.path.join(HERE, 'blockrand-viertel.osm'))
