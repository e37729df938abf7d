"""A finished build read from its CityJSON text sequences: solids of LoD2 by building, and what is true of their roofs."""
import glob
import json
import math
import os

import numpy as np


class Face:
    """One planar face: rings (list of (n, 3), metres in the frame of the scene), unit normal (3,), kind Ground, Wall or Roof."""
    __slots__ = ("rings", "normal", "kind", "solid")

    def __init__(self, rings, normal, kind, solid):
        self.rings, self.normal, self.kind, self.solid = rings, normal, kind, solid


class Building:
    def __init__(self, id_, attributes):
        self.id, self.attributes, self.faces = id_, attributes, []


def newell(ring):
    """(n, 3) -> (unit normal, area)."""
    a, b = ring, np.roll(ring, -1, 0)
    n = np.array([((a[:, 1] - b[:, 1]) * (a[:, 2] + b[:, 2])).sum(), ((a[:, 2] - b[:, 2]) * (a[:, 0] + b[:, 0])).sum(),
                  ((a[:, 0] - b[:, 0]) * (a[:, 1] + b[:, 1])).sum()]) / 2
    size = np.linalg.norm(n)
    return (n / size if size > 1e-9 else np.array([0., 0., 1.])), size


def read_build(folder):
    """-> (list of Building, EPSG code, (east, north) of the frame's origin). Coordinates are local to the origin."""
    features, epsg = [], None
    for path in sorted(glob.glob(os.path.join(folder, "cityjson", "*.city.jsonl"))):
        with open(path) as f:
            head = json.loads(f.readline())
            epsg = int(head["metadata"]["referenceSystem"].rsplit("/", 1)[1])
            scale, move = np.array(head["transform"]["scale"]), np.array(head["transform"]["translate"])
            for line in f:
                o = json.loads(line)
                features.append((o, np.array(o["vertices"]) * scale + move))
    if not features:
        raise SystemExit(f"{folder}: no CityJSON (build with --formats cityjson --lod 2)")
    origin = np.floor(min(v[:, 0].min() for _, v in features if len(v))), np.floor(min(v[:, 1].min() for _, v in features if len(v)))
    buildings = []
    for o, vertices in features:
        local = vertices - np.array([origin[0], origin[1], 0]) if len(vertices) else vertices
        root = o["CityObjects"][o["id"]]
        b = Building(o["id"], root.get("attributes", {}))
        solid = 0
        for part in o["CityObjects"].values():
            for g in part.get("geometry", []):
                if g["type"] != "Solid" or str(g["lod"]) != "2":
                    continue
                for shell, values in zip(g["boundaries"], g["semantics"]["values"]):
                    for rings, value in zip(shell, values):
                        kind = g["semantics"]["surfaces"][value]["type"].replace("Surface", "") if value is not None else "Wall"
                        points = [local[r] for r in rings]
                        normal, area = newell(points[0])
                        if area > 1e-4:
                            b.faces.append(Face(points, normal, kind, solid))
                solid += 1
        if b.faces:
            buildings.append(b)
    buildings.sort(key=lambda b: b.id)
    return buildings, epsg, origin


def plan(face):
    """Area of a face in plan, m2."""
    return abs(sum(newell(r)[1] * abs(newell(r)[0][2]) * (1 if i == 0 else -1) for i, r in enumerate(face.rings)))


def centre(faces):
    """(2,) centroid in plan of ground faces, weighted by area."""
    total, sums = 0.0, np.zeros(2)
    for f in faces:
        for i, r in enumerate(f.rings):
            a, b = r[:, :2], np.roll(r[:, :2], -1, 0)
            cross = a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]
            area = abs(cross.sum() / 2)
            if area < 1e-9:
                continue
            c = ((a + b) * cross[:, None]).sum(0) / (6 * cross.sum() / 2)
            sign = 1 if i == 0 else -1
            total += sign * area
            sums += sign * area * c
    return sums / total if total else faces[0].rings[0][:, :2].mean(0)


def pitch(face):
    return math.degrees(math.acos(min(1.0, abs(face.normal[2]))))


def roof_truth(b):
    """(form, ridge azimuth or None, number of planes): flat under 5 degrees on nearly all, pitched over 12 degrees on most of the
    roof with two planes or more; single planes ("skillion") and what lies between ("unclear") are forms that are not judged.
    The ridge: the horizontal convex edges between two planes that lie within 1.5 m of the top, longest direction."""
    roofs = [f for f in b.faces if f.kind == "Roof"]
    areas = np.array([plan(f) for f in roofs])
    if not len(roofs) or areas.sum() < 1:
        return "unclear", None, 0
    pitches = np.array([pitch(f) for f in roofs])
    steep, level = areas[pitches > 12].sum() / areas.sum(), areas[pitches < 5].sum() / areas.sum()
    directions = {(round(math.degrees(math.atan2(f.normal[0], f.normal[1])) / 20) % 18) for f, p, a in zip(roofs, pitches, areas) if p > 12 and a > 1}
    form = "flat" if level > .9 else "pitched" if steep > .7 and len(directions) > 1 else "skillion" if steep > .7 else "unclear"
    if form != "pitched":
        return form, None, len(directions)
    edges = {}
    for i, f in enumerate(roofs):
        for r in f.rings:
            for p, q in zip(r, np.roll(r, -1, 0)):
                key = tuple(sorted([tuple(np.round(p, 2)), tuple(np.round(q, 2))]))
                edges.setdefault(key, []).append(i)
    top = max(r[:, 2].max() for f in roofs for r in f.rings)
    length = {}
    for (p, q), sides in edges.items():
        if len(sides) != 2:
            continue
        p, q = np.array(p), np.array(q)
        d = np.hypot(q[0] - p[0], q[1] - p[1])
        if d < .5 or abs(q[2] - p[2]) > .08 * d or max(p[2], q[2]) < top - 1.5:
            continue
        f, g = roofs[sides[0]], roofs[sides[1]]
        if pitch(f) < 8 and pitch(g) < 8:
            continue
        middle = (p + q) / 2
        if (centre3(g) - middle) @ f.normal > -1e-3:
            continue  # a valley
        a = math.degrees(math.atan2(q[0] - p[0], q[1] - p[1])) % 180
        length[a] = length.get(a, 0) + d
    if not length:
        return form, None, len(directions)
    best = max(length, key=lambda a: sum(l for o, l in length.items() if abs((o - a + 90) % 180 - 90) < 5))
    total = sum(length.values())
    near = {o: l for o, l in length.items() if abs((o - best + 90) % 180 - 90) < 5}
    if sum(near.values()) < .7 * total:
        return form, None, len(directions)  # two ridges of like length: no one direction
    turn = sum(((o - best + 90) % 180 - 90) * l for o, l in near.items()) / sum(near.values())
    return form, (best + turn) % 180, len(directions)


def centre3(face):
    return face.rings[0].mean(0)
