"""Colour of what a ray meets: material and texture, sun where it is not hidden, sky as far as it is open. Linear light."""
import numpy as np

import ground as G
from scene import BITUMEN, GLASS, GRAVEL, SHEET, TILE, TREE, WALL, linear

SIDE = 1024


class Noise:
    """Tileable noise (1024, 1024): cloud (many scales, deviation 1) and grain (white, deviation 1)."""

    def __init__(self, rng):
        self.grain = rng.standard_normal((SIDE, SIDE)).astype(np.float32)
        f = np.hypot(*np.meshgrid(np.fft.fftfreq(SIDE), np.fft.fftfreq(SIDE)))
        f[0, 0] = 1
        cloud = np.fft.ifft2(np.fft.fft2(rng.standard_normal((SIDE, SIDE))) / f**1.2).real
        self.cloud = ((cloud - cloud.mean()) / cloud.std()).astype(np.float32)

    def of(self, field, x, y, step, shift=0):
        """Value of a field at metres x, y with cells of `step` metres."""
        return field[(y / step + 7 * shift).astype(np.int32) & (SIDE - 1), (x / step + 13 * shift).astype(np.int32) & (SIDE - 1)]


def ground_albedo(classes, x, y, noise):
    a = linear(G.COLOURS).astype(np.float32)[classes]
    rough = np.array([.10, .06, .16, .12, .05, .10, .05, .08, .02, .18, .05, .05, .06, .18], np.float32)[classes]
    fine = np.array([.16, .06, .14, .10, .04, .08, .04, .14, .02, .20, .03, .04, .05, .22], np.float32)[classes]
    tone = 1 + rough * noise.of(noise.cloud, x, y, .25) * 1.2 + .06 * noise.of(noise.cloud, x, y, 1.3, 3) + fine * noise.of(noise.grain, x, y, .25, 1)
    slabs = (classes == G.PAVEMENT) | (classes == G.PLOT_PAVED) | (classes == G.SQUARE)
    tone *= np.where(slabs & (((x * 1.25).astype(np.int32) % 2 == 0) ^ ((y * 1.25).astype(np.int32) % 2 == 0)), .96, 1)
    patches = (classes == G.ASPHALT) & (noise.of(noise.cloud, x, y, .9, 5) > 1.1)
    tone = np.where(patches, tone * .8, tone)
    green = (classes == G.PLOT_GRASS) | (classes == G.GREEN) | (classes == G.ROUGH)
    dry = np.clip(.35 * noise.of(noise.cloud, x, y, .5, 9), -.4, .8)[:, None] * np.array([.35, .12, .05], np.float32)
    return np.clip(a * np.clip(tone, .3, 2)[:, None] * np.where(green[:, None], 1 + dry, 1), .01, .95)


def item_albedo(scene, f, xyz, noise):
    """Albedo of items f (n,) at places xyz (n, 3)."""
    a, kind = scene.albedo[f].copy(), scene.kind[f]
    d = xyz - scene.origin[f]
    axis, normal = scene.u[f], scene.normal[f]
    u = (d * axis).sum(1)
    s = (d * np.cross(normal, axis)).sum(1)
    x, y, r = xyz[:, 0], xyz[:, 1], scene.rand[f]
    shift = (r * 997).astype(np.int32)
    cloud, grain = noise.of(noise.cloud, x + 31 * r, y, .15), noise.of(noise.grain, u + 100, s + 100, .2, shift)
    big = noise.of(noise.cloud, x, y + 57 * r, .8)
    tone = 1 + .05 * big + .04 * cloud
    m = kind == TILE  # rows of tiles, single tiles of other burn, moss, dark streaks down the slope
    rows = .05 * np.where((s / .36 % 1) < .35, -1, .4) + .05 * noise.of(noise.grain, u + 50, s + 50, .3, shift) - .07 * np.clip(noise.of(noise.cloud, u * 4, s * .6, .4, shift), 0, 2)
    tone = np.where(m, tone + rows, tone)
    m = kind == SHEET
    seams = np.where((u / .6 % 1) < .15, -.12, .01) + .05 * np.clip(noise.of(noise.cloud, u * 5, s * .5, .4, shift), -1, 2)
    tone = np.where(m, tone - .02 + seams, tone)
    m = kind == BITUMEN
    rolls = .04 * noise.grain[np.clip((s + 500).astype(np.int32), 0, 1023), shift & 1023] + np.where((s % 1) < .1, -.06, 0) - .12 * np.clip(noise.of(noise.cloud, x, y, .4, 4) - .8, 0, 1.5)
    tone = np.where(m, tone + rolls + .03 * grain, tone)
    m = kind == GRAVEL
    tone = np.where(m, tone + .09 * grain + .08 * noise.of(noise.cloud, x, y, .3, 6), tone)
    m = kind == WALL  # windows by storey and axis
    window = m & ((np.abs(u) / 2.4 % 1) > .3) & ((np.abs(u) / 2.4 % 1) < .75) & ((xyz[:, 2] / 3.1 % 1) > .3) & ((xyz[:, 2] / 3.1 % 1) < .8)
    a[window] = (.035, .04, .05)
    m = kind == TREE
    leaf = .32 * noise.of(noise.grain, x, y, .4, 2) + .22 * noise.of(noise.cloud, x, y, .1, 8)
    tone = np.where(m, 1 + leaf, tone)
    return a * np.clip(tone, .25, 2.2)[:, None]


