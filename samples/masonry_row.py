#!/usr/bin/env python3
"""Writes three houses of one plan in a row, apart from each other, on a street: samples/masonry/row.osm.

    samples/masonry_row.py > samples/masonry/row.osm

With samples/masonry/masonry.toml they are laid in brick bond, ashlar and cyclopean stones, and are equal otherwise: way 1, 2, 3.
"""
import math

LAT, LON = 51.47, 11.035  # an open field, as that of make_sample.py
METRES_PER_DEGREE = 111320
WIDTH, DEPTH, APART = 11.0, 9.0, 4.0


def main():
    nodes, ways = [], []

    def node(x, y):
        nodes.append((len(nodes) + 1, LAT + y / METRES_PER_DEGREE,
                      LON + x / (METRES_PER_DEGREE * math.cos(math.radians(LAT)))))
        return len(nodes)

    tags = {'building': 'house', 'building:levels': '2', 'roof:shape': 'gabled', 'roof:height': '3',
            'height': '9.5', 'start_date': '1880', 'building:material': 'stone', 'building:colour': '#b5ab99'}
    for number in range(3):
        x = number * (WIDTH + APART)
        refs = [node(x, 0), node(x + WIDTH, 0), node(x + WIDTH, DEPTH), node(x, DEPTH)]
        ways.append((number + 1, refs + refs[:1], tags))
    ways.append((4, [node(-10, -6), node(3 * (WIDTH + APART) + 6, -6)], {'highway': 'residential', 'name': 'Steinweg'}))
    print("<?xml version='1.0' encoding='UTF-8'?>\n<osm version=\"0.6\" generator=\"masonry_row.py\">")
    for number, lat, lon in nodes:
        print(f'  <node id="{number}" version="1" lat="{lat:.7f}" lon="{lon:.7f}"/>')
    for number, refs, told in ways:
        print(f'  <way id="{number}" version="1">' + ''.join(f'<nd ref="{r}"/>' for r in refs) +
              ''.join(f'<tag k="{k}" v="{v}"/>' for k, v in told.items()) + '</way>')
    print('</osm>')


if __name__ == '__main__':
    main()
