"""Random edits of what stands and lies around houses, for tests that compare what is worked in with what is built anew."""
from osm_files import METRE, Node, Relation, Way
from region_run import Map


class Surroundings(Map):
    """A map whose streets, surfaces, waters, barriers, trees, lines of wires and steps are edited."""

    def next(self, kind):
        return max([k[1] for k in self.objects if k[0] == kind] + [0]) + 1

    def place(self, rng):
        """Somewhere near a house."""
        nodes = [self.objects[(0, r)] for r in rng.choice(self.ways('building')).refs if (0, r) in self.objects]
        n = rng.choice(nodes)
        return n.lon + rng.uniform(-4e-4, 4e-4), n.lat + rng.uniform(-3e-4, 3e-4)

    def node(self, lon, lat, tags=None):
        n = Node(self.next(0), round(lon, 7), round(lat, 7), tags or {})
        self.put(n)
        return n.id

    def polygon(self, rng, tags, size=(10, 60)):
        lon, lat = self.place(rng)
        w, h = rng.uniform(*size) * METRE * 1.6, rng.uniform(*size) * METRE
        refs = [self.node(lon + x * w, lat + y * h) for x, y in ((0, 0), (1, 0.1), (0.9, 1), (-0.1, 0.9))]
        way = Way(self.next(1), refs + refs[:1], tags)
        self.put(way)
        return way

    def line(self, rng, tags, points=3, step=40, of_node=None):
        lon, lat = self.place(rng)
        refs = []
        for _ in range(points):
            refs.append(self.node(lon, lat, of_node))
            lon, lat = lon + rng.uniform(-1.6, 1.6) * step * METRE, lat + rng.uniform(-1, 1) * step * METRE
        way = Way(self.next(1), refs, tags)
        self.put(way)
        return way

    def retag(self, o, **tags):
        tags = {**o.tags, **{k.replace('__', ':'): v for k, v in tags.items()}}
        self.edit(o, tags={k: v for k, v in tags.items() if v})

    def some(self, rng, *tags):
        """A way or node with one of these tags; nothing where there is none."""
        found = [o for k, o in sorted(self.objects.items()) if k[0] < 2 and any(t in o.tags if isinstance(t, str) else o.tags.get(t[0]) == t[1] for t in tags)]
        return rng.choice(found) if found else None

    def move(self, rng, node, by=4e-5):
        self.edit(node, lon=round(node.lon + rng.uniform(-by, by), 7), lat=round(node.lat + rng.uniform(-by, by), 7))

    def move_a_corner(self, rng, way, by=6e-5):
        nodes = [self.objects[(0, r)] for r in way.refs if (0, r) in self.objects]
        if nodes:
            self.move(rng, rng.choice(nodes), by)

    # ---- the edits, by name

    def edit_street(self, rng):
        s = rng.choice(self.ways('highway'))
        self.retag(s, **rng.choice([{'width': str(rng.randrange(3, 14))}, {'lanes': rng.choice('1234')}, {'surface': rng.choice(['asphalt', 'sett', 'gravel', ''])},
                                    {'sidewalk': rng.choice(['both', 'left', 'no'])}, {'highway': rng.choice(['residential', 'primary', 'path', 'service', 'pedestrian'])},
                                    {'parking__both': rng.choice(['lane', 'street_side', '']), 'parking__both__orientation': 'parallel'},
                                    {'cycleway': rng.choice(['track', 'lane', ''])}, {'tunnel': rng.choice(['yes', ''])}, {'oneway': rng.choice(['yes', '-1', ''])}]))

    def edit_street_place(self, rng):
        self.move_a_corner(rng, rng.choice(self.ways('highway')), 1e-4)

    def edit_new_street(self, rng):
        a, b = (rng.choice(self.ways('highway')).refs for _ in range(2))
        refs = [rng.choice(a), self.node(*self.place(rng)), rng.choice(b)]
        self.put(Way(self.next(1), refs, {'highway': rng.choice(['residential', 'footway', 'tertiary'])}))

    def edit_crossing(self, rng):
        n = self.objects.get((0, rng.choice(rng.choice(self.ways('highway')).refs)))
        if n:
            self.retag(n, **rng.choice([{'highway': 'crossing', 'crossing': rng.choice(['zebra', 'marked', 'traffic_signals'])}, {'highway': 'stop'},
                                        {'highway': 'traffic_signals'}, {'highway': 'give_way', 'direction': 'forward'}, {'highway': ''}]))

    def edit_tree(self, rng):
        tree = self.some(rng, ('natural', 'tree'))
        what = rng.choice(['move', 'new', 'gone', 'tags', 'row']) if tree else 'new'
        if what == 'move':
            self.move(rng, tree)
        elif what == 'gone' and not any(tree.id in o.refs for k, o in self.objects.items() if k[0] == 1):
            self.delete(tree)
        elif what == 'tags':
            self.retag(tree, height=str(rng.randrange(4, 25)), leaf_type=rng.choice(['needleleaved', 'broadleaved']))
        elif what == 'row':
            self.line(rng, {'natural': 'tree_row'})
        else:
            self.node(*self.place(rng), {'natural': 'tree'})

    def edit_furniture(self, rng):
        self.node(*self.place(rng), rng.choice([{'highway': 'street_lamp'}, {'amenity': 'bench'}, {'emergency': 'fire_hydrant'}, {'barrier': 'bollard'}, {'traffic_sign': 'DE:274'}]))

    def edit_surface(self, rng):
        old = self.some(rng, 'landuse', 'leisure')
        if old and isinstance(old, Way) and rng.random() < 0.4:
            if rng.random() < 0.5:
                self.move_a_corner(rng, old)
            else:
                self.retag(old, surface=rng.choice(['grass', 'sand', 'asphalt', '']))
        else:
            self.polygon(rng, rng.choice([{'landuse': 'grass'}, {'landuse': 'forest'}, {'leisure': 'playground'}, {'leisure': 'pitch', 'surface': 'clay'},
                                          {'amenity': 'parking'}, {'natural': 'scrub'}, {'landuse': 'allotments'}, {'highway': 'pedestrian', 'area': 'yes'}]))

    def edit_water(self, rng):
        old = self.some(rng, 'natural', 'waterway')
        if old and isinstance(old, Way) and rng.random() < 0.5:
            self.move_a_corner(rng, old, 1e-4)
        elif rng.random() < 0.6:
            self.polygon(rng, rng.choice([{'natural': 'water'}, {'natural': 'water', 'water': 'river'}, {'leisure': 'swimming_pool'}]), (15, 150))
        else:
            self.line(rng, {'waterway': rng.choice(['stream', 'river', 'canal'])}, 4, 80)

    def edit_relation(self, rng):
        outer, inner = (self.polygon(rng, {}, size) for size in ((60, 200), (5, 20)))
        self.put(Relation(self.next(2), [('way', outer.id, 'outer'), ('way', inner.id, 'inner')],
                          {'type': 'multipolygon', **rng.choice([{'landuse': 'grass'}, {'natural': 'water'}, {'landuse': 'forest'}])}))

    def edit_barrier(self, rng):
        old = self.some(rng, 'barrier')
        if old and isinstance(old, Way) and rng.random() < 0.5:
            self.retag(old, height=str(rng.randrange(1, 4)), barrier=rng.choice(['wall', 'fence', 'hedge']))
        else:
            way = self.line(rng, {'barrier': rng.choice(['wall', 'fence', 'hedge', 'retaining_wall'])}, 4)
            if rng.random() < 0.5:
                self.retag(self.objects[(0, way.refs[1])], barrier='gate')

    def edit_wires(self, rng):
        tower = self.some(rng, ('power', 'tower'), ('power', 'pole'))
        if tower and rng.random() < 0.6:
            if rng.random() < 0.5:
                self.move(rng, tower, 3e-4)
            else:
                self.retag(tower, height=str(rng.randrange(9, 60)), power=rng.choice(['tower', 'pole']))
        else:
            kind, support, step = rng.choice([('line', 'tower', 400), ('minor_line', 'pole', 60)])
            self.line(rng, {'power': kind}, 5, step, {'power': support})

    def edit_steps(self, rng):
        old = self.some(rng, ('highway', 'steps'))
        if old and rng.random() < 0.5:
            self.retag(old, step_count=str(rng.randrange(2, 20)), incline=rng.choice(['up', 'down', '']))
        else:
            way = self.line(rng, {'highway': 'steps', 'step_count': str(rng.randrange(3, 15))}, 2, 12)
            house = rng.choice(self.ways('building'))
            self.edit(way, refs=way.refs + [rng.choice(house.refs)])

    def edit_bridge(self, rng):
        old = self.some(rng, 'bridge')
        if old and isinstance(old, Way) and rng.random() < 0.5:
            self.retag(old, layer=rng.choice('123'))
        else:
            s = rng.choice(self.ways('highway'))
            self.retag(s, bridge=rng.choice(['yes', '']), layer='1')

    def edit_rail(self, rng):
        self.line(rng, {'railway': rng.choice(['tram', 'rail'])}, 4, 60)

    def edit_cliff(self, rng):
        self.line(rng, {'natural': 'cliff', 'height': str(rng.randrange(1, 9))}, 4)

    def edit_coast(self, rng):
        self.line(rng, {'natural': 'coastline'}, 3, 500)

    def edit_house(self, rng):
        b = rng.choice(self.ways('building'))
        if rng.random() < 0.3:
            self.delete(b)
        else:
            for r in dict.fromkeys(b.refs):
                if (0, r) in self.objects:
                    n = self.objects[(0, r)]
                    self.edit(n, lon=round(n.lon + 2e-5, 7), lat=round(n.lat - 2e-5, 7))

    def kinds(self):
        return sorted(name for name in dir(self) if name.startswith('edit_'))

    def random_edits(self, rng, count):
        for _ in range(count):
            getattr(self, rng.choice(self.kinds()))(rng)
