#!/usr/bin/python3
"""Leaves buildings out of an extract: what an aerial image shows and the map has not.

    omit.py IN.osm[.pbf|.gz] OUT.osm --seed N [--share 0.2] [--epsg CODE]

A share of the buildings that the extract has as one way, without holes, loses its tags, and so do the parts that lie in them. Truth: OUT.csv, a line
per building: id, omitted (0 or 1).
"""
import argparse
import csv
import os
import shutil
import xml.etree.ElementTree as ET

import numpy as np

import osm
from displace import Buildings, segments, within


def omit(source, target, seed, share=.2, epsg=None):
    """-> ids of the buildings that were left out."""
    xml = osm.as_xml(source)
    b = Buildings(osm.Extract(xml), epsg)
    rng = np.random.default_rng([seed, 21])
    members = {f"{t[0]}{ref}" for m, _ in b.extract.relations.values() for t, ref, _ in m}
    houses = [o for o in sorted(b.rings) if o[0] == "w" and b.objects[o][1] and o not in members]
    gone = set(rng.permutation(houses)[:int(round(share * len(houses)))].tolist())
    rings = {o: segments(b.rings[o]) for o in gone}
    boxes = {o: (b.rings[o][0].min(0), b.rings[o][0].max(0)) for o in gone}
    parts = {o for o, r in b.rings.items() if not b.objects[o][1] and any((l <= r[0].mean(0)).all() and (h >= r[0].mean(0)).all() and within(r[0].mean(0), rings[g]) for g, (l, h) in boxes.items())}
    tree = ET.parse(xml)
    for e in tree.getroot():
        if e.tag == "way" and f"w{e.get('id')}" in gone | parts:
            for t in e.findall("tag"):
                e.remove(t)
    tree.write(target, encoding="UTF-8", xml_declaration=True)
    if xml != source:
        shutil.rmtree(os.path.dirname(xml))
    with open(os.path.splitext(target)[0] + ".csv", "w", newline="") as f:
        w = csv.writer(f)
        w.writerow(["id", "omitted"])
        w.writerows([o, int(o in gone)] for o in b.rings if b.objects[o][1])
    return sorted(gone)


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("source")
    a.add_argument("target")
    a.add_argument("--seed", type=int, required=True)
    a.add_argument("--share", type=float, default=.2)
    a.add_argument("--epsg", type=int)
    a = a.parse_args()
    print(f"{len(omit(a.source, a.target, a.seed, a.share, a.epsg))} buildings left out")


if __name__ == "__main__":
    main()
