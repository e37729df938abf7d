#!/usr/bin/python3
"""A good image with a wrong georeference: the georeference of IN given to wrong pixels.

    misregister.py IN.tif OUT.tif --shift-east M --shift-north M | --mirror | --rotate90 | --place-of OTHER.tif

--shift: what is seen lies M metres (on the ground) east and north of where it is. --mirror: east and west changed. --rotate90: turned
about the middle. --place-of: IN's pixels at the middle of OTHER's place, in OTHER's system. Lossless; (rows, columns) stay, except
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


def misregister(source, target, east=0.0, north=0.0, mirror=False, rotate90=False, place_of=None):
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
        t = [u[0] + u[1] * o.RasterXSize / 2 - size * w / 2, size, 0, u[3] + u[5] * o.RasterYSize / 2 + size * h / 2, 0, -size]
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
    a = a.parse_args()
    misregister(a.source, a.target, a.shift_east, a.shift_north, a.mirror, a.rotate90, a.place_of)


if __name__ == "__main__":
    main()
