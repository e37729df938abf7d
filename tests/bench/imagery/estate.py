#!/usr/bin/python3
"""An estate of equal houses at equal distances as an .osm file: where a wrong shift fits nearly as well as the right one.

    estate.py OUT.osm [--seed N]

Rows of houses of 10 x 8 m every 15 m along streets 50 m apart, some with a garage; 288 houses near 52 N, 8.6 E (UTM zone 32).
"""
import argparse

import numpy as np

import osm


def estate(path, seed=1):
    rng = np.random.default_rng([seed, 77])
    back = osm.transformation(25832, 4326)
    x0, y0, turn = 470000.0, 5762000.0, np.radians(12)
    c, s = np.cos(turn), np.sin(turn)
    nodes, ways = [], []

    def way(points, tags, closed=True):
        refs = []
        for x, y in points:
            lon, lat, _ = back.TransformPoint(x0 + c * x - s * y, y0 + s * x + c * y)
            nodes.append((lon, lat))
            refs.append(len(nodes))
        ways.append((refs + refs[:1] if closed else refs, tags))
    for row in range(8):
        y = row * 50.0
        way([(-10, y), (285, y)], {"highway": "residential"}, False)
        for side in (-1, 1):
            for k in range(18):
                x = k * 15.0 + 5
                low = y + side * 12.0
                high = low + side * 8.0
                way([(x, low), (x + 10, low), (x + 10, high), (x, high)], {"building": "house", "building:levels": "2", "roof:shape": "gabled", "roof:levels": "1"})
                if rng.random() < .15:
                    way([(x + 11, low + side), (x + 14, low + side), (x + 14, low + side * 6), (x + 11, low + side * 6)], {"building": "garage"})
    with open(path, "w") as f:
        f.write('<?xml version="1.0" encoding="UTF-8"?>\n<osm version="0.6" generator="estate.py">\n')
        for i, (lon, lat) in enumerate(nodes, 1):
            f.write(f' <node id="{i}" version="1" lat="{lat:.9f}" lon="{lon:.9f}"/>\n')
        for i, (refs, tags) in enumerate(ways, 1):
            f.write(f' <way id="{i}" version="1">' + "".join(f'<nd ref="{r}"/>' for r in refs) + "".join(f'<tag k="{k}" v="{v}"/>' for k, v in tags.items()) + "</way>\n")
        f.write("</osm>\n")


if __name__ == "__main__":
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("output")
    a.add_argument("--seed", type=int, default=1)
    a = a.parse_args()
    estate(a.output, a.seed)
