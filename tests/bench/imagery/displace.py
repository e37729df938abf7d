#!/usr/bin/python3
"""Moves the buildings of an extract by known amounts, row by row; nothing else changes.

    displace.py IN.osm[.pbf|.gz] OUT.osm --seed N --min 1 --max 3 [--rotate DEG] [--share 1.0] [--jitter M] [--walls 0.5] [--epsg CODE]

A row: buildings and building parts that share nodes, belong to one relation, lie in one another or are nearer than 2 m. It moves as
one: turned about its centre (counter-clockwise, at most so far that no corner moves 1.5 m by it), then shifted. Lengths are metres
in the projected system of the build (UTM of the extract's middle unless told), that is on the ground. Nodes that other ways use
too (streets, fences, areas) are copied, the others' stay. Truth: OUT.csv, a line per building. --share: share of the buildings
that are moved (whole rows), the rest stays: the test of false corrections. --jitter: deviation of every corner's own error, m. --walls: share of the rows in which a house
has one or two walls, at corners that no neighbour has, shifted along their normal by 0.3 to 1 m, the other walls staying on their lines.
"""
import argparse
import csv
import math
import os
import shutil
import xml.etree.ElementTree as ET

import numpy as np

import osm

NEAR = 2.0   # m between buildings of one row
TURN = 1.5   # m that a corner may move by rotation


def is_building(tags):
    return tags.get("building", "no") != "no"


def is_part(tags):
    return tags.get("building:part", "no") != "no"


