"""What the tests of regions share: a map that is edited, and words for what a region must be."""
import copy
import gzip
import os
import shutil

from blockrand_run import BuildTest, blockrand
from osm_files import STAMP, Node, Relation, Way, write_xml


def kind(o):
    return {Node: 'node', Way: 'way', Relation: 'relation'}[type(o)]


def key(o):
    return (('node', 'way', 'relation').index(kind(o)), o.id)


def body(o):
    """The XML of an object, as change files have it."""
    from xml.sax.saxutils import quoteattr
    common = f'id="{o.id}" version="{o.version}" timestamp="{STAMP}"'
    tags = ''.join(f'<tag k={quoteattr(k)} v={quoteattr(v)}/>' for k, v in o.tags.items())
    if isinstance(o, Node):
        return f'<node {common} lat="{o.lat:.7f}" lon="{o.lon:.7f}">{tags}</node>'
    if isinstance(o, Way):
        return f'<way {common}>' + ''.join(f'<nd ref="{r}"/>' for r in o.refs) + tags + '</way>'
    return f'<relation {common}>' + ''.join(f'<member type="{k}" ref="{i}" role={quoteattr(r)}/>' for k, i, r in o.members) + tags + '</relation>'


class Map:
    """A map that is edited: what an editor did as a change file, and the state after it as a file."""

    def __init__(self, objects):
        self.objects = {key(o): o for o in objects}
        self.changes = []

    def put(self, o):
        old = self.objects.get(key(o))
        o.version = old.version + 1 if old else 1
        self.objects[key(o)] = o
        self.changes.append(('modify' if old else 'create', copy.deepcopy(o)))

    def delete(self, o):
        self.objects.pop(key(o))
        gone = copy.deepcopy(o)
        gone.version += 1
        self.changes.append(('delete', gone))

    def edit(self, o, **values):
        o = copy.deepcopy(o)
        for name, value in values.items():
            setattr(o, name, value)
        self.put(o)

    def write_changes(self, path):
        text = '<osmChange version="0.6">\n' + ''.join(f'<{what}>{body(o)}</{what}>\n' for what, o in self.changes) + '</osmChange>\n'
        self.changes = []
        with (gzip.open if path.endswith('.gz') else open)(path, 'wb') as f:
            f.write(text.encode())
        return path

    def write(self, path):
        return write_xml(path, [self.objects[k] for k in sorted(self.objects)])

    def clipped(self, inside):
        """The map of what lies in a polygon: nodes in it, ways that have one of these with all of their nodes, multipolygons of these whole."""
        objects = {k: o for k, o in self.objects.items() if k[0] == 0 and inside(o.lon, o.lat)}
        ways = {k for k, o in self.objects.items() if k[0] == 1 and any((0, r) in objects for r in o.refs)}
        for k, o in self.objects.items():
            members = {({'node': 0, 'way': 1, 'relation': 2}[m], i) for m, i, _ in o.members} if k[0] == 2 else set()
            if members & (ways | objects.keys()):
                objects[k] = o
                ways |= {m for m in members if m[0] == 1 and m in self.objects}
        for k in ways:
            objects[k] = self.objects[k]
            objects.update({(0, r): self.objects[(0, r)] for r in self.objects[k].refs if (0, r) in self.objects})
        return Map(objects.values())

    def ways(self, tag):
        return [o for k, o in sorted(self.objects.items()) if k[0] == 1 and tag in o.tags]

    def random_edits(self, rng, count):
        for _ in range(count):
            buildings, streets = self.ways('building'), self.ways('highway')
            what = rng.choice(['move', 'move', 'delete', 'retag', 'retag', 'split', 'relation', 'street', 'drag', 'vandal'])
            b = rng.choice(buildings)
            corners = [self.objects[(0, r)] for r in dict.fromkeys(b.refs) if (0, r) in self.objects]
            if what == 'move':
                dx, dy = rng.uniform(-3e-5, 3e-5), rng.uniform(-3e-5, 3e-5)
                for n in corners:
                    self.edit(n, lon=n.lon + dx, lat=n.lat + dy)
            elif what == 'drag' and corners:
                n = rng.choice(corners)
                self.edit(n, lon=n.lon + rng.uniform(-4e-5, 4e-5))
            elif what == 'delete':
                self.delete(b)
            elif what == 'retag':
                tags = dict(b.tags, **rng.choice([{'building:levels': str(rng.randrange(1, 9))}, {'roof:shape': rng.choice(['flat', 'gabled', 'hipped'])},
                                                  {'roof:shape': 'hipped', 'blockrand:roof_pitches': rng.choice(['street 60, yard 30', 'north 25', 'front 9'])},
                                                  {'start_date': str(rng.randrange(1850, 2020))}, {'heritage': '4'}, {'building': 'garage'}, {'height': 'tall'}]))
                self.edit(b, tags=tags)
            elif what == 'split' and len(corners) >= 4:
                last = max(k[1] for k in self.objects if k[0] == 1) + 1
                refs = [n.id for n in corners]
                self.put(Way(last, refs[:3] + refs[:1], {'building': 'yes'}))
                self.edit(b, refs=refs[2:] + refs[:1] + refs[2:3])
            elif what == 'relation' and len(buildings) > 1:
                last = max([k[1] for k in self.objects if k[0] == 2] + [0]) + 1
                other = rng.choice(buildings)
                self.put(Relation(last, [('way', b.id, 'outer')] + ([('way', other.id, 'outer')] if other.id != b.id else []),
                                  {'type': 'multipolygon', 'building': 'yes'}))
            elif what == 'street' and streets:
                s = rng.choice(streets)
                n = self.objects.get((0, rng.choice(s.refs)))
                if n:
                    self.edit(n, lon=n.lon + rng.uniform(-1e-4, 1e-4))
            elif what == 'vandal':
                self.edit(b, tags=dict(b.tags, height='9999', **{'building:levels': '-3'}))


LIMITS_OFF = '[gates]\nmax_lost = 1000\nmax_added = 1000\nmax_simpler = 1000\nmax_height_change = 1000000\n'


class RegionTest(BuildTest):
    def region(self, name, settings=LIMITS_OFF):
        """A region with its region.toml; of LoD 2 where that does not say another one."""
        if 'lod = ' not in settings:
            settings = settings.replace('[build]\n', '[build]\nlod = 2\n', 1) if '[build]\n' in settings else '[build]\nlod = 2\n' + settings
        folder = self.path(name)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        with open(os.path.join(folder, 'region.toml'), 'w', encoding='utf-8') as f:
            f.write(settings)
        return folder

    def update(self, folder, *arguments, code=0, **how):
        run = blockrand('update', folder, *arguments, '--progress', 'none', **how)
        self.assertEqual(run.code, code, run)
        return run

    def current(self, folder):
        return os.path.realpath(os.path.join(folder, 'current'))

    def stands(self, folder, build):
        """What is published is this build, whole."""
        self.assertEqual(self.current(folder), os.path.realpath(os.path.join(folder, 'builds', build)))
        self.hashes_match(self.current(folder))

    def clean(self, map_, folder, *options):
        """A build of the map's state as a file that bears the region's name."""
        name = os.path.basename(folder)
        os.makedirs(self.path('clean'), exist_ok=True)
        source = map_.write(self.path('clean', name + '.osm'))
        return self.build(source, os.path.join('clean', name + '.out'), '--force', '--allow-shrink', '100', *options)
