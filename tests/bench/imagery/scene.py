"""The scene: faces of buildings with materials, and what lies about them: eaves, copings, chimneys, roof windows, trees, cars, fences."""
import math

import numpy as np

import model
from ground import ASPHALT, MARKING, WATER, along
from parameters import MATERIALS
from raster import fill

TILE, SHEET, BITUMEN, GRAVEL, WALL, PLAIN, TREE, GLASS = range(1, 9)
TEXTURE = {"tile": TILE, "sheet": SHEET, "bitumen": BITUMEN, "gravel": GRAVEL}
WALLS = [(222, 214, 196), (206, 196, 176), (196, 190, 180), (214, 196, 150), (200, 168, 140), (232, 230, 222), (150, 96, 76), (182, 176, 164)]
CARS = [(225, 225, 225), (170, 172, 176), (36, 38, 42), (60, 62, 66), (110, 112, 118), (130, 32, 32), (40, 60, 110), (200, 190, 160)]


class Scene:
    """Polygons with material. Arrays by item: normal, albedo (linear 0..1), kind, building (-1: none), roof flag, u axis, origin."""

    def __init__(self):
        self.rings, self.normal, self.albedo, self.kind, self.building, self.roof = [], [], [], [], [], []
        self.u, self.origin, self.blobs, self.rand = [], [], [], []

    def add(self, rings, normal, albedo, kind, building=-1, roof=False, u=None, rand=0.5):
        self.rings.append(rings)
        self.normal.append(normal)
        self.albedo.append(albedo)
        self.kind.append(kind)
        self.building.append(building)
        self.roof.append(roof)
        self.u.append(u if u is not None else (1., 0., 0.))
        self.origin.append(rings[0][0] if rings else (0, 0, 0))
        self.rand.append(rand)
        return len(self.rings) - 1

    def face(self, points, albedo, kind, building=-1, roof=False, rand=0.5):
        p = np.asarray(points, float)
        normal, area = model.newell(p)
        if area < 1e-4:
            return
        if normal[2] < 0:
            normal, p = -normal, p[::-1]
        self.add([p], normal, albedo, kind, building, roof, level_axis(normal), rand)

    def box(self, middle, u, length, width, low, high, albedo, kind=PLAIN, building=-1, top=None):
        """Upright box about (x, y), long side along the unit vector u; top: albedo of the lid."""
        m, u = np.asarray(middle, float), np.asarray(u, float)
        v = np.array([-u[1], u[0]])
        c = [m + u * length / 2 * a + v * width / 2 * b for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        for a, b in zip(c, c[1:] + c[:1]):
            wall = np.array([[*a, low], [*b, low], [*b, high], [*a, high]])
            n, _ = model.newell(wall)
            self.add([wall], n, albedo, kind, building, False, level_axis(n))
        self.add([np.array([[*p, high] for p in c])], np.array([0., 0., 1.]), albedo if top is None else top, kind, building, False, (u[0], u[1], 0.))

    def blob(self, centre, radius, high, albedo):
        item = self.add([], (0., 0., 1.), albedo, TREE)
        self.blobs.append((item, np.asarray(centre, float), radius, high))

    def arrays(self):
        for name in ("normal", "albedo", "u"):
            setattr(self, name, np.array(getattr(self, name), np.float32).reshape(-1, 3))
        self.origin = np.array(self.origin, np.float32).reshape(-1, 3)
        self.kind, self.building = np.array(self.kind, np.uint8), np.array(self.building, np.int32)
        self.roof, self.rand = np.array(self.roof, bool), np.array(self.rand, np.float32)
        self.centre, self.radius = np.zeros((len(self.kind), 3), np.float32), np.ones((len(self.kind), 2), np.float32)
        for item, c, r, h in self.blobs:
            self.centre[item], self.radius[item] = c, (r, h)


def linear(rgb):
    """sRGB 0..255 -> linear 0..1."""
    c = np.asarray(rgb, float) / 255
    return np.where(c <= .04045, c / 12.92, ((c + .055) / 1.055)**2.4)


def level_axis(n):
    """Unit vector along the horizontal lines of a plane."""
    d = math.hypot(n[0], n[1])
    return (1., 0., 0.) if d < 1e-3 else (-n[1] / d, n[0] / d, 0.)


def jitter(rng, rgb, amount=.06):
    return linear(np.clip(np.asarray(rgb, float) * rng.normal(1, amount) * rng.normal(1, amount / 3, 3), 4, 250))


class Occupancy:
    """Which building stands where: (rows, columns) int32 at 0.25 m, -1 for none; and heights for the sky's share."""

    def __init__(self, buildings, west, north, width, height):
        self.west, self.north, self.size = west, north, .25
        self.mask = np.full((int(height / .25), int(width / .25)), -1, np.int32)
        self.height = np.zeros(self.mask.shape, np.float32)
        for i, b in enumerate(buildings):
            top = float(np.mean([r[:, 2].max() for f in b.faces if f.kind == "Roof" for r in f.rings] or [3]))
            for f in b.faces:
                if f.kind == "Ground":
                    found = fill([self.pixels(r[:, :2]) for r in f.rings], self.mask.shape[1], self.mask.shape[0])
                    if found:
                        r0, c0, m = found
                        self.mask[r0:r0 + m.shape[0], c0:c0 + m.shape[1]][m] = i
                        part = self.height[r0:r0 + m.shape[0], c0:c0 + m.shape[1]]
                        part[m] = np.maximum(part[m], top)

    def pixels(self, xy):
        return np.column_stack([(xy[:, 0] - self.west) / self.size, (self.north - xy[:, 1]) / self.size])

    def at(self, x, y):
        c, r = int((x - self.west) / self.size), int((self.north - y) / self.size)
        return self.mask[r, c] if 0 <= r < self.mask.shape[0] and 0 <= c < self.mask.shape[1] else -1

    def free(self, x, y, reach):
        """Is there no building within a square of this half side?"""
        c0, c1 = int((x - reach - self.west) / self.size), int((x + reach - self.west) / self.size) + 1
        r0, r1 = int((self.north - y - reach) / self.size), int((self.north - y + reach) / self.size) + 1
        if c0 < 0 or r0 < 0 or c1 > self.mask.shape[1] or r1 > self.mask.shape[0]:
            return False
        return (self.mask[r0:r1, c0:c1] < 0).all()


def inside(rings, points):
    """Even-odd test in plan: rings of (n, 2 or 3), points (m, 2) -> (m,) bool."""
    out = np.zeros(len(points), bool)
    for r in rings:
        a, b = r[:, None, :2], np.roll(r, -1, 0)[:, None, :2]
        cross = (a[..., 1] > points[:, 1]) != (b[..., 1] > points[:, 1])
        x = a[..., 0] + (points[:, 1] - a[..., 1]) * (b[..., 0] - a[..., 0]) / np.where(a[..., 1] == b[..., 1], 1, b[..., 1] - a[..., 1])
        out ^= (cross & (x > points[:, 0])).sum(0) % 2 == 1
    return out


def add_buildings(scene, buildings, occupancy, p, rng):
    """Solids with materials, eaves and copings, clutter. Returns per building: dict(material, albedo sRGB)."""
    told = []
    for i, b in enumerate(buildings):
        form, _, _ = model.roof_truth(b)
        weights = p["flat" if form in ("flat", "unclear") else "pitched"]
        material = rng.choice(list(weights), p=np.array(list(weights.values())) / sum(weights.values()))
        kind, colours = MATERIALS[material]
        colour = np.clip(np.array(colours[rng.integers(len(colours))]) * rng.normal(1, .06) * rng.normal(1, .02, 3), 10, 245)
        told.append(dict(material=str(material), albedo=[int(round(c)) for c in colour]))
        roof, wall = linear(colour), jitter(rng, WALLS[rng.integers(len(WALLS))])
        overhang = rng.uniform(*p["eaves"]) if form != "flat" else 0
        coping = form in ("flat", "unclear") and rng.random() < p["parapet"]
        rim = jitter(rng, [(190, 188, 182), (150, 150, 150), (112, 104, 96), (205, 204, 200)][rng.integers(4)])
        edges = {}
        for f in b.faces:
            if f.kind == "Ground":
                continue
            if f.kind == "Wall":
                scene.add(f.rings, f.normal, wall, WALL, i, False, level_axis(f.normal), rng.random())
                for r in f.rings:
                    for a, c in zip(r, np.roll(r, -1, 0)):
                        edges[frozenset((tuple(np.round(a, 2)), tuple(np.round(c, 2))))] = f.normal
        roofs = [f for f in b.faces if f.kind == "Roof"]
        for f in roofs:
            if f.normal[2] < .02:
                scene.add(f.rings, f.normal, roof, PLAIN, i)
                continue
            t = TEXTURE[kind]
            axis = level_axis(f.normal)
            if model.pitch(f) < 5 and len(f.rings[0]) > 1:  # sheets and rolls of flat roofs lie along the longest side
                d = np.diff(np.vstack([f.rings[0], f.rings[0][:1]]), axis=0)
                k = d[np.argmax(np.hypot(d[:, 0], d[:, 1]))]
                axis = tuple(np.array([k[0], k[1], 0]) / max(np.hypot(k[0], k[1]), 1e-6))
            tint = rng.normal(1, .025)
            scene.add(f.rings, f.normal, roof * tint, t, i, True, axis, rng.random())
            for r in f.rings:
                for a, c in zip(r, np.roll(r, -1, 0)):
                    n = edges.get(frozenset((tuple(np.round(a, 2)), tuple(np.round(c, 2)))))
                    if n is not None:
                        add_edge(scene, occupancy, f, a, c, n, overhang, coping, roof, rim, t, i)
            add_clutter(scene, f, i, material, roof, p, rng, b)
    return told


def add_edge(scene, occupancy, f, a, c, n, overhang, coping, roof, rim, kind, i):
    """Where roof and wall meet: the roof's plane goes on beyond the wall, or a coping lies on the edge of a flat one."""
    out = np.array([n[0], n[1]]) / max(math.hypot(n[0], n[1]), 1e-6)
    along_ = (c - a)[:2]
    length = np.hypot(*along_)
    if length < .3:
        return
    along_ = along_ / length
    height = lambda q: a[2] - (f.normal[0] * (q[0] - a[0]) + f.normal[1] * (q[1] - a[1])) / f.normal[2]
    middle = (a + c)[:2] / 2 + out * .6
    shared = occupancy.at(*middle) >= 0
    if coping and model.pitch(f) < 5:
        w = .35
        q = [a[:2], c[:2], c[:2] - out * w - along_ * w * .9, a[:2] - out * w + along_ * w * .9]
        if length > 1:
            scene.face([[*x, height(x) + .25] for x in q], rim, PLAIN, i)
            scene.face([[*a[:2], a[2]], [*c[:2], c[2]], [*c[:2], c[2] + .25], [*a[:2], a[2] + .25]], rim, PLAIN, i)
    elif overhang and not shared and model.pitch(f) >= 5:
        e = [x + s * along_ * overhang if occupancy.at(*(x + s * along_ * overhang + out * .3)) < 0 and occupancy.at(*(x + s * along_ * (overhang + .4) - out * .5)) < 0
             else x for x, s in ((a[:2], -1), (c[:2], 1))]
        q = [e[0], e[1], e[1] + out * overhang, e[0] + out * overhang]
        scene.face([[*x, height(x)] for x in q], roof * .97, kind, i, True)


def on_plane(f, u, s, at, half_u, half_s, lift=.06):
    """Four corners of a rectangle in a roof plane about the point `at` (3,)."""
    return [at + u * a * half_u + s * b * half_s + f.normal * lift for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def add_clutter(scene, f, i, material, roof, p, rng, building):
    area = model.plan(f)
    if area < 8:
        return
    u = np.array(level_axis(f.normal))
    s = np.cross(f.normal, u)
    if s[2] < 0:
        s = -s
    ring = f.rings[0]
    low, high = ring[:, :2].min(0), ring[:, :2].max(0)
    height = lambda q: ring[0, 2] - (f.normal[0] * (q[0] - ring[0, 0]) + f.normal[1] * (q[1] - ring[0, 1])) / f.normal[2]

    def place(half_u, half_s):
        """A random place (3,) on the face where a rectangle of this size fits, or None."""
        for q in rng.uniform(low, high, (12, 2)):
            at = np.array([*q, height(q)])
            c = np.array(on_plane(f, u, s, at, half_u + .3, half_s + .3, 0))
            if inside(f.rings, np.vstack([c[:, :2], q[None]])).all():
                return at
        return None

    slope = model.pitch(f)
    count = lambda per: rng.poisson(min(area, 900) / per * p["clutter"])
    if slope > 10:
        if rng.random() < .6:  # a row of roof windows
            at = place(.5, .7)
            if at is not None:
                step, n = rng.uniform(1.8, 3.5), rng.integers(1, 7)
                size = rng.uniform(.35, .5), rng.uniform(.5, .75)
                glass = jitter(rng, [(58, 66, 78), (120, 138, 156), (44, 46, 50)][rng.integers(3)])
                for k in range(n):
                    c = at + u * step * k
                    q = on_plane(f, u, s, c, *size)
                    if inside(f.rings, np.array(q)[:, :2]).all():
                        scene.face(on_plane(f, u, s, c, size[0] + .08, size[1] + .08, .04), linear((70, 66, 64)), PLAIN, i)
                        scene.face(q, glass, GLASS, i)
        for _ in range(count(110)):
            at = place(.5, .5)
            if at is not None:
                w, l = rng.uniform(.45, .7), rng.uniform(.5, 1.6)
                scene.box(at[:2], u[:2], l, w, at[2] - 1, at[2] + rng.uniform(.6, 1.6), jitter(rng, [(140, 84, 66), (190, 184, 176), (120, 112, 106)][rng.integers(3)]),
                          building=i, top=jitter(rng, (64, 60, 58)))
        if slope > 25 and rng.random() < .35:  # dormers
            at = place(1.0, 1.2)
            if at is not None:
                step, n, half = rng.uniform(3, 4.5), rng.integers(1, 5), rng.uniform(.7, 1.1)
                lid = roof if rng.random() < .5 else jitter(rng, (120, 124, 128))
                back = 1.2 / math.tan(math.radians(slope))
                for k in range(n):
                    c = at + u * step * k
                    if inside(f.rings, np.array(on_plane(f, u, s, c, half, 1.0, 0))[:, :2]).all():
                        down = np.array([f.normal[0], f.normal[1]]) / math.hypot(f.normal[0], f.normal[1])
                        scene.box(c[:2] + down * 0.2 - down * back / 2, u[:2], 2 * half, back + .4, c[2] - 1.2, c[2] + 1.15, jitter(rng, (190, 186, 178)), building=i, top=lid)
        if f.normal[1] < -.1 and rng.random() < .05:
            at = place(2.5, 1.6)
            if at is not None:
                scene.face(on_plane(f, u, s, at, 2.5, 1.6, .12), linear((34, 40, 62)), GLASS, i)
    else:
        for _ in range(count(70)):
            l, w = rng.uniform(.4, 1.3), rng.uniform(.4, 1.3)
            at = place(l / 2, w / 2)
            if at is not None:
                scene.box(at[:2], u[:2], l, w, at[2] - .2, at[2] + rng.uniform(.3, 1.0), jitter(rng, [(200, 200, 198), (150, 150, 150), (90, 90, 92)][rng.integers(3)]), building=i)
        if area > 60 and rng.random() < .6:
            l, w = rng.uniform(2, 5), rng.uniform(2, 3.5)
            at = place(l / 2, w / 2)
            if at is not None:
                scene.box(at[:2], u[:2], l, w, at[2] - .2, at[2] + rng.uniform(1.5, 2.8), jitter(rng, (196, 192, 184)), building=i, top=jitter(rng, [(120, 118, 114), (180, 178, 172)][rng.integers(2)]))
        if area > 80 and rng.random() < .5:
            at = place(.8, .8)
            if at is not None:
                step, n = rng.uniform(2.5, 5), rng.integers(2, 8)
                for k in range(n):
                    c = at + u * step * k
                    if inside(f.rings, np.array(on_plane(f, u, s, c, .7, .7, 0))[:, :2]).all():
                        scene.face(on_plane(f, u, s, c, .6, .6, .3), jitter(rng, (206, 214, 218)), GLASS, i)
        for _ in range(count(220)):  # patches of repair, ponding
            l, w = rng.uniform(1, 5), rng.uniform(.8, 3)
            at = place(l / 2, w / 2)
            if at is not None:
                scene.face(on_plane(f, u, s, at, l / 2, w / 2, .01), roof * rng.uniform(.7, 1.25), BITUMEN if material == "grey_bitumen" else PLAIN, i)


def add_tree(scene, rng, x, y, radius, p, bushy=False):
    tall = radius * rng.uniform(1.6, 2.6) if not bushy else radius * rng.uniform(.7, 1.2)
    tint = np.array(p["tree_tint"], float) * rng.normal(1, .14) * rng.normal(1, .07, 3)
    low = tall * .3
    scene.blob((x, y, (tall + low) / 2), radius * .8, (tall - low) / 2, linear(np.clip(tint, 8, 200)))
    for _ in range(int(np.clip(radius * 3, 3, 12))):
        a, d = rng.uniform(0, 2 * np.pi), radius * np.sqrt(rng.uniform(.1, 1)) * .75
        r = radius * rng.uniform(.25, .5)
        z = low + (tall - low) * (.45 + .45 * (1 - (d / radius)**2)) + rng.uniform(-.1, .1) * radius
        scene.blob((x + d * np.cos(a), y + d * np.sin(a), z), r, r * rng.uniform(.6, 1.0), linear(np.clip(tint * rng.normal(1, .08), 8, 200)))


def surroundings(scene, buildings, occupancy, ground, west, north, width, height, p, rng):
    """Trees, cars, fences, hedges, sheds, terraces. Returns the sheds as a list of (x, y, length, width, height)."""
    area = width * height / 1e4
    size = width / ground.classes.shape[1]

    def kind(x, y):
        c, r = int((x - west) / size), int((north - y) / size)
        return ground.classes[r, c] if 0 <= r < ground.classes.shape[0] and 0 <= c < ground.classes.shape[1] else ASPHALT

    street = (ASPHALT, MARKING, WATER)
    near = lambda x, y: any(kind(x + a, y + b) in street for a, b in ((0, 0), (1.5, 0), (-1.5, 0), (0, 1.5), (0, -1.5)))
    for x, y in ground.trees:
        if occupancy.at(x, y) < 0:
            add_tree(scene, rng, x, y, rng.uniform(1.8, 4.5), p)
    for row in ground.tree_rows:
        for x, y in along(row, 8, 2)[0]:
            add_tree(scene, rng, x, y, rng.uniform(2, 4), p)
    for _ in range(int(area * p["garden_trees"])):
        x, y = west + rng.uniform(0, width), north - rng.uniform(0, height)
        if occupancy.free(x, y, 1.5) and not near(x, y):
            add_tree(scene, rng, x, y, rng.choice([1.0, 1.8, 2.8, 3.6, 4.8], p=[.2, .2, .25, .2, .15]) * rng.uniform(.9, 1.35), p, rng.random() < .2)
    edges = [(f.rings[0][k], f.rings[0][(k + 1) % len(f.rings[0])], i) for i, b in enumerate(buildings) for f in b.faces if f.kind == "Ground" for k in range(len(f.rings[0]))]

    def beside(distance):
        """A place beside a random outer wall: (x, y), direction of the wall, its length; or None."""
        a, b, _ = edges[rng.integers(len(edges))]
        d = (b - a)[:2]
        length = np.hypot(*d)
        if length < 3:
            return None
        d = d / length
        at = a[:2] + d * length * rng.uniform(.1, .9)
        for side in (1, -1):
            q = at + np.array([-d[1], d[0]]) * side * distance
            if occupancy.at(*q) < 0 and occupancy.at(*(at + np.array([-d[1], d[0]]) * side * .6)) < 0:
                return q, d, length
        return None

    for _ in range(int(area * p["wall_trees"] * 2)):  # crowns over roof edges
        found = beside(rng.uniform(1.2, 3.5))
        if found and not near(*found[0]):
            add_tree(scene, rng, *found[0], rng.uniform(1.5, 3.8), p)
    for points, half, name in ground.streets:
        if name in ("service", "pedestrian", "motorway"):
            continue
        for side in (-1, 1):
            places, u = along(points, 14, float(rng.uniform(0, 8)))
            for at, d in zip(places, u):
                x, y = at + np.array([-d[1], d[0]]) * side * (half + 1.2)
                if rng.random() < p["street_trees"] and occupancy.free(x, y, 1.2):
                    add_tree(scene, rng, x, y, rng.uniform(2.0, 4.2), p)
            places, u = along(points, 6, float(rng.uniform(4, 10)))
            parked = rng.random() < .75
            for at, d in zip(places, u):
                if parked and rng.random() < p["cars"]:
                    x, y = at + np.array([-d[1], d[0]]) * side * (half - 1.1)
                    if occupancy.free(x, y, 1.5):
                        add_car(scene, rng, x, y, d)
    for _ in range(int(area * 4)):
        found = beside(rng.uniform(2, 9))
        if found and occupancy.free(*found[0], 2.2) and rng.random() < p["cars"]:
            add_car(scene, rng, *found[0], found[1] if rng.random() < .5 else np.array([-found[1][1], found[1][0]]))
    for _ in range(int(area * p["fences"])):  # fences, garden walls, hedges: straight lines that are no buildings
        found = beside(rng.uniform(1.5, 12))
        if not found:
            continue
        at, d, length = found
        if rng.random() < .4:
            d = np.array([-d[1], d[0]])
        l = rng.uniform(4, 20)
        ends = [at + d * t for t in np.linspace(-l / 2, l / 2, 8)]
        if all(occupancy.free(*e, .4) and kind(*e) not in street for e in ends):
            style = rng.integers(3)
            w, h = [(.12, 1.3), (.3, 1.6), (.8, 1.4)][style]
            scene.box(at, d, l, w, 0, h * rng.uniform(.7, 1.3), jitter(rng, [(150, 140, 126), (196, 188, 176), (66, 84, 48)][style]), building=-1)
    for _ in range(int(area * p["fences"])):  # terraces beside walls: paving, decking, lawn with the wall's own direction
        found = beside(rng.uniform(1.2, 4))
        if found:
            at, d, length = found
            v = np.array([-d[1], d[0]])
            l, w = rng.uniform(2, min(length, 9) + 1), rng.uniform(1.5, 5)
            if occupancy.at(*at) < 0 and not near(*at):
                q = [at + d * l / 2 * a + v * w / 2 * b for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                scene.face([[*c, .05] for c in q], jitter(rng, [(176, 168, 156), (140, 130, 120), (150, 112, 84), (92, 112, 62), (170, 104, 82)][rng.integers(5)], .1), BITUMEN)
    sheds = []
    for _ in range(int(area * p["sheds"] * 2)):
        found = beside(rng.uniform(5, 15))
        if found:
            at, d, _ = found
            l, w, h = rng.uniform(2, 5.5), rng.uniform(1.8, 3.2), rng.uniform(2, 2.8)
            if occupancy.free(*at, max(l, w) / 2 + .5) and not near(*at):
                scene.box(at, d, l, w, 0, h, jitter(rng, (150, 130, 110)), top=jitter(rng, [(120, 74, 60), (96, 96, 96), (150, 150, 146)][rng.integers(3)]))
                sheds.append((float(at[0]), float(at[1]), float(l), float(w), float(h)))
    return sheds


def add_car(scene, rng, x, y, d):
    paint = jitter(rng, CARS[rng.choice(len(CARS), p=[.2, .2, .2, .1, .12, .07, .07, .04])])
    l, w = rng.uniform(3.8, 4.8), rng.uniform(1.7, 1.85)
    if rng.random() < .08:
        scene.box((x, y), d, l + 1.2, w + .2, .3, 2.3, paint)
        return
    scene.box((x, y), d, l, w, .15, .85, paint)
    scene.box(np.array([x, y]) - d * .15, d, l * .55, w * .86, .85, 1.15, linear((30, 34, 38)), GLASS)
    scene.box(np.array([x, y]) - d * .2, d, l * .32, w * .8, 1.15, 1.45, paint)
