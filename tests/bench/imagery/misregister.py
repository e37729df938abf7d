#!/usr/bin/python3
"""A good image with a wrong georeference: the georeference of IN given to wrong pixels.

    misregister.py IN.tif OUT.tif --shift-east M --shift-north M | --mirror | --rotate90 | --place-of OTHER.tif

--shift: what is seen lies M metres (on the ground) east and north of where it is. --mirror: east and west changed. --rotate90: turned
about the middle. --place-of: IN's pixels at the middle of OTHER's place, or where --at has their middle (shares of OTHER's width from the
west, and height from the north), in OTHER's system. Lossless; (rows, columns) stay, except
for --rotate90, where they change places.
"""
import argparse
import math

import numpy as np
from osgeo import gdal, osr

gdal.UseExceptions()
osr.UseExceptions()


def ground_scale(dataset):
    """Units of the dataset's system per metre on the ground in its middle (Web Mercator: 1 / cos latitude)."""
    s = dataset.GetSpatialRef()
    if "Mercator" not in (s.GetAttrValue("PROJECTION") or "") or "Transverse" in s.GetAttrValue("PROJECTION"):
        return 1.0
    t = dataset.GetGeoTransform()
    x, y = t[0] + t[1] * dataset.RasterXSize / 2, t[3] + t[5] * dataset.RasterYSize / 2
    wgs = osr.SpatialReference()
    wgs.ImportFromEPSG(4326)
    wgs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    s.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return 1 / math.cos(math.radians(osr.CoordinateTransformation(s, wgs).TransformPoint(x, y)[1]))


def most_built(source, other, outlines):
    """Shares of OTHER's width and height: where SOURCE's picture, laid there, holds the middles of the most outlines [(n, 2) in OTHER's
    system]."""
    d, o = gdal.Open(source), gdal.Open(other)
    t, u = d.GetGeoTransform(), o.GetGeoTransform()
    half = np.array([d.RasterXSize, d.RasterYSize]) * abs(t[1]) / ground_scale(d) * ground_scale(o) / 2
    middles = np.array([(r.min(0) + r.max(0)) / 2 for r in outlines])
    shares = [(x, y) for y in (.1, .3, .5, .7, .9) for x in (.1, .3, .5, .7, .9)]
    held = [np.sum((np.abs(middles - (u[0] + u[1] * o.RasterXSize * x, u[3] + u[5] * o.RasterYSize * y)) < half).all(1)) for x, y in shares]
    return shares[int(np.argmax(held))]


def misregister(source, target, east=0.0, north=0.0, mirror=False, rotate90=False, place_of=None, at=(.5, .5)):
    d = gdal.Open(source)
    pixels, t, system = d.ReadAsArray(), list(d.GetGeoTransform()), d.GetSpatialRef()
    if pixels.ndim == 2:
        pixels = pixels[None]
    scale = ground_scale(d)
    t[0] += east * scale
    t[3] += north * scale
    if mirror:
        pixels = pixels[:, :, ::-1]
    if rotate90:
        h, w = pixels.shape[1:]
        pixels = np.rot90(pixels, axes=(1, 2))
        t[0] += t[1] * (w - h) / 2
        t[3] += t[5] * (h - w) / 2
    if place_of:
        o = gdal.Open(place_of)
        u, to = o.GetGeoTransform(), ground_scale(o)
        size = abs(t[1]) / scale * to
        h, w = pixels.shape[1:]
        t = [u[0] + u[1] * o.RasterXSize * at[0] - size * w / 2, size, 0, u[3] + u[5] * o.RasterYSize * at[1] + size * h / 2, 0, -size]
        system = o.GetSpatialRef()
    out = gdal.GetDriverByName("GTiff").Create(target, pixels.shape[2], pixels.shape[1], pixels.shape[0], d.GetRasterBand(1).DataType,
                                               ["TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=2", "ZLEVEL=1"])
    out.SetGeoTransform(t)
    out.SetSpatialRef(system)
    out.WriteArray(np.ascontiguousarray(pixels))
    out.FlushCache()


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("source")
    a.add_argument("target")
    a.add_argument("--shift-east", type=float, default=0)
    a.add_argument("--shift-north", type=float, default=0)
    a.add_argument("--mirror", action="store_true")
    a.add_argument("--rotate90", action="store_true")
    a.add_argument("--place-of")
    a.add_argument("--at", type=float, nargs=2, default=(.5, .5))
    a = a.parse_args()
    misregister(a.source, a.target, a.shift_east, a.shift_north, a.mirror, a.rotate90, a.place_of, a.at)


if __name__ == "__main__":
    main()
