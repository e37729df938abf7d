#!/usr/bin/env python3
"""A region as large as one likes: copies of an extract side by side, ids and places shifted.

    python3 tests/bench/region/many_copies.py EXTRACT.osm.pbf COPIES OUT.osm.pbf [--columns 5] [--east 0.75] [--north 0.4]

Copy k lies k % columns steps east and k // columns steps north, in degrees; its ids are higher by k * 10^11. The result is sorted by
type and id. Needs osmium-tool.
"""
import argparse
import re
import subprocess

STEP = 10 ** 11
NODE = re.compile(r'^n(\d+)(.*) x([-\d.]+) y([-\d.]+)$')
REF = re.compile(r'([nwr])(\d+)')


def shifted(line, k, dx, dy):
    line = line.rstrip('\n')
    if line[0] == 'n':
        found = NODE.match(line)
        if not found:
            return line + '\n'
        number, rest, x, y = found.groups()
        return f'n{int(number) + k * STEP}{rest} x{float(x) + dx:.7f} y{float(y) + dy:.7f}\n'
    head, space, rest = line.partition(' ')
    # Refs are the last field: Nn1,n2 or Mw1@role,n2@.
    before, last = rest.rsplit(' ', 1)
    mark, list_ = last[0], last[1:]
    if mark in 'NM' and list_:
        items = []
        for item in list_.split(','):
            ref, at, role = item.partition('@')
            items.append(ref[0] + str(int(ref[1:]) + k * STEP) + at + role)
        last = mark + ','.join(items)
    return f'{head[0]}{int(head[1:]) + k * STEP} {before} {last}\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('extract')
    parser.add_argument('copies', type=int)
    parser.add_argument('out')
    parser.add_argument('--columns', type=int, default=5)
    parser.add_argument('--east', type=float, default=0.75)
    parser.add_argument('--north', type=float, default=0.4)
    o = parser.parse_args()
    writer = subprocess.Popen(['osmium', 'cat', '-F', 'opl', '-', '-o', o.out, '-O'], stdin=subprocess.PIPE, text=True)
    for type_ in ('node', 'way', 'relation'):
        for k in range(o.copies):
            dx, dy = (k % o.columns) * o.east, (k // o.columns) * o.north
            reader = subprocess.Popen(['osmium', 'cat', o.extract, '-t', type_, '-f', 'opl', '-o', '-'], stdout=subprocess.PIPE, text=True)
            for line in reader.stdout:
                writer.stdin.write(line if k == 0 else shifted(line, k, dx, dy))
            if reader.wait():
                raise SystemExit('osmium cannot read the extract')
    writer.stdin.close()
    if writer.wait():
        raise SystemExit('osmium cannot write the result')


main()
