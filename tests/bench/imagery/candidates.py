"""What `unmapped` of imagery.json is worth: candidates against the buildings that omit.py left out, and the sheds of a rendered scene."""
import csv
import os

import numpy as np
from osgeo import ogr

import osm
from displace import Buildings

COVERED = .5  # of a candidate's roof: as much of it on roofs of one building that was left out, and it is that
SAME = .3     # intersection over union from which its outline is that of the building as well
LEAST = 20    # m2: smaller buildings are not looked for


def polygon(ring):
    line = ogr.Geometry(ogr.wkbLinearRing)
    for x, y in ring:
        line.AddPoint_2D(float(x), float(y))
    line.CloseRings()
    out = ogr.Geometry(ogr.wkbPolygon)
    out.AddGeometry(line)
    return out if out.IsValid() else out.Buffer(0)


def leans_of(truth):
    """Of truth.json: id -> (2,) metres by which the image shows the roof from its plan."""
    return {i: np.array(b["lean_m"]) for i, b in truth["buildings"].items()} if truth else {}


class Truth:
    """roofs: id -> polygon where the image shows what was left out; sheds: the same of what no map has."""

    def __init__(self, whole, omitted, epsg, truth=None):
        b = Buildings(osm.Extract(whole), epsg)
        with open(os.path.splitext(omitted)[0] + ".csv") as f:
            gone = [r["id"] for r in csv.DictReader(f) if r["omitted"] == "1"]
        lean = leans_of(truth)
        seen = {i: t["roof_seen_m2"] for i, t in truth["buildings"].items()} if truth else {}
        self.roofs = {o: polygon(b.rings[o][0] + lean.get(o, 0)) for o in gone if o in b.rings and seen.get(o, 1e9) > LEAST / 2}
        self.sheds = []
        for s in truth["unmapped"] if truth else []:
            half = max(s["size_m"]) / 2 + 1
            self.sheds.append(polygon(np.array(s["centre"]) + half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])))

    def large(self):
        return {o for o, p in self.roofs.items() if p.Area() >= LEAST}

    def judge(self, candidate):
        """-> ('right', id, IoU), ('shed', None, 0) or ('wrong', None, 0)."""
        p = polygon(np.array(candidate["outline"]) + candidate["lean_m"])
        shared = [(p.Intersection(g).Area(), o) for o, g in self.roofs.items() if g.Intersects(p)]
        if shared:
            area, o = max(shared)
            if area > COVERED * p.Area():
                return "right", o, area / (p.Area() + self.roofs[o].Area() - area)
            if sum(a for a, _ in shared) > COVERED * p.Area():
                return "right", o, area / (p.Area() + self.roofs[o].Area() - area)
        if any(s.Intersects(p) and s.Intersection(p).Area() > COVERED * min(s.Area(), p.Area()) for s in self.sheds):
            return "shed", None, 0
        return "wrong", None, 0
