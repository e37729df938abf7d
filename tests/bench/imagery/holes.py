#!/usr/bin/python3
"""Cuts holes into outlines where a roof lies: courtyards that an aerial image must call built over, beside real ones that are open.

    holes.py IN.osm[.pbf|.gz] OUT.osm --seed N [--share 0.3] [--epsg CODE]

A share of the buildings that the extract has as one way, of 150 m2 and more, becomes a multipolygon with a rectangle as its hole, of 8 to 25 % of the
plan, along its longest wall and 2 m and more from every wall. Few outlines have holes: rows of houses that enclose a courtyard become one building with it
as its hole, where no other building stands in it. Truth: OUT.csv, a line per hole of 15 m2 and more: id, cut (0: it is real; 1: it was cut), area.
"""
import argparse
import csv
import math
import os
import shutil
import xml.etree.ElementTree as ET

import numpy as np

from osgeo import ogr

import osm
from displace import Buildings, segments, to_segments, within

LEAST_PLAN, LEAST_HOLE, BESIDE = 150, 15, 2.0  # m2, m2, m
TRIES = 60


def area(ring):
    x, y = (ring - ring[0]).T
    return abs(np.dot(x[:-1], y[1:]) - np.dot(x[1:], y[:-1])) / 2


def hole_in(ring, rng):
    """(4, 2) of a rectangle within a closed ring; None where none fits."""
    s = segments([ring])
    d = (s[:, 2:] - s[:, :2])[np.argmax(np.hypot(*(s[:, 2:] - s[:, :2]).T))]
    u = d / np.hypot(*d)
    for _ in range(TRIES):
        size, ratio = rng.uniform(.08, .25) * area(ring), rng.uniform(1, 2.5)
        a, b = math.sqrt(size * ratio) / 2, math.sqrt(size / ratio) / 2
        if size < LEAST_HOLE * 1.1:
            continue
        middle = rng.uniform(ring.min(0), ring.max(0))
        if rng.random() < .3:
            a, b = b, a
        put = np.array([middle + x * a * u + y * b * np.array([-u[1], u[0]]) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
        edge = segments([np.vstack([put, put[:1]])])
        if within(middle, s) and all(within(p, s) for p in put) and min(to_segments(put, s), to_segments(s[:, :2], edge)) >= BESIDE:
            return put
    return None


def polygon(ring):
    line = ogr.Geometry(ogr.wkbLinearRing)
    for x, y in ring:
        line.AddPoint_2D(float(x), float(y))
    line.CloseRings()
    out = ogr.Geometry(ogr.wkbPolygon)
    out.AddGeometry(line)
    return out if out.IsValid() else out.Buffer(0)


def points(ring):
    return np.array([ring.GetPoint_2D(k) for k in range(ring.GetPointCount())])


def enclosing_rows(b, houses):
    """Rows of single ways that enclose courtyards -> [(ids of the row, outer ring, holes)]."""
    rows, out = {}, []
    for o in b.rings:
        rows.setdefault(b.rows[o], []).append(o)
    for row in rows.values():
        own = [o for o in row if b.objects[o][1]]
        if not 2 <= len(own) <= 80 or not set(own) <= houses:
            continue
        shape = ogr.Geometry(ogr.wkbMultiPolygon)
        for o in own:
            p = polygon(b.rings[o][0]).Buffer(.03)
            if p.GetGeometryName() == "POLYGON":
                shape.AddGeometry(p)
        shape = shape.UnionCascaded().SimplifyPreserveTopology(.05)
        if shape.GetGeometryName() != "POLYGON":
            continue
        outer = polygon(points(shape.GetGeometryRef(0)))
        holes = [points(shape.GetGeometryRef(k)) for k in range(1, shape.GetGeometryCount())]
        holes = [h for h in holes if area(h) >= LEAST_HOLE]
        inside = [polygon(b.rings[o][0]) for o in b.rings if o not in row and outer.Contains(polygon(b.rings[o][0]))] if holes else []
        holes = [h for h in holes if not any(polygon(h).Intersects(i) for i in inside)]
        if holes:
            out.append((row, points(shape.GetGeometryRef(0)), holes))
    return out


def cut_holes(source, target, seed, share=.3, epsg=None):
    """-> ids of the buildings that got a hole."""
    xml = osm.as_xml(source)
    b = Buildings(osm.Extract(xml), epsg)
    rng = np.random.default_rng([seed, 22])
    members = {f"{t[0]}{ref}" for m, _ in b.extract.relations.values() for t, ref, _ in m}
    houses = [o for o in sorted(b.rings) if o[0] == "w" and b.objects[o][1] and o not in members and len(b.rings[o]) == 1 and area(b.rings[o][0]) >= LEAST_PLAN]
    tree = ET.parse(xml)
    root = tree.getroot()
    ways = {e.get("id"): e for e in root if e.tag == "way"}
    node, way, relation = max(b.extract.nodes) + 1, max(b.extract.ways) + 1, max([0, *b.extract.relations]) + 1
    back = osm.transformation(b.epsg, 4326)
    rows, new, ids = [], {"node": [], "way": [], "relation": []}, []

    def add_way(ring):
        """-> id of a new closed way of these points, the last not repeated."""
        nonlocal node, way
        e, first = ET.Element("way", id=str(way), version="1"), node
        for p in ring:
            lon, lat, _ = back.TransformPoint(float(p[0]), float(p[1]))
            new["node"].append(ET.Element("node", id=str(node), version="1", lon=f"{lon:.9f}", lat=f"{lat:.9f}"))
            ET.SubElement(e, "nd", ref=str(node))
            node += 1
        ET.SubElement(e, "nd", ref=str(first))
        new["way"].append(e)
        way += 1
        return way - 1

    def add_building(outer, holes, tags):
        nonlocal relation
        r = ET.Element("relation", id=str(relation), version="1")
        ET.SubElement(r, "member", type="way", ref=str(outer), role="outer")
        for h in holes:
            ET.SubElement(r, "member", type="way", ref=str(h), role="inner")
        for k, v in {**tags, "type": "multipolygon"}.items():
            ET.SubElement(r, "tag", k=k, v=v)
        new["relation"].append(r)
        relation += 1
        return f"r{relation - 1}"

    def bare(o):
        for t in ways[o[1:]].findall("tag"):
            ways[o[1:]].remove(t)

    for row, outer, holes in enclosing_rows(b, {o for o in b.rings if o[0] == "w" and o not in members}):
        tags = b.extract.ways[int(next(o for o in row if b.objects[o][1])[1:])][1]
        for o in row:
            bare(o)
        i = add_building(add_way(outer[:-1]), [add_way(h[:-1]) for h in holes], tags)
        rows += [[i, 0, f"{area(h):.1f}"] for h in holes]
        houses = [o for o in houses if o not in row]
    for o in rng.permutation(houses)[:int(round(share * len(houses)))]:
        put = hole_in(b.rings[o][0], rng)
        if put is None:
            continue
        bare(o)
        ids.append(add_building(o[1:], [add_way(put)], b.extract.ways[int(o[1:])][1]))
        rows.append([ids[-1], 1, f"{area(np.vstack([put, put[:1]])):.1f}"])
    for i, (m, tags) in b.extract.relations.items():
        if tags.get("type") == "multipolygon" and tags.get("building", "no") != "no":
            for t, ref, role in m:
                if t == "way" and role == "inner" and ref in b.extract.ways:
                    ring = np.array([b.xy[n] for n in b.extract.ways[ref][0] if n in b.xy])
                    if len(ring) > 3 and area(ring) >= LEAST_HOLE:
                        rows.append([f"r{i}", 0, f"{area(ring):.1f}"])
    kinds = lambda k: sorted([e for e in root if e.tag == k] + new[k], key=lambda e: int(e.get("id")))
    root[:] = [e for e in root if e.tag not in new] + kinds("node") + kinds("way") + kinds("relation")
    tree.write(target, encoding="UTF-8", xml_declaration=True)
    if xml != source:
        shutil.rmtree(os.path.dirname(xml))
    with open(os.path.splitext(target)[0] + ".csv", "w", newline="") as f:
        w = csv.writer(f)
        w.writerow(["id", "cut", "area"])
        w.writerows(rows)
    return ids


def read_holes(csv_path):
    """id -> 1 where its hole was cut, 0 where its holes are real."""
    with open(csv_path) as f:
        return {r["id"]: int(r["cut"]) for r in csv.DictReader(f)}


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("source")
    a.add_argument("target")
    a.add_argument("--seed", type=int, required=True)
    a.add_argument("--share", type=float, default=.3)
    a.add_argument("--epsg", type=int)
    a = a.parse_args()
    print(f"{len(cut_holes(a.source, a.target, a.seed, a.share, a.epsg))} holes cut")


if __name__ == "__main__":
    main()