def shade(scene, ground_classes, ids, z, places, view, sun_buffer, sun_direction, sky_height, p, noise):
    """Flat arrays: classes (n,), ids (n,), z (n,), places (n, 2) -> linear rgb (n, 3), lit (n,) bool."""
    step = view.a - places * view.b
    xyz = np.column_stack([places + step * z[:, None], z]).astype(np.float32)
    albedo = np.empty((len(ids), 3), np.float32)
    normal = np.zeros((len(ids), 3), np.float32)
    normal[:, 2] = 1
    on = ids >= 0
    albedo[~on] = ground_albedo(ground_classes[~on], xyz[~on, 0], xyz[~on, 1], noise)
    glass = np.zeros(len(ids), bool)
    bias = np.full(len(ids), .12, np.float32)
    if on.any():
        f = ids[on]
        albedo[on] = item_albedo(scene, f, xyz[on], noise)
        n = scene.normal[f].copy()
        n[(n * np.column_stack([-step[on], -np.ones(on.sum())])).sum(1) > 0] *= -1  # seen from behind
        tree = scene.kind[f] == TREE
        rr = scene.radius[f]
        round_ = (xyz[on] - scene.centre[f]) / np.column_stack([rr[:, :1]**2, rr[:, :1]**2, rr[:, 1:]**2])
        round_ /= np.maximum(np.linalg.norm(round_, axis=1), 1e-6)[:, None]
        n[tree] = round_[tree] * .8 + np.array([0, 0, .3])
        normal[on] = n
        glass[on] = scene.kind[f] == GLASS
        bias[on] = np.where(tree, .35, .12)
    facing = np.clip((normal * sun_direction).sum(1), 0, 1)
    # The sun's own z-buffer: hidden where something stands higher on the ray to the sun.
    b = sun_buffer
    q = xyz[:, :2] - b.view.a * xyz[:, 2:3]
    c = np.clip(((q[:, 0] - b.west) / b.size).astype(np.int32), 0, b.z.shape[1] - 1)
    r = np.clip(((b.north - q[:, 1]) / b.size).astype(np.int32), 0, b.z.shape[0] - 1)
    lit = b.z[r, c] < xyz[:, 2] + bias + .15 * (1 - facing)
    direct = facing * lit
    h, west, north = sky_height
    hc = np.clip((xyz[:, 0] - west).astype(np.int32), 0, h.shape[1] - 1)
    hr = np.clip((north - xyz[:, 1]).astype(np.int32), 0, h.shape[0] - 1)
    open_ = 1 - .55 * np.clip((h[hr, hc] - xyz[:, 2]) / 10, 0, 1)
    sky = (.55 + .45 * np.clip(normal[:, 2], 0, 1)) * open_
    light = direct[:, None] * np.array(p["sun"], np.float32) + sky[:, None] * np.array(p["sky"], np.float32) + .12 * (1 - np.clip(normal[:, 2:], 0, 1))
    out = albedo * light
    out[glass] += np.array(p["sky"], np.float32) * .12
    return out.astype(np.float32), lit & (facing > .02), facing
