#!/usr/bin/python3
"""Adds buildings to an extract that do not stand there: what an aerial image must call gone.

    ghosts.py IN.osm[.pbf|.gz] OUT.osm --seed N [--share 0.15] [--epsg CODE]

Copies of houses that the extract has as one way, turned and moved by 15 to 80 m to where no building is nearer than 3 m. Truth:
OUT.csv, a line per building: id, ghost (0 or 1).
"""
import argparse
import csv
import math
import os
import shutil
import xml.etree.ElementTree as ET

import numpy as np

import osm
from displace import Buildings, moved, segments, to_segments, within

CLEAR = 3.0   # m between a ghost and any other building
TRIES = 40


def free(ring, others):
    s = segments([ring])
    for o in others:
        t = segments(o)
        if min(to_segments(s[:, :2], t), to_segments(t[:, :2], s)) < CLEAR or within(s[0, :2], t) or within(t[0, :2], s):
            return False
    return True


def add_ghosts(source, target, seed, share=.15, epsg=None):
    """-> ids of the ghosts."""
    xml = osm.as_xml(source)
    b = Buildings(osm.Extract(xml), epsg)
    rng = np.random.default_rng([seed, 9])
    houses = [o for o in sorted(b.rings) if o[0] == "w" and b.objects[o][1] and len(b.rings[o]) == 1 and np.ptp(b.rings[o][0], 0).max() < 40]
    low, high = np.min([r.min(0) for rs in b.rings.values() for r in rs], 0), np.max([r.max(0) for rs in b.rings.values() for r in rs], 0)
    boxes = [(np.min([x.min(0) for x in r], 0), np.max([x.max(0) for x in r], 0), r) for r in b.rings.values()]
    ghosts = []
    for o in rng.permutation(houses):
        if len(ghosts) >= share * len(houses):
            break
        ring, centre = b.rings[o][0], b.rings[o][0].mean(0)
        for _ in range(TRIES):
            length, angle = rng.uniform(15, 80), rng.uniform(0, 2 * math.pi)
            put = moved(ring, (length * math.cos(angle), length * math.sin(angle), rng.uniform(0, 360), centre))
            if (put.min(0) < low).any() or (put.max(0) > high).any():
                continue
            if free(put, [r for l, h, r in boxes if (l < put.max(0) + CLEAR).all() and (h > put.min(0) - CLEAR).all()]):
                ghosts.append((o, put))
                boxes.append((put.min(0), put.max(0), [put]))
                break
    tree = ET.parse(xml)
    root = tree.getroot()
    node, way = max(b.extract.nodes) + 1, max(b.extract.ways) + 1
    back = osm.transformation(b.epsg, 4326)
    nodes, ways, ids = [], [], []
    for o, put in ghosts:
        e = ET.Element("way", id=str(way), version="1")
        first = node
        for p in put[:-1]:
            lon, lat, _ = back.TransformPoint(float(p[0]), float(p[1]))
            nodes.append(ET.Element("node", id=str(node), version="1", lon=f"{lon:.9f}", lat=f"{lat:.9f}"))
            ET.SubElement(e, "nd", ref=str(node))
            node += 1
        ET.SubElement(e, "nd", ref=str(first))
        for k, v in b.extract.ways[int(o[1:])][1].items():
            ET.SubElement(e, "tag", k=k, v=v)
        ways.append(e)
        ids.append(f"w{way}")
        way += 1
    kinds = lambda k: [e for e in root if e.tag == k]
    by_id = lambda e: int(e.get("id"))
    root[:] = [e for e in root if e.tag not in ("node", "way", "relation")] + sorted(kinds("node") + nodes, key=by_id) + sorted(kinds("way") + ways, key=by_id) + kinds("relation")
    tree.write(target, encoding="UTF-8", xml_declaration=True)
    if xml != source:
        shutil.rmtree(os.path.dirname(xml))
    with open(os.path.splitext(target)[0] + ".csv", "w", newline="") as f:
        w = csv.writer(f)
        w.writerow(["id", "ghost"])
        w.writerows([[o, 0] for o in b.rings if b.objects[o][1]] + [[i, 1] for i in ids])
    return ids


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("source")
    a.add_argument("target")
    a.add_argument("--seed", type=int, required=True)
    a.add_argument("--share", type=float, default=.15)
    a.add_argument("--epsg", type=int)
    a = a.parse_args()
    print(f"{len(add_ghosts(a.source, a.target, a.seed, a.share, a.epsg))} buildings that are not there")


if __name__ == "__main__":
    main()
