#!/usr/bin/python3
"""A synthetic orthophoto of a finished build, with its truth.

    render.py BUILD_DIR -o ortho.tif --seed N --set tuning|judging [--gsd 0.2] [--extract FILE]

BUILD_DIR: `blockrand build EXTRACT -o DIR --lod 2 --ground-height 0 --formats cityjson`. Writes ortho.tif (RGB, EPSG of the build)
and ortho.truth.json beside it. Perspective frames, not a true orthophoto: the ground lies right, roofs lean away from the nadirs.
"""
import argparse
import json
import os
import sys
import time

import numpy as np
from osgeo import gdal

import model
import osm
import scene as S
from ground import Ground
from parameters import SETS, sun_of, sun_step
from raster import Buffer, View
from sensor import blurred, develop
from shade import Noise, shade

MARGIN = 40.0  # m of ground about the buildings


def frames_of(west, north, width, height, p, rng):
    """[(middle, nadir)] on a grid; a pixel belongs to the frame with the nearest middle, so seams are straight."""
    nx, ny = max(1, round(width / p["frame"])), max(1, round(height / p["frame"]))
    out = []
    for j in range(ny):
        for i in range(nx):
            middle = np.array([west + (i + .5) * width / nx, north - (j + .5) * height / ny])
            a, d = rng.uniform(0, 2 * np.pi), rng.uniform(*p["nadir_offset"])
            out.append((middle, middle + d * np.array([np.cos(a), np.sin(a)])))
    return out


def draw(buffer, scene, seen, ragged, holes=-1.3):
    """All polygons and crowns of a scene into a buffer; seen: (w, s, e, n) of the ground places to bother with."""
    low = np.array([r[0].min(0) if r else c - q for r, c, q in zip(scene.bounds_rings, scene.centre, scene.reach)])
    high = np.array([r[0].max(0) if r else c + q for r, c, q in zip(scene.bounds_rings, scene.centre, scene.reach)])
    middle, half = (low + high) / 2, np.linalg.norm(high - low, axis=1) / 2
    at = buffer.view.place(middle)
    w, s, e, n = seen
    near = (at[:, 0] + 1.5 * half > w) & (at[:, 0] - 1.5 * half < e) & (at[:, 1] + 1.5 * half > s) & (at[:, 1] - 1.5 * half < n)
    for i in np.nonzero(near)[0]:
        if scene.bounds_rings[i]:
            buffer.polygon(scene.rings[i], scene.normal[i].astype(float), i)
    for item, c, r, h in scene.blobs:
        if near[item]:
            buffer.ellipsoid(c, r, h, item, ragged, holes)


