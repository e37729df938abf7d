#!/usr/bin/env python3
"""Heights of houses of which nothing is tagged, against surveys of five places.

    heights.py --program build/release/blockrand --shared ../shared --work DIR > table.md

Berlin and Ingolstadt: the survey's buildings are matched with those of OpenStreetMap by `blockrand compare` (one to one, more than
half in common); houses with a tagged height or tagged storeys are left out. The Hague, two places of North Rhine-Westphalia and Vichy
have no OpenStreetMap: their footprints are written as bare OSM (no streets, no tags), so that all of it is inferred.

Ridge: the highest point above the building's own ground, in m. Vichy's heights (EUBUCCO v0.1 from IGN BD TOPO, attribute HAUTEUR: from the
ground to the gutter) are compared with our eaves. The constant is the one with the least mean error in the four other places, each place one
vote. Needs python3-numpy, gdal-bin.
"""
import argparse
import csv
import glob
import json
import os
import subprocess
import xml.etree.ElementTree as ElementTree

import numpy as np

GROUPS = ((0, 10), (10, 20), (20, 1000))  # m, of our height
LEAST = 30  # houses of a group whose bias counts
BERLIN = "13.335,52.49,13.425,52.535"  # around the survey's six sheets


def lon_lat(points, crs):
    """[(x, y)] in degrees."""
    text = "".join(f"{x} {y}\n" for x, y in points)
    run = subprocess.run(["gdaltransform", "-s_srs", crs, "-t_srs", "OGC:CRS84", "-output_xy"], input=text, capture_output=True, text=True, check=True)
    return [tuple(map(float, line.split()[:2])) for line in run.stdout.splitlines()]


def citygml(path):
    """[(outer ring of the ground, height)] of each building."""
    out = []
    for building in ElementTree.parse(path).getroot().iter():
        if not building.tag.endswith("}Building"):
            continue
        rings = []
        for p in building.iter():
            if p.tag.endswith("}posList") and p.text:
                v = np.array([float(x) for x in p.text.split()])
                if len(v) % 3 == 0 and len(v) >= 12:
                    rings.append(v.reshape(-1, 3))
        if not rings:
            continue
        low, high = min(r[:, 2].min() for r in rings), max(r[:, 2].max() for r in rings)
        flat = [r for r in rings if r[:, 2].max() < low + 0.05]
        if flat:
            out.append(([tuple(p) for p in max(flat, key=area)[:, :2]], high - low))
    return out


def area(ring):
    x, y = ring[:, 0] - ring[0, 0], ring[:, 1] - ring[0, 1]
    return abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))) / 2


def cityjson(path):
    with open(path) as f:
        city = json.load(f)
    scale, shift = np.array(city["transform"]["scale"]), np.array(city["transform"]["translate"])
    vertices = np.array(city["vertices"]) * scale + shift
    out = []
    for c in city["CityObjects"].values():
        height = c.get("attributes", {}).get("RelativeRidgeHeight")
        for g in c.get("geometry", []) if height else []:
            shells = g["boundaries"] if g["type"] == "Solid" else [g["boundaries"]]
            faces = [vertices[f[0]] for shell in shells for f in shell]
            low = min(f[:, 2].min() for f in faces)
            flat = [f for f in faces if f[:, 2].max() < low + 0.05]
            if flat:
                out.append(([tuple(p) for p in max(flat, key=area)[:, :2]], float(height)))
    return out


def vichy(path):
    text = subprocess.run(["ogr2ogr", "-f", "GeoJSONSeq", "-t_srs", "EPSG:4326", "/vsistdout/", path], check=True, capture_output=True).stdout
    out = []
    for line in text.decode().split("\n"):
        line = line.strip("\x1e \r")
        if line:
            f = json.loads(line)
            polygons = [f["geometry"]["coordinates"]] if f["geometry"]["type"] == "Polygon" else f["geometry"]["coordinates"]
            out.append(([tuple(p) for p in polygons[0][0]], f["properties"].get("height") or None))
    return out


def write_osm(path, buildings):
    """Way i + 1 is building i."""
    nodes, ways = {}, []
    for ring, _ in buildings:
        refs = [nodes.setdefault((round(x, 7), round(y, 7)), len(nodes) + 1) for x, y in ring]
        ways.append(refs if refs[0] == refs[-1] else refs + refs[:1])
    with open(path, "w") as o:
        o.write('<?xml version="1.0"?>\n<osm version="0.6">\n')
        o.writelines(f'<node id="{i}" lat="{y}" lon="{x}" version="1"/>\n' for (x, y), i in nodes.items())
        for i, refs in enumerate(ways, 1):
            o.write(f'<way id="{i}" version="1">' + "".join(f'<nd ref="{r}"/>' for r in refs) + '<tag k="building" v="yes"/></way>\n')
        o.write("</osm>\n")


