#!/usr/bin/env python3
"""Writes 64 lots in the old town of Lübeck as an OSM extract: footprints with storeys, streets, no other tags.

    samples/luebeck_quarter.py [--seed N] > quarter.osm

The demonstration of Holtmeier (2020), with lots of our own: rib streets of narrow deep lots, cross streets of wide shallow
ones, corner lots between. Every lot is drawn; another seed gives other widths, depths and storeys.
"""
import argparse
import math
import random

LAT, LON = 53.8662, 10.6855  # in the district of configs/districts/luebeck_old_town.toml
METRES_PER_DEGREE = 111320
STREET = 9.0       # m between fronts
BLOCK_DEPTH = 44.0  # m, two rows back to back
SIDE = 11.0        # m of front on a cross street, of corner and cross lots
ROW = 12           # lots of a row, beside the two at its corners


class Writer:
    def __init__(self):
        self.nodes, self.ways, self.ids = [], [], {}

    def node(self, x, y):
        key = (round(x * 1000), round(y * 1000))
        if key not in self.ids:
            self.ids[key] = len(self.ids) + 1
            lat = LAT + y / METRES_PER_DEGREE
            lon = LON + x / (METRES_PER_DEGREE * math.cos(math.radians(LAT)))
            self.nodes.append(f'  <node id="{self.ids[key]}" version="1" lat="{lat:.7f}" lon="{lon:.7f}"/>')
        return self.ids[key]

    def way(self, points, tags, closed=False):
        refs = [self.node(*p) for p in points]
        refs += refs[:1] if closed else []
        body = ''.join(f'<nd ref="{r}"/>' for r in refs) + ''.join(f'<tag k="{k}" v="{v}"/>' for k, v in tags)
        self.ways.append(f'  <way id="{len(self.ways) + 1}" version="1">{body}</way>')

    def lot(self, x0, y0, x1, y1, storeys):
        self.way([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], [('building', 'yes'), ('building:levels', storeys)], True)


def quarter(seed):
    rng = random.Random(seed)
    out = Writer()
    storeys = lambda: rng.choice([2, 3, 3, 4])  # one to three above the ground floor
    corner = [rng.uniform(7.0, 8.5), rng.uniform(7.0, 8.5)]
    widths = [[rng.uniform(5.6, 9.4) for _ in range(ROW)] for _ in range(4)]
    length = max(map(sum, widths))
    widths = [[w * length / sum(row) for w in row] for row in widths]  # rows end at one cross street
    right = corner[0] + length + corner[1]
    for block in range(2):
        y0 = block * (BLOCK_DEPTH + STREET)
        y3 = y0 + BLOCK_DEPTH
        for front, way, row in ((y0, 1, 2 * block), (y3, -1, 2 * block + 1)):
            x = corner[0]
            for width in widths[row]:
                depth = rng.uniform(14, 19)
                ys = sorted((front, front + way * depth))
                out.lot(x, ys[0], x + width, ys[1], storeys())
                x += width
            ys = sorted((front, front + way * SIDE))
            out.lot(0, ys[0], corner[0], ys[1], storeys())
            out.lot(right - corner[1], ys[0], right, ys[1], storeys())
        for y in (y0 + SIDE, y0 + 2 * SIDE):
            out.lot(0, y, corner[0], y + SIDE, storeys())
            out.lot(right - corner[1], y, right, y + SIDE, storeys())
    for i in range(3):
        y = i * (BLOCK_DEPTH + STREET) - STREET / 2
        out.way([(-STREET / 2, y), (right + STREET / 2, y)], [('highway', 'residential'), ('name', f'Rib street {i + 1}')])
    for i, x in enumerate((-STREET / 2, right + STREET / 2)):
        out.way([(x, j * (BLOCK_DEPTH + STREET) - STREET / 2) for j in range(3)],
                [('highway', 'residential'), ('name', f'Cross street {i + 1}')])
    return '\n'.join(['<?xml version="1.0" encoding="UTF-8"?>', '<osm version="0.6" generator="luebeck_quarter.py">'] +
                     out.nodes + out.ways + ['</osm>'])


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--seed', type=int, default=1)
    print(quarter(parser.parse_args().seed))
