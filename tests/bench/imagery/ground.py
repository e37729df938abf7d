"""The ground: classes from the OSM extract (streets buffered by class, green, water, rails), else plots of grass, paving, soil."""
import numpy as np
from osgeo import gdal, ogr, osr

from osm import system

gdal.UseExceptions()

PLOT_GRASS, PLOT_PAVED, PLOT_SOIL, PLOT_GRAVEL, PAVEMENT, PATH, ASPHALT, GREEN, WATER, RAIL, MARKING, PARKING, SQUARE, ROUGH = range(14)

# Material colours of the classes, sRGB.
COLOURS = np.array([(96, 112, 66), (142, 136, 126), (138, 116, 90), (158, 150, 134), (150, 146, 138), (164, 154, 134), (98, 98, 100),
                    (88, 108, 60), (52, 66, 66), (112, 102, 92), (214, 214, 210), (108, 108, 108), (156, 148, 136), (112, 114, 74)], float)

# Half width of the carriageway and width of the pavement beside it, m.
STREETS = {"motorway": (6, 0), "trunk": (6, 1), "primary": (5, 3), "secondary": (4.5, 3), "tertiary": (4, 2.5), "unclassified": (3.2, 2),
           "residential": (3.6, 2.5), "living_street": (2.8, 1), "service": (1.8, 0), "pedestrian": (3.5, 0), "road": (3, 2)}
PATHS = {"footway": 1.0, "path": .8, "cycleway": 1.2, "steps": 1.0, "track": 1.4, "bridleway": 1.0}
AREAS = {("leisure", "park"): GREEN, ("leisure", "garden"): GREEN, ("leisure", "pitch"): ROUGH, ("leisure", "playground"): PLOT_SOIL,
         ("landuse", "grass"): GREEN, ("landuse", "cemetery"): ROUGH, ("landuse", "allotments"): ROUGH, ("landuse", "forest"): ROUGH,
         ("landuse", "meadow"): ROUGH, ("landuse", "village_green"): GREEN, ("natural", "wood"): ROUGH, ("natural", "scrub"): ROUGH,
         ("natural", "grassland"): GREEN, ("natural", "water"): WATER, ("waterway", "riverbank"): WATER, ("amenity", "parking"): PARKING}


