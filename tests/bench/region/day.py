#!/usr/bin/env python3
"""A day's changes as mappers make them: a few places, in each some houses next to each other.

    python3 tests/bench/region/day.py EXTRACT OUT.osc.gz [--share 0.0005] [--each 10] [--scattered] [--seed 1]

Of the buildings `--share` is touched: half get another number of storeys, a quarter are moved by a corner, an eighth are deleted, an
eighth are drawn anew beside. Needs osmium-tool. --scattered: single houses everywhere (harder than any real day).
"""
import argparse
import gzip
import random
import subprocess

parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
parser.add_argument('extract')
parser.add_argument('out')
parser.add_argument('--share', type=float, default=0.0005)
parser.add_argument('--count', type=int, help='of buildings, instead of --share')
parser.add_argument('--each', type=int, default=10, help='houses of a place')
parser.add_argument('--scattered', action='store_true')
parser.add_argument('--seed', type=int, default=1)
options = parser.parse_args()
rng = random.Random(options.seed)

ways, nodes = [], {}
with subprocess.Popen(['osmium', 'cat', options.extract, '-f', 'opl', '-o', '-'], stdout=subprocess.PIPE, text=True) as cat:
    for line in cat.stdout:
        if line[0] == 'n':
            parts = line.split(' ')
            fields = {p[0]: p[1:] for p in parts}
            if fields.get('x'):
                nodes[int(parts[0][1:])] = (int(fields['v'] or 1), float(fields['x']), float(fields['y'].strip()), fields.get('T', '').strip())
        elif line[0] == 'w' and ('Tbuilding=' in line or ',building=' in line):
            parts = line.rstrip('\n').split(' ')
            fields = {p[0]: p[1:] for p in parts}
            refs = [int(r[1:].split('x')[0]) for r in fields['N'].split(',')]
            tags = dict(t.split('=', 1) for t in fields['T'].split(',') if '=' in t)
            ways.append((int(parts[0][1:]), int(fields['v'] or 1), refs, tags))
ways = [w for w in ways if all(r in nodes for r in w[2]) and w[2][0] == w[2][-1]]
count = options.count or max(1, round(options.share * len(ways)))
chosen = []
if options.scattered:
    chosen = rng.sample(ways, count)
else:
    place = {w[0]: nodes[w[2][0]][1:3] for w in ways}
    taken = set()
    while len(chosen) < count:
        x, y = place[rng.choice(ways)[0]]
        near = sorted((w for w in ways if w[0] not in taken and abs(place[w[0]][0] - x) < 0.01 and abs(place[w[0]][1] - y) < 0.006),
                      key=lambda w: (place[w[0]][0] - x) ** 2 * 0.4 + (place[w[0]][1] - y) ** 2)
        for w in near[:min(options.each, count - len(chosen))]:
            taken.add(w[0])
            chosen.append(w)

def unescaped(text):
    out, rest = '', text
    while '%' in rest:
        before, code, rest = rest.split('%', 2)
        out += before + chr(int(code, 16))
    return out + rest


def quoted(text):
    for a, b in (('&', '&amp;'), ('<', '&lt;'), ('"', '&quot;')):
        text = text.replace(a, b)
    return text


def xml_tags(tags):
    return ''.join(f'<tag k="{quoted(unescaped(k))}" v="{quoted(unescaped(v))}"/>' for k, v in tags.items())


# Ids of its own for each seed: days that follow each other must not move what the one before made.
STAMP, out, next_id = '2030-01-01T00:00:00Z', [], 9_000_000_000 + 1_000_000 * options.seed
for index, (way, version, refs, tags) in enumerate(chosen):
    body = ''.join(f'<nd ref="{r}"/>' for r in refs)
    kind = index % 8
    if kind < 4:
        more = dict(tags, **{'building:levels': str(rng.randrange(1, 8))})
        out.append(f'<modify><way id="{way}" version="{version + 1}" timestamp="{STAMP}">{body}{xml_tags(more)}</way></modify>')
    elif kind < 6:
        v, x, y, t = nodes[refs[0]]
        words = dict(p.split('=', 1) for p in t.split(',') if '=' in p)
        out.append(f'<modify><node id="{refs[0]}" version="{v + 1}" timestamp="{STAMP}" lon="{x + rng.uniform(-1e-5, 1e-5):.7f}" lat="{y:.7f}">{xml_tags(words)}</node></modify>')
    elif kind == 6:
        out.append(f'<delete><way id="{way}" version="{version + 1}" timestamp="{STAMP}"/></delete>')
    else:
        fresh = []
        for r in refs[:-1]:
            _, x, y, _ = nodes[r]
            fresh.append(next_id)
            out.append(f'<create><node id="{next_id}" version="1" timestamp="{STAMP}" lon="{x + 3e-4:.7f}" lat="{y + 1e-4:.7f}"/></create>')
            next_id += 1
        body = ''.join(f'<nd ref="{r}"/>' for r in fresh + fresh[:1])
        out.append(f'<create><way id="{next_id}" version="1" timestamp="{STAMP}">{body}<tag k="building" v="yes"/></way></create>')
        next_id += 1
order = {'<create><node': 0, '<modify><node': 1}
out.sort(key=lambda o: order.get(o.split(' ')[0], 2))
with gzip.open(options.out, 'wt') as f:
    f.write('<osmChange version="0.6">\n' + '\n'.join(out) + '\n</osmChange>\n')
print(f'{count} of {len(ways)} buildings touched')
