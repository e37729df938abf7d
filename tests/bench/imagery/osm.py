"""OSM extracts as plain Python: any format through osmium-tool into XML, nodes and ways and relations by iterparse."""
import os
import shutil
import subprocess
import tempfile
import xml.etree.ElementTree as ET

from osgeo import osr

osr.UseExceptions()


def as_xml(path):
    """Path of an .osm file with the same content: itself when it is one, else a file in a new folder that the caller removes."""
    if path.endswith(".osm"):
        return path
    folder = tempfile.mkdtemp(prefix="imagery_bench_")
    out = os.path.join(folder, os.path.basename(path).split(".")[0] + ".osm")
    subprocess.run(["osmium", "cat", path, "-o", out, "--overwrite"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return out


class Extract:
    """nodes: id -> (lon, lat, tags); ways: id -> (list of node ids, tags); relations: id -> (list of (type, ref, role), tags)."""

    def __init__(self, path):
        self.nodes, self.ways, self.relations = {}, {}, {}
        xml = as_xml(path)
        for _, e in ET.iterparse(xml):
            if e.tag not in ("node", "way", "relation"):
                continue
            if e.get("action") == "delete" or e.get("visible") == "false":
                e.clear()
                continue
            tags = {t.get("k"): t.get("v") for t in e.iter("tag")}
            i = int(e.get("id"))
            if e.tag == "node":
                if e.get("lon") is not None:
                    self.nodes[i] = float(e.get("lon")), float(e.get("lat")), tags
            elif e.tag == "way":
                self.ways[i] = [int(n.get("ref")) for n in e.iter("nd")], tags
            else:
                self.relations[i] = [(m.get("type"), int(m.get("ref")), m.get("role")) for m in e.iter("member")], tags
            e.clear()
        if xml != path:
            shutil.rmtree(os.path.dirname(xml))

    def project(self, epsg):
        """Node id -> (east, north) in the coordinate system; a dict."""
        to = transformation(4326, epsg)
        ids = list(self.nodes)
        out = to.TransformPoints([(self.nodes[i][0], self.nodes[i][1]) for i in ids])
        return {i: (p[0], p[1]) for i, p in zip(ids, out)}


def system(epsg):
    s = osr.SpatialReference()
    s.ImportFromEPSG(int(epsg))
    s.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return s


def transformation(source, target):
    return osr.CoordinateTransformation(system(source), system(target))


def utm_of(lon, lat):
    """EPSG code of the build's choice: ETRS89/UTM in Europe (zones 28 to 38), else WGS 84/UTM. Displacements are the same in both."""
    zone = int((lon + 180) // 6) + 1
    if 34 < lat < 72 and -12 < lon < 35:
        return 25800 + zone
    return (32600 if lat >= 0 else 32700) + zone
