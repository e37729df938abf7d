#!/usr/bin/env python3
"""Writes the footprints of a survey without map data as bare OSM: outlines, start_date and height, no streets.

    reference_osm.py ../shared/data/reference/vichy/vichy-eubucco-v0.1.gpkg OUT.osm      # needs gdal-bin
"""
import json
import subprocess
import sys


def main():
    source, out = sys.argv[1:3]
    text = subprocess.run(["ogr2ogr", "-f", "GeoJSONSeq", "-t_srs", "EPSG:4326", "/vsistdout/", source], check=True, capture_output=True).stdout
    nodes, ways = {}, []
    for line in text.decode().split("\n"):
        line = line.strip("\x1e \r")
        if not line:
            continue
        f = json.loads(line)
        polygons = [f["geometry"]["coordinates"]] if f["geometry"]["type"] == "Polygon" else f["geometry"]["coordinates"]
        ring = [(round(x, 7), round(y, 7)) for x, y in polygons[0][0]]  # outer rings alone: courtyards are small here
        tags = {"building": "yes"}
        if f["properties"].get("age"):
            tags["start_date"] = str(int(f["properties"]["age"]))
        if f["properties"].get("height"):
            tags["height"] = "%.1f" % f["properties"]["height"]
        ways.append(([nodes.setdefault(p, len(nodes) + 1) for p in ring], tags))
    with open(out, "w") as o:
        o.write('<?xml version="1.0"?>\n<osm version="0.6">\n')
        for (x, y), i in nodes.items():
            o.write(f'<node id="{i}" lat="{y}" lon="{x}" version="1"/>\n')
        for i, (refs, tags) in enumerate(ways, 1):
            o.write(f'<way id="{i}" version="1">' + "".join(f'<nd ref="{r}"/>' for r in refs)
                    + "".join(f'<tag k="{k}" v="{v}"/>' for k, v in tags.items()) + "</way>\n")
        o.write("</osm>\n")


if __name__ == "__main__":
    main()