def build(a, source, out, *options):
    """{id: attributes} of the buildings."""
    subprocess.run([a.program, "build", source, "-o", out, "--lod", "2", "--formats", "cityjson", "--no-report", "--force", "--progress", "none", *options],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    found = {}
    for path in glob.glob(os.path.join(out, "cityjson", "*.jsonl")):
        with open(path) as f:
            for line in f:
                for key, c in json.loads(line).get("CityObjects", {}).items():
                    if c["type"] == "Building":
                        found[key] = c["attributes"]
    return found


def bare(a, name, buildings, what="height"):
    """(ours, theirs) of houses. what: attribute"""
    source = os.path.join(a.work, name + ".osm")
    write_osm(source, buildings)
    ours = build(a, source, os.path.join(a.work, name))
    pairs = [(ours[f"w{i}"], h) for i, (_, h) in enumerate(buildings, 1) if h and f"w{i}" in ours]
    return np.array([(o[what], h) for o, h in pairs if o[what] is not None]).T


def matched(a, name, extract, reference, *options):
    out = os.path.join(a.work, name)
    ours = build(a, os.path.join(a.shared, "data/osm", extract), out, *options)
    subprocess.run([a.program, "compare", out, reference, "-o", out + ".compare", "--force", "--progress", "none"], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    rows = []
    with open(os.path.join(out + ".compare", "compare.csv"), newline="", encoding="utf-8-sig") as f:
        for r in csv.DictReader(f):
            o = ours.get(r["model_buildings"])
            if o is None or " " in r["reference_buildings"] or not r["ridge_error"] or float(r["footprint_iou"] or 0) <= 0.5:
                continue
            if "tag" in (o.get("height_source"), o.get("storeys_source"), o.get("eaves_height_source")):
                continue
            rows.append((o["height"], o["height"] - float(r["ridge_error"])))
    return np.array(rows).T


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--program", required=True)
    arguments.add_argument("--shared", required=True)
    arguments.add_argument("--work", required=True)
    a = arguments.parse_args()
    os.makedirs(a.work, exist_ok=True)
    reference = os.path.join(a.shared, "data/reference")

    def degrees(buildings, crs):
        flat = lon_lat([p for ring, _ in buildings for p in ring], crs)
        out = []
        for ring, h in buildings:
            out.append((flat[:len(ring)], h))
            flat = flat[len(ring):]
        return out
    nrw = [b for path in sorted(glob.glob(os.path.join(reference, "nrw-lod2/*.gml"))) for b in citygml(path)]
    places = {
        "Berlin": matched(a, "berlin", "berlin-2014-06.osm.pbf", os.path.join(reference, "berlin-lod2"), "--bbox", BERLIN),
        "Ingolstadt": matched(a, "ingolstadt", "ingolstadt-altstadt.osm", os.path.join(reference, "ingolstadt-lod3")),
        "The Hague": bare(a, "hague", degrees(cityjson(os.path.join(reference, "cityjson/DenHaag_01.json")), "EPSG:28992")),
        "NRW": bare(a, "nrw", degrees(nrw, "EPSG:25832")),
        "Vichy": bare(a, "vichy", vichy(os.path.join(reference, "vichy/vichy-eubucco-v0.1.gpkg")), "eaves_height")}
    print("| survey | houses | MAE ours | best constant of the others | its MAE | ratio | bias | " +
          " | ".join(f"bias where ours is {low} to {high} m (n)" if high < 1000 else f"bias where ours is {low} m and more (n)" for low, high in GROUPS)
          + " | correlation | spread, ours : theirs |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for name, (ours, theirs) in places.items():
        constants = np.arange(3, 30, 0.25)
        errors = [np.mean([np.abs(t - c).mean() for other, (_, t) in places.items() if other != name]) for c in constants]
        best = constants[int(np.argmin(errors))]
        mae, usual = np.abs(ours - theirs).mean(), np.abs(best - theirs).mean()
        cells = []
        for low, high in GROUPS:
            group = (ours >= low) & (ours < high)
            cells.append(f"{(ours - theirs)[group].mean():+.1f} ({group.sum()})" if group.sum() >= LEAST else f"({group.sum()})")
        print(f"| {name} | {len(ours)} | {mae:.2f} | {best:.2f} | {usual:.2f} | {mae / usual:.2f} | {(ours - theirs).mean():+.2f} | " + " | ".join(cells)
              + f" | {np.corrcoef(ours, theirs)[0, 1]:.2f} | {ours.std():.1f} : {theirs.std():.1f} |")


if __name__ == "__main__":
    main()