class Ground:
    """classes: (rows, columns) uint8 of the picture's fine grid; streets: list of ((n, 2) points, half width, name of the class)."""

    def __init__(self, extract, epsg, origin, west, north, columns, rows, size, rng, unkempt):
        xy = extract.project(epsg)
        self.local = {i: (p[0] - origin[0], p[1] - origin[1]) for i, p in xy.items()}
        self.streets, self.trees, self.tree_rows, self.parks = [], [], [], []
        box = (west - 50, north - rows * size - 50, west + columns * size + 50, north + 50)
        layers = {k: [] for k in ("area", "pavement", "path", "asphalt", "rail", "marking", "square")}
        for i, (_, _, tags) in extract.nodes.items():
            if tags.get("natural") == "tree":
                self.trees.append(self.local[i])
        for refs, tags in extract.ways.values():
            points = [self.local[r] for r in refs if r in self.local]
            if len(points) < 2 or tags.get("tunnel") in ("yes", "building_passage") or tags.get("layer", "0").startswith("-"):
                continue
            p = np.array(points)
            if p[:, 0].max() < box[0] or p[:, 0].min() > box[2] or p[:, 1].max() < box[1] or p[:, 1].min() > box[3]:
                continue
            line = ogr.Geometry(ogr.wkbLineString)
            for x, y in points:
                line.AddPoint_2D(x, y)
            closed = refs[0] == refs[-1] and len(points) > 3
            kind = tags.get("highway")
            if closed:
                for (k, v), c in AREAS.items():
                    if tags.get(k) == v:
                        layers["area"].append((polygon(points), c))
                        if c in (GREEN, ROUGH):
                            self.parks.append(p)
                if kind in ("pedestrian", "footway") and (tags.get("area") == "yes") or tags.get("place") == "square":
                    layers["square"].append((polygon(points), SQUARE))
                    continue
            if kind in STREETS:
                half, side = STREETS[kind]
                lanes = tags.get("lanes", "")
                if lanes.isdigit() and kind not in ("service",):
                    half = max(half, int(lanes) * 1.6)
                side += float(rng.uniform(-.5, 1)) if side else 0
                if side:
                    layers["pavement"].append((line.Buffer(half + side, 4), PAVEMENT))
                layers["asphalt" if kind != "pedestrian" else "pavement"].append((line.Buffer(half, 4), ASPHALT if kind != "pedestrian" else SQUARE))
                self.streets.append((p, half, kind))
                if kind in ("primary", "secondary", "tertiary", "trunk") or (kind == "residential" and rng.random() < .1):
                    for a, b in dashes(p, 3, 6):
                        layers["marking"].append((segment(a, b).Buffer(.08, 1), MARKING))
                if kind in ("primary", "secondary", "tertiary", "residential") and rng.random() < .3:
                    for a, b in zebra(p, half, rng):
                        layers["marking"].append((segment(a, b).Buffer(.25, 1), MARKING))
            elif kind in PATHS:
                layers["path"].append((line.Buffer(PATHS[kind], 3), PATH))
            if tags.get("railway") in ("rail", "tram", "light_rail", "narrow_gauge"):
                layers["rail"].append((line.Buffer(1.5, 2), RAIL))
            if tags.get("natural") == "tree_row":
                self.tree_rows.append(p)
        memory = gdal.GetDriverByName("MEM").Create("", columns, rows, 1, gdal.GDT_Byte)
        memory.SetGeoTransform((west, size, 0, north, 0, -size))
        memory.SetProjection(system(epsg).ExportToWkt())
        memory.GetRasterBand(1).Fill(255)
        for name in ("area", "square", "pavement", "path", "rail", "asphalt", "marking"):
            burn(memory, layers[name])
        self.classes = memory.GetRasterBand(1).ReadAsArray()
        plots = plot_classes(rng, columns * size, rows * size, unkempt)
        step = int(round(.4 / size))
        rr, cc = (np.arange(rows) // step), (np.arange(columns) // step)
        small = plots(west + (np.arange(columns // step + 1) + .5) * .4, north - (np.arange(rows // step + 1) + .5) * .4)
        for r in range(0, rows, 1000):
            part = self.classes[r:r + 1000]
            part[part == 255] = small[np.ix_(rr[r:r + 1000], cc)][part == 255]


def polygon(points):
    ring = ogr.Geometry(ogr.wkbLinearRing)
    for x, y in points:
        ring.AddPoint_2D(x, y)
    ring.CloseRings()
    g = ogr.Geometry(ogr.wkbPolygon)
    g.AddGeometry(ring)
    return g


def segment(a, b):
    g = ogr.Geometry(ogr.wkbLineString)
    g.AddPoint_2D(float(a[0]), float(a[1]))
    g.AddPoint_2D(float(b[0]), float(b[1]))
    return g


def burn(raster, shapes):
    if not shapes:
        return
    source = ogr.GetDriverByName("Memory").CreateDataSource("")
    layer = source.CreateLayer("", osr.SpatialReference(raster.GetProjection()), ogr.wkbUnknown)
    layer.CreateField(ogr.FieldDefn("c", ogr.OFTInteger))
    for g, c in shapes:
        f = ogr.Feature(layer.GetLayerDefn())
        f.SetGeometry(g)
        f.SetField("c", int(c))
        layer.CreateFeature(f)
    gdal.RasterizeLayer(raster, [1], layer, options=["ATTRIBUTE=c"])


def along(p, step, start=0.0):
    """Places every `step` metres on a polyline: (points (n, 2), unit directions (n, 2))."""
    d = np.diff(p, axis=0)
    lengths = np.hypot(d[:, 0], d[:, 1])
    total = lengths.sum()
    at = np.arange(start, total, step)
    if not len(at) or total < 1e-6:
        return np.zeros((0, 2)), np.zeros((0, 2))
    ends = np.cumsum(lengths)
    i = np.minimum(np.searchsorted(ends, at, side="right"), len(d) - 1)
    u = d[i] / np.maximum(lengths[i], 1e-9)[:, None]
    return p[i] + u * (at - (ends[i] - lengths[i]))[:, None], u


def dashes(p, length, gap):
    places, u = along(p, length + gap)
    return [(a, a + d * length) for a, d in zip(places, u)]


def zebra(p, half, rng):
    places, u = along(p, 1e9, start=float(rng.uniform(4, 12)))
    out = []
    for a, d in zip(places, u):
        n = np.array([-d[1], d[0]])
        for o in np.arange(-half + .5, half - .3, 1.0):
            out.append((a + n * o - d * 1.5, a + n * o + d * 1.5))
    return out


def plot_classes(rng, width, height, unkempt):
    """Function of grid axes -> class of each place: cells about seeds, turned at random, as gardens and yards are."""
    cell, turn = 15.0, rng.uniform(0, np.pi / 2)
    n = int(np.hypot(width, height) * 2 / cell) + 8
    jitter = rng.uniform(.1, .9, (n, n, 2)).astype(np.float32)
    kinds = rng.choice([PLOT_GRASS, PLOT_PAVED, PLOT_SOIL, PLOT_GRAVEL], (n, n), p=[.62 - unkempt * .5, .28, unkempt * .5, .10])

    def classes(xs, ys):
        out = np.zeros((len(ys), len(xs)), np.uint8)
        for r in range(0, len(ys), 200):
            x, y = np.meshgrid(xs, ys[r:r + 200])
            a, b = (np.cos(turn) * x - np.sin(turn) * y) / cell + n / 2, (np.sin(turn) * x + np.cos(turn) * y) / cell + n / 2
            i, j = a.astype(int), b.astype(int)
            best = np.full(x.shape, 1e9, np.float32)
            for di in (-1, 0, 1):
                for dj in (-1, 0, 1):
                    ii, jj = (i + di) % n, (j + dj) % n
                    d = np.maximum(np.abs(i + di + jitter[ii, jj, 0] - a), np.abs(j + dj + jitter[ii, jj, 1] - b))
                    near = d < best
                    best[near] = d[near]
                    out[r:r + 200][near] = kinds[ii, jj][near]
        return out
    return classes
