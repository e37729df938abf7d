"""A z-buffer over the ground plane, for camera and sun alike.

A ray through the ground place p (2, metres) is at height z above X = p + (A - p * B) * z. Camera above nadir N at height H:
A = N / H, B = 1 / H. Sun: A = horizontal metres towards the sun per metre of height, B = 0. The highest z on a ray is what is seen.
"""
import numpy as np


class View:
    def __init__(self, a, b):
        self.a, self.b = np.asarray(a, float), float(b)

    @staticmethod
    def camera(nadir, height):
        return View(np.asarray(nadir, float) / height, 1 / height)

    @staticmethod
    def sun(step):
        return View(step, 0)

    def place(self, xyz):
        """(n, 3) points -> (n, 2) ground places on whose rays they lie."""
        z = xyz[:, 2:3]
        return (xyz[:, :2] - self.a * z) / (1 - self.b * z)

    def lean(self, xy, z):
        """(2,) metres by which a point at height z above xy appears displaced."""
        return self.place(np.array([[xy[0], xy[1], z]]))[0] - np.asarray(xy)


def fill(rings, width, height):
    """Even-odd fill. rings: list of (n, 2) pixel coordinates (column, row; centres at .5). Returns (row0, col0, mask) or None."""
    x0 = np.concatenate([r[:, 0] for r in rings])
    y0 = np.concatenate([r[:, 1] for r in rings])
    x1 = np.concatenate([np.roll(r[:, 0], -1) for r in rings])
    y1 = np.concatenate([np.roll(r[:, 1], -1) for r in rings])
    c0 = max(int(np.ceil(x0.min() - .5)), 0)
    c1 = min(int(np.ceil(x0.max() - .5)), width)
    r0 = max(int(np.ceil(y0.min() - .5)), 0)
    r1 = min(int(np.ceil(y0.max() - .5)), height)
    if c0 >= c1 or r0 >= r1:
        return None
    down = y0 > y1
    xa, ya, xb, yb = np.where(down, x1, x0), np.where(down, y1, y0), np.where(down, x0, x1), np.where(down, y0, y1)
    ra = np.clip(np.ceil(ya - .5).astype(int), r0, r1)
    n = np.clip(np.ceil(yb - .5).astype(int), r0, r1) - ra
    if n.sum() == 0:
        return None
    e = np.repeat(np.arange(len(n)), n)
    rows = np.arange(len(e)) - np.repeat(np.cumsum(n) - n, n) + ra[e]
    x = xa[e] + (rows + .5 - ya[e]) * ((xb - xa) / np.where(yb == ya, 1, yb - ya))[e]
    cols = np.clip(np.ceil(x - .5).astype(int), c0, c1) - c0
    w = c1 - c0 + 1
    toggles = np.bincount((rows - r0) * w + cols, minlength=(r1 - r0) * w).reshape(r1 - r0, w)
    mask = np.cumsum(toggles, 1)[:, :-1] & 1 == 1
    return r0, c0, mask


class Buffer:
    """z (float32) and item (int32, -1 = ground) over a grid: west/north corner of pixel 0,0 in metres, rows southwards."""

    def __init__(self, view, west, north, columns, rows, size, ids=True):
        self.view, self.west, self.north, self.size = view, west, north, size
        self.z = np.zeros((rows, columns), np.float32)
        self.id = np.full((rows, columns), -1, np.int32) if ids else None

    def pixels(self, places):
        return np.column_stack([(places[:, 0] - self.west) / self.size, (self.north - places[:, 1]) / self.size])

    def polygon(self, rings, normal, item):
        """rings: list of (n, 3) of one plane with this unit normal."""
        found = fill([self.pixels(self.view.place(r)) for r in rings], self.z.shape[1], self.z.shape[0])
        if found is None:
            return
        r0, c0, mask = found
        h, w = mask.shape
        px = self.west + (c0 + np.arange(w) + .5) * self.size
        py = self.north - (r0 + np.arange(h) + .5)[:, None] * self.size
        v, p0 = self.view, rings[0][0]
        below = normal[0] * (v.a[0] - px * v.b) + normal[1] * (v.a[1] - py * v.b) + normal[2]
        above = normal @ p0 - normal[0] * px - normal[1] * py
        z = above / np.where(np.abs(below) < 1e-6, 1e-6, below)
        low, high = min(r[:, 2].min() for r in rings), max(r[:, 2].max() for r in rings)
        self.put(r0, c0, mask, np.clip(z, low, high), item)

    def ellipsoid(self, centre, radius, high, item, ragged=None, holes=-1.1):
        """Crown: horizontal radius, vertical half height `high`; `ragged`: (n, n) noise that eats holes where below `holes`."""
        place = self.view.place(centre[None, :])[0]
        reach = radius + high * max(np.abs(self.view.a - place * self.view.b).max(), 0.0)
        c0 = max(int((place[0] - reach - self.west) / self.size), 0)
        c1 = min(int((place[0] + reach - self.west) / self.size) + 1, self.z.shape[1])
        r0 = max(int((self.north - place[1] - reach) / self.size), 0)
        r1 = min(int((self.north - place[1] + reach) / self.size) + 1, self.z.shape[0])
        if c0 >= c1 or r0 >= r1:
            return
        px = (self.west + (c0 + np.arange(c1 - c0) + .5) * self.size)[None, :]
        py = (self.north - (r0 + np.arange(r1 - r0) + .5) * self.size)[:, None]
        v = self.view
        dx, dy = v.a[0] - px * v.b, v.a[1] - py * v.b
        ex, ey = px - centre[0], py - centre[1]
        qa = (dx * dx + dy * dy) / radius**2 + 1 / high**2
        qb = (dx * ex + dy * ey) / radius**2 - centre[2] / high**2
        qc = (ex * ex + ey * ey) / radius**2 + centre[2]**2 / high**2 - 1
        disc = qb * qb - qa * qc
        mask = disc > 0
        z = (-qb + np.sqrt(np.where(mask, disc, 0))) / qa
        mask &= z > 0.05
        if ragged is not None:
            n = ragged.shape[0] - 1
            mask &= ragged[np.ix_((r0 + np.arange(r1 - r0)) & n, (c0 + np.arange(c1 - c0)) & n)] > holes
        self.put(r0, c0, mask, z, item)

    def put(self, r0, c0, mask, z, item):
        part = self.z[r0:r0 + mask.shape[0], c0:c0 + mask.shape[1]]
        better = mask & (z > part)
        part[better] = z[better]
        if self.id is not None:
            self.id[r0:r0 + mask.shape[0], c0:c0 + mask.shape[1]][better] = item