class Buildings:
    """Outlines of an extract. objects: id ('w1', 'r2') -> (list of way ids, is it a building, not a part alone); rows: id -> row."""

    def __init__(self, extract, epsg=None):
        self.extract = extract
        lonlat = np.array([(n[0], n[1]) for n in extract.nodes.values()])
        self.epsg = epsg or osm.utm_of(*np.median(lonlat, axis=0))
        self.xy = extract.project(self.epsg)
        self.objects, groups = {}, []
        for i, (members, tags) in extract.relations.items():
            ways = [ref for type_, ref, _ in members if type_ == "way" and ref in extract.ways]
            if not ways:
                continue
            if tags.get("type") == "multipolygon" and (is_building(tags) or is_part(tags)):
                self.objects[f"r{i}"] = ways, is_building(tags)
            elif tags.get("type") == "building":
                groups.append([f"w{w}" for w in ways] + [f"r{ref}" for type_, ref, _ in members if type_ == "relation"])
        for i, (refs, tags) in extract.ways.items():
            if is_building(tags) or is_part(tags):
                self.objects[f"w{i}"] = [i], is_building(tags)
        self.rings = {o: r for o, r in ((o, self.rings_of(o)) for o in self.objects) if r}
        self.rows = self.connect(groups)

    def rings_of(self, o):
        return [np.array([self.xy[n] for n in self.extract.ways[w][0] if n in self.xy]) for w in self.objects[o][0]
                if sum(n in self.xy for n in self.extract.ways[w][0]) > 1]

    def ways(self):
        return {w for o in self.rings for w in self.objects[o][0]}

    def connect(self, groups):
        parent = {o: o for o in self.rings}

        def find(o):
            while parent[o] != o:
                parent[o] = parent[parent[o]]
                o = parent[o]
            return o

        def join(a, b):
            parent[find(a)] = find(b)
        for g in groups:
            g = [o for o in g if o in parent]
            for o in g[1:]:
                join(g[0], o)
        by_node = {}
        for o in self.rings:
            for w in self.objects[o][0]:
                for n in self.extract.ways[w][0]:
                    join(by_node.setdefault(n, o), o)
        boxes = {o: (np.min([x.min(0) for x in r], 0) - NEAR, np.max([x.max(0) for x in r], 0) + NEAR) for o, r in self.rings.items()}
        cells, size = {}, 25.0
        for o, (low, high) in boxes.items():
            for i in range(int(low[0] // size), int(high[0] // size) + 1):
                for j in range(int(low[1] // size), int(high[1] // size) + 1):
                    cells.setdefault((i, j), []).append(o)
        for cell in cells.values():
            for k, a in enumerate(cell):
                for b in cell[k + 1:]:
                    if find(a) != find(b) and (boxes[a][0] < boxes[b][1] - NEAR).all() and (boxes[b][0] < boxes[a][1] - NEAR).all() and near(self.rings[a], self.rings[b]):
                        join(a, b)
        names = {}
        return {o: names.setdefault(find(o), len(names)) for o in sorted(self.rings, key=lambda o: (o[0], int(o[1:])))}


def segments(rings):
    return np.vstack([np.hstack([r[:-1], r[1:]]) for r in rings])


def to_segments(p, s):
    """Distance of points (n, 2) from segments (m, 4): the least."""
    a, d = s[None, :, :2], (s[:, 2:] - s[:, :2])[None]
    t = np.clip(((p[:, None] - a) * d).sum(2) / np.maximum((d * d).sum(2), 1e-12), 0, 1)
    return np.hypot(*np.moveaxis(p[:, None] - a - t[..., None] * d, 2, 0)).min()


def within(p, s):
    """Even-odd: is the point inside the rings' segments?"""
    cross = (s[:, 1] > p[1]) != (s[:, 3] > p[1])
    x = s[:, 0] + (p[1] - s[:, 1]) * (s[:, 2] - s[:, 0]) / np.where(s[:, 3] == s[:, 1], 1, s[:, 3] - s[:, 1])
    return (cross & (x > p[0])).sum() % 2 == 1


def near(a, b):
    sa, sb = segments(a), segments(b)
    return min(to_segments(sa[:, :2], sb), to_segments(sb[:, :2], sa)) < NEAR or within(sa[0, :2], sb) or within(sb[0, :2], sa)


def centroid(rings):
    """(2,) of the largest ring's corners by length of the walls: good enough for a centre of rotation."""
    s = segments(rings)
    w = np.hypot(*(s[:, 2:] - s[:, :2]).T)
    return ((s[:, :2] + s[:, 2:]) / 2 * w[:, None]).sum(0) / max(w.sum(), 1e-9)


def plan_moves(b, rng, low, high, rotate, share):
    """Row -> (dx, dy, degrees, centre (2,)); rows that stay are absent."""
    rows = {}
    for o, r in b.rows.items():
        rows.setdefault(r, []).append(o)
    total, done, moves = sum(b.objects[o][1] for o in b.rows), 0, {}
    for r in rng.permutation(len(rows)):
        n = sum(b.objects[o][1] for o in rows[r])
        length, angle, turn = rng.uniform(low, high), rng.uniform(0, 2 * math.pi), rng.uniform(-1, 1) * rotate
        if share < 1 and (done >= share * total or done + n > share * total + max(1, .15 * total)):
            continue
        done += n
        rings = [x for o in rows[r] for x in b.rings[o]]
        centre = centroid(rings)
        reach = max(np.hypot(*(x - centre).T).max() for x in rings)
        limit = math.degrees(TURN / max(reach, 1))
        moves[int(r)] = length * math.cos(angle), length * math.sin(angle), float(np.clip(turn, -limit, limit)), centre
    return moves


def moved(p, move):
    """(n, 2) points after a move."""
    dx, dy, degrees, centre = move
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (np.asarray(p) - centre) @ np.array([[c, s], [-s, c]]) + centre + (dx, dy)


def shift_wall(ring, rng, done, free):
    """A ring (n, 2), not closed, with one wall between two clear corners shifted by 0.3 to 1 m, or None where there is none that can be; done: walls that were, by their first corner; free: corners that may move."""
    n, edge = len(ring), np.roll(ring, -1, 0) - ring
    length = np.hypot(*edge.T)
    if (length < 1e-6).any():
        return None
    unit = edge / length[:, None]
    turn = np.abs([unit[i - 1, 0] * unit[i, 1] - unit[i - 1, 1] * unit[i, 0] for i in range(n)])   # at the corner where edge i begins
    fit = [i for i in range(n) if free[i] and free[(i + 1) % n] and length[i] >= 3 and min(length[i - 1], length[(i + 1) % n]) >= 3 and turn[i] > .7 and turn[(i + 1) % n] > .7 and i not in done]
    if n < 4 or not fit:
        return None
    i, by = int(rng.choice(fit)), rng.uniform(.3, 1) * rng.choice([-1, 1])
    normal, out = np.array([unit[i, 1], -unit[i, 0]]), ring.copy()
    for corner, way in ((i, unit[i - 1]), ((i + 1) % n, unit[(i + 1) % n])):
        out[corner] = ring[corner] + way * (by / (way @ normal))
    done.add(i)
    return out


def plan_walls(b, rng, share):
    """Row -> {node: (2,) place} of houses with shifted walls, before their row is moved: of each row one house at most, at corners that it has for itself."""
    rows, plans, used = {}, {}, {}
    for o, r in b.rows.items():
        rows.setdefault(r, []).append(o)
        for w in b.objects[o][0]:
            for n in set(b.extract.ways[w][0]):
                used[n] = used.get(n, 0) + 1
    for r in sorted(rows):
        chance, count, o = rng.random(), int(rng.integers(1, 3)), rows[r][int(rng.integers(len(rows[r])))]
        ways = b.objects[o][0]
        if chance >= share or len(ways) != 1 or not b.objects[o][1]:
            continue
        refs = b.extract.ways[ways[0]][0]
        if len(refs) < 5 or refs[0] != refs[-1] or any(n not in b.xy for n in refs) or len(set(refs)) != len(refs) - 1:
            continue
        others = [x for k in rows[r] if k != o for x in b.rings[k]]
        apart = lambda p: not others or to_segments(np.array([p]), segments(others)) > .7
        ring, done = b.rings[o][0][:-1], set()
        free = [used[n] == 1 and apart(b.xy[n]) for n in refs[:-1]]
        for _ in range(count):
            shifted = shift_wall(ring, rng, done, free)
            ring = ring if shifted is None else shifted
        if not np.array_equal(ring, b.rings[o][0][:-1]):
            plans[r] = o, dict(zip(refs[:-1], ring))
    return plans


def displace(source, target, seed, low, high, rotate=0.0, share=1.0, jitter=0.0, epsg=None, walls=0.0):
    xml = osm.as_xml(source)
    b = Buildings(osm.Extract(xml), epsg)
    rng = np.random.default_rng([seed, 4])
    moves = plan_moves(b, rng, low, high, rotate, share)
    reshaped = plan_walls(b, np.random.default_rng([seed, 5]), walls) if walls else {}
    way_row = {w: b.rows[o] for o in b.rings for w in b.objects[o][0]}
    mine = set(way_row)
    foreign = {n for w, (refs, _) in b.extract.ways.items() if w not in mine for n in refs}
    node_row = {n: r for w, r in way_row.items() if r in moves or r in reshaped for n in b.extract.ways[w][0] if n in b.xy}
    new, copies, next_id = {}, {}, max(b.extract.nodes, default=0) + 1
    back = osm.transformation(b.epsg, 4326)
    for n in sorted(node_row):
        row = node_row[n]
        p = np.asarray(reshaped[row][1].get(n, b.xy[n]) if row in reshaped else b.xy[n], float)
        if row in moves:
            p = moved(p[None], moves[row])[0] + (rng.normal(0, jitter, 2) if jitter else 0)
        lon, lat, _ = back.TransformPoint(float(p[0]), float(p[1]))
        new[n] = f"{lon:.9f}", f"{lat:.9f}"
        if n in foreign:
            copies[n] = next_id
            next_id += 1
    tree = ET.parse(xml)
    root = tree.getroot()
    twins = []
    for e in root:
        i = int(e.get("id", 0))
        if e.tag == "node":
            if i in copies:
                twin = ET.Element("node", dict(e.attrib, id=str(copies[i]), lon=new[i][0], lat=new[i][1]))
                twin.tail = "\n"
                twins.append(twin)
            elif i in new:
                e.set("lon", new[i][0])
                e.set("lat", new[i][1])
        elif e.tag == "way" and i in mine and (way_row[i] in moves or way_row[i] in reshaped):
            for nd in e.iter("nd"):
                r = int(nd.get("ref"))
                if r in copies:
                    nd.set("ref", str(copies[r]))
    nodes = sorted([e for e in root if e.tag == "node"] + twins, key=lambda e: int(e.get("id")))
    heads, tails = [e for e in root if e.tag not in ("node", "way", "relation")], [e for e in root if e.tag in ("way", "relation")]
    root[:] = heads + nodes + tails
    tree.write(target, encoding="UTF-8", xml_declaration=True)
    if xml != source:
        shutil.rmtree(os.path.dirname(xml))
    with open(os.path.splitext(target)[0] + ".csv", "w", newline="") as f:
        f.write(f"# EPSG:{b.epsg} seed {seed} shift {low}-{high} m rotation {rotate} share {share} jitter {jitter} walls {walls}; dx, dy: how far the building was moved, m\n")
        w = csv.writer(f)
        w.writerow("id part row moved dx dy rotation_deg row_x row_y x y reshaped".split())
        for o, r in b.rows.items():
            dx, dy, turn, centre = moves.get(r, (0.0, 0.0, 0.0, centroid(b.rings[o])))
            c = centroid(b.rings[o])
            w.writerow([o, int(not b.objects[o][1]), r, int(r in moves), f"{dx:.4f}", f"{dy:.4f}", f"{turn:.4f}", f"{centre[0]:.3f}", f"{centre[1]:.3f}", f"{c[0]:.3f}", f"{c[1]:.3f}", int(r in reshaped and reshaped[r][0] == o)])
    return b, moves


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("source")
    a.add_argument("target")
    a.add_argument("--seed", type=int, required=True)
    a.add_argument("--min", type=float, default=1)
    a.add_argument("--max", type=float, default=3)
    a.add_argument("--rotate", type=float, default=0)
    a.add_argument("--share", type=float, default=1)
    a.add_argument("--jitter", type=float, default=0)
    a.add_argument("--walls", type=float, default=0)
    a.add_argument("--epsg", type=int)
    a = a.parse_args()
    b, moves = displace(a.source, a.target, a.seed, a.min, a.max, a.rotate, a.share, a.jitter, a.epsg, a.walls)
    print(f"{len(b.rows)} outlines in {len(set(b.rows.values()))} rows; {len(moves)} rows moved; EPSG:{b.epsg}")


if __name__ == "__main__":
    main()