def render(build, seed, set_, gsd, extract=None, log=sys.stderr, bare=False):
    """-> (uint8 picture, truth dict, EPSG, geotransform). bare: only the solids on plain ground (for the self test)."""
    start = time.time()
    p = SETS[set_]
    rng = np.random.default_rng([seed, 20, list(SETS).index(set_)])
    buildings, epsg, origin = model.read_build(build)
    xs = [r[:, :2] for b in buildings for f in b.faces for r in f.rings]
    low, high = np.min([x.min(0) for x in xs], 0) - MARGIN, np.max([x.max(0) for x in xs], 0) + MARGIN
    columns, rows = (int(np.ceil((h - l) / gsd)) for l, h in zip(low, high))
    west, north = float(np.floor(low[0])), float(np.ceil(high[1]))
    width, height = columns * gsd, rows * gsd
    azimuth, elevation = sun_of(p, rng)
    step = np.array(sun_step(azimuth, elevation))
    direction = np.array([*step, 1]) / np.linalg.norm([*step, 1])
    if extract is None:
        with open(os.path.join(build, "run.json")) as f:
            extract = next(i["path"] for i in json.load(f)["inputs"] if i["role"] == "extract")
    fine = gsd / 2
    occupancy = S.Occupancy(buildings, west, north, width, height)
    ground = Ground(osm.Extract(extract), epsg, origin, west, north, 2 * columns, 2 * rows, fine, rng, p["unkempt"])
    if bare:
        ground.classes[:] = 1
    scene = S.Scene()
    quiet = dict(p, clutter=0, eaves=(0, 0), parapet=0) if bare else p
    materials = S.add_buildings(scene, buildings, occupancy, quiet, rng)
    sheds = [] if bare else S.surroundings(scene, buildings, occupancy, ground, west, north, width, height, p, rng)
    scene.arrays()
    scene.bounds_rings, scene.reach = scene.rings, np.column_stack([scene.radius[:, 0], scene.radius[:, 0], scene.radius[:, 1]])
    print(f"scene: {len(scene.rings)} items, {len(scene.blobs)} crowns, {time.time() - start:.0f} s", file=log)
    noise = Noise(rng)
    ragged = noise.grain + .5 * noise.cloud

    top = max(r[:, 2].max() for b in buildings for f in b.faces for r in f.rings) + 5
    pad = float(np.abs(step).max() * top + 5)
    sun = Buffer(View.sun(step), west - pad, north + pad, int((width + 2 * pad) / fine), int((height + 2 * pad) / fine), fine, ids=False)
    draw(sun, scene, (west - pad, north - height - pad, west + width + pad, north + pad), ragged, holes=-2.2)
    print(f"sun: {time.time() - start:.0f} s", file=log)

    coarse = occupancy.height[::4, ::4]
    sky_height = blurred(coarse.astype(np.float32), 8), west, north
    frames = frames_of(west, north, width, height, p, rng)
    middles = np.array([m for m, _ in frames])
    px, py = west + (np.arange(columns) + .5) * gsd, north - (np.arange(rows) + .5) * gsd
    distance = np.stack([(px[None, :] - m[0])**2 + (py[:, None] - m[1])**2 for m in middles]).astype(np.float32)
    frame_of = distance.argmin(0)
    radial = np.sqrt(distance.min(0)) / p["frame"]
    del distance
    light = np.zeros((rows, columns, 3), np.float32)
    owner = np.full((rows, columns), -1, np.int32)     # roof item that fills the pixel and is sunlit, else -1
    seen_roof = np.zeros(len(buildings)), np.zeros(len(buildings))  # pixels of roof seen; sunlit
    for k, (_, nadir) in enumerate(frames):
        mine = np.argwhere(frame_of == k)
        (r0, c0), (r1, c1) = mine.min(0), mine.max(0) + 1
        view = View.camera(nadir, p["flight_height"])
        b = Buffer(view, west + c0 * gsd, north - r0 * gsd, 2 * (c1 - c0), 2 * (r1 - r0), fine)
        draw(b, scene, (b.west, north - r1 * gsd, west + c1 * gsd, b.north), ragged)
        w = 2 * (c1 - c0)
        for r in range(0, r1 - r0, 128):
            n = min(128, r1 - r0 - r)
            part = slice(2 * r, 2 * (r + n))
            x, y = np.meshgrid(b.west + (np.arange(w) + .5) * fine, b.north - (np.arange(part.start, part.stop) + .5) * fine)
            classes = ground.classes[2 * r0 + part.start:2 * r0 + part.stop, 2 * c0:2 * c1]
            ids = b.id[part].ravel()
            rgb, lit, _ = shade(scene, classes.ravel(), ids, b.z[part].ravel(), np.column_stack([x.ravel(), y.ravel()]), view, sun, direction, sky_height, p, noise)
            here = frame_of[r0 + r:r0 + r + n, c0:c1] == k
            small = rgb.reshape(n, 2, w // 2, 2, 3).mean((1, 3))
            light[r0 + r:r0 + r + n, c0:c1][here] = small[here]
            four, lits = ids.reshape(n, 2, w // 2, 2), lit.reshape(n, 2, w // 2, 2)
            whole = (four == four[:, :1, :, :1]).all((1, 3))
            item = np.where(whole & here, four[:, 0, :, 0], -1)
            item = np.where(item >= 0, np.where(scene.roof[item], item, -1), -1)
            sunlit = lits.all((1, 3))
            owned = scene.building[item[item >= 0]]
            np.add.at(seen_roof[0], owned, 1)
            np.add.at(seen_roof[1], scene.building[item[(item >= 0) & sunlit]], 1)
            owner[r0 + r:r0 + r + n, c0:c1][here] = np.where(sunlit, item, -1)[here]
        print(f"frame {k + 1} of {len(frames)}: {time.time() - start:.0f} s", file=log)
    gains = 1 + rng.uniform(-1, 1, (len(frames), 1)) * p["step"] + rng.uniform(-1, 1, (len(frames), 3)) * p["step"] / 4
    picture = develop(light, frame_of, radial, gains.astype(np.float32), p, rng)
    truth = dict(seed=seed, set=set_, gsd=gsd, epsg=epsg, sun_azimuth_deg=azimuth, sun_elevation_deg=elevation, flight_height_m=p["flight_height"],
                 frames=[dict(middle=[float(m[0] + origin[0]), float(m[1] + origin[1])], nadir=[float(n[0] + origin[0]), float(n[1] + origin[1])]) for m, n in frames],
                 buildings=told(buildings, scene, materials, picture, owner, seen_roof, frames, p, gsd, origin, direction),
                 unmapped=[dict(centre=[s[0] + origin[0], s[1] + origin[1]], size_m=s[2:4], height_m=s[4]) for s in sheds])
    print(f"done: {columns} x {rows}, {time.time() - start:.0f} s", file=log)
    return picture, truth, epsg, (west + origin[0], gsd, 0, north + origin[1], 0, -gsd)


def told(buildings, scene, materials, picture, owner, seen_roof, frames, p, gsd, origin, direction):
    """The truth of each building. Colours are read off the finished picture on the roof plane that faces the sun best."""
    flat = owner.ravel()
    order = np.argsort(flat, kind="stable")
    ordered = flat[order]
    begin, end = np.searchsorted(ordered, np.arange(len(scene.kind))), np.searchsorted(ordered, np.arange(len(scene.kind)), side="right")
    colours = picture.reshape(-1, 3)
    items = {}
    for i in np.nonzero(scene.roof)[0]:
        items.setdefault(int(scene.building[i]), []).append(i)
    out = {}
    for k, b in enumerate(buildings):
        form, ridge, planes = model.roof_truth(b)
        ground = [f for f in b.faces if f.kind == "Ground"] or [f for f in b.faces if f.kind == "Roof"]
        c = model.centre(ground)
        roofs = [f for f in b.faces if f.kind == "Roof"] or b.faces
        top = float(max(r[:, 2].max() for f in roofs for r in f.rings))
        areas = [model.plan(f) for f in roofs]
        mean = float(np.average([f.rings[0][:, 2].mean() for f in roofs], weights=np.maximum(areas, 1e-3)))
        eaves = float(min(r[:, 2].min() for f in roofs for r in f.rings))
        frame = min(range(len(frames)), key=lambda j: ((frames[j][0] - c)**2).sum())
        view = View.camera(frames[frame][1], p["flight_height"])
        own = [i for i in items.get(k, []) if end[i] > begin[i]]
        colour, share = None, 0.0
        if own:
            count = np.array([end[i] - begin[i] for i in own])
            facing = np.array([float(scene.normal[i] @ direction) for i in own])
            large = (count > .1 * count.sum()) | (count == count.max())  # of a roof in many pieces none may be a tenth
            best = facing >= facing[large].max() - .05
            pixels = np.concatenate([order[begin[i]:end[i]] for i, take in zip(own, best) if take])
            if len(pixels) >= 25:
                colour = [int(v) for v in np.median(colours[pixels], 0)]
                share = float(len(pixels) / max(seen_roof[0][k], 1))
        out[b.id] = dict(centre=[float(c[0] + origin[0]), float(c[1] + origin[1])], area_m2=float(sum(model.plan(f) for f in ground)), form=form,
                         ridge_azimuth_deg=ridge, planes=planes, height_m=top, eaves_m=eaves, frame=frame,
                         lean_m=[float(v) for v in view.lean(c, mean)], lean_top_m=[float(v) for v in view.lean(c, top)],
                         roof_material=materials[k]["material"], roof_albedo_srgb=materials[k]["albedo"], roof_colour_srgb=colour,
                         roof_seen_m2=float(seen_roof[0][k] * gsd**2), roof_sunlit_share=float(seen_roof[1][k] / max(seen_roof[0][k], 1)),
                         colour_share=share)
    return out


def write(path, picture, epsg, transform, jpeg):
    options = ["TILED=YES", "COMPRESS=JPEG", f"JPEG_QUALITY={jpeg}", "PHOTOMETRIC=YCBCR"] if jpeg else ["TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=2"]
    out = gdal.GetDriverByName("GTiff").Create(path, picture.shape[1], picture.shape[0], 3, gdal.GDT_Byte, options)
    out.SetGeoTransform(transform)
    out.SetProjection(osm.system(epsg).ExportToWkt())
    for k in range(3):
        out.GetRasterBand(k + 1).WriteArray(picture[..., k])
    out.FlushCache()


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("build")
    a.add_argument("-o", "--output", required=True)
    a.add_argument("--seed", type=int, default=1)
    a.add_argument("--set", choices=list(SETS), required=True)
    a.add_argument("--gsd", type=float, default=.2, help="metres per pixel")
    a.add_argument("--extract", help="else the one that run.json names")
    a.add_argument("--no-jpeg", action="store_true", help="lossless")
    a = a.parse_args()
    picture, truth, epsg, transform = render(a.build, a.seed, a.set, a.gsd, a.extract)
    write(a.output, picture, epsg, transform, None if a.no_jpeg else SETS[a.set]["jpeg"])
    with open(os.path.splitext(a.output)[0] + ".truth.json", "w") as f:
        json.dump(truth, f, indent=1)


if __name__ == "__main__":
    if "MALLOC_MMAP_THRESHOLD_" not in os.environ:  # large arrays from the heap: else the kernel clears their pages again and again
        os.execve(sys.executable, [sys.executable] + sys.argv, dict(os.environ, MALLOC_MMAP_THRESHOLD_="1073741824", MALLOC_TRIM_THRESHOLD_="4294967296"))
    main()
