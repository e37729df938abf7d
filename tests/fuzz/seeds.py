#!/usr/bin/env python3
"""Writes seeds for the fuzz targets, and dictionaries of their words, all made from what the repository has.

    seeds.py PROGRAM FOLDER     FOLDER/<target>/…, FOLDER/<target>.dict

tests/fuzz/found/<target>/ has inputs that once broke the program: they are seeds, too.

Readers of builds start from builds of a few houses of samples/blockrand-viertel.osm, which PROGRAM makes: a fuzzer
changes small files faster than large ones. Seeds that are there already are written anew; what a fuzzer found stays.
"""
import bz2
import gzip
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "samples" / "blockrand-viertel.osm"
# A garage and a hut; a church of several parts; a school around a courtyard.
CUTS = {"garage": ["w1215", "n9007"], "church": ["r102"], "school": ["r104"]}
# Larger seeds would be all that a fuzzer works on.
LARGEST = 150_000


def planted_errors(tree):
    """Ids of what the sample says of itself that it is mapped wrong."""
    return [element.tag[0] + element.get("id") for element in tree
            if any(tag.get("v").startswith("planted error") for tag in element.iter("tag"))]


def cut(tree, wanted):
    """The objects of the sample with these ids, and all that they refer to."""
    by_id = {element.tag[0] + element.get("id"): element for element in tree if element.get("id")}
    kept, todo = set(), list(wanted)
    while todo:
        name = todo.pop()
        if name in kept or name not in by_id:
            continue
        kept.add(name)
        todo += ["n" + nd.get("ref") for nd in by_id[name].iter("nd")]
        todo += [m.get("type")[0] + m.get("ref") for m in by_id[name].iter("member")]
    out = ET.Element(tree.tag, tree.attrib)
    out.extend(element for name, element in by_id.items() if name in kept)
    return ET.tostring(out, encoding="utf-8", xml_declaration=True)


class Seeds:
    def __init__(self, folder):
        self.folder = folder
        self.words = {}
        self.seen = set()
        self.count = 0

    def add(self, target, name, content, first=None):
        """`first`: the byte by which a target chooses its reader."""
        if isinstance(content, pathlib.Path):
            content = content.read_bytes()
        if isinstance(content, str):
            content = content.encode()
        if (target, first, content) in self.seen:
            return
        if len(content) > LARGEST:
            print(f"fuzz: {target}: no seed {name}, {len(content)} bytes are more than {LARGEST}")
            return
        self.seen.add((target, first, content))
        self.count += 1
        place = self.folder / target
        place.mkdir(parents=True, exist_ok=True)
        (place / f"seed_{name}").write_bytes((b"" if first is None else bytes([first])) + content)
        words = self.words.setdefault(target, {})
        for word in re.findall(rb"[A-Za-z_:][A-Za-z0-9_:.-]{2,30}", content):
            words[word] = words.get(word, 0) + 1

    def write_dictionaries(self):
        """The words that stand in seeds most often: a fuzzer would have to guess them letter by letter."""
        for target, words in self.words.items():
            chosen = sorted(words, key=lambda w: (-words[w], w))[:400]
            lines = [f'"{word.decode()}"' for word in sorted(chosen)]
            (self.folder / f"{target}.dict").write_text("\n".join(lines) + "\n")


def seed_extracts(seeds, extracts):
    for name, content in extracts.items():
        seeds.add("osm_import", name, content, 0)
        seeds.add("osm_import", name + "_gz", gzip.compress(content, mtime=0), 2)
        seeds.add("osm_import", name + "_bz2", bz2.compress(content), 3)
    if shutil.which("osmium"):
        with tempfile.TemporaryDirectory() as folder:
            for name, content in extracts.items():
                for kind in ("", ",pbf_compression=none"):
                    path = pathlib.Path(folder) / f"{name}.osm"
                    path.write_bytes(content)
                    made = pathlib.Path(folder) / "made.osm.pbf"
                    subprocess.run(["osmium", "cat", path, "-o", made, "-f", "pbf" + kind, "--overwrite"], check=True,
                                   capture_output=True)
                    seeds.add("osm_import", f"{name}_pbf{len(kind) > 0:d}", made, 1)


def seed_values(seeds):
    for i, value in enumerate(["12 m", "40'6\"", "3;4", "NNE", "#a33", "1,5", "C19", "gabled", "~1890..1900", "10 ft"]):
        seeds.add("tag_values", str(i), value)


def seed_rules(seeds):
    rules = {path.stem: path.read_text() for path in sorted((ROOT / "configs" / "grammars").rglob("*.cga"))}
    texts = (ROOT / "tests" / "unit" / "grammar" / "sample_rules.h").read_text()
    for i, text in enumerate(re.findall(r'R"\(\n?(.*?)\)"', texts, re.DOTALL)):
        rules[f"sample{i}"] = text
    rules["import"] = 'import other : "other.cga"\nLot --> extrude(3) comp(f) { side: other.Wall }\n----\nWall --> s(1, 1, 0)\n'
    for path in sorted((ROOT / "tests" / "unit" / "grammar" / "features").glob("*.cases")):
        for i, case in enumerate(re.split(r"\n(?==+|\[|---)", path.read_text())):
            rules[f"{path.stem}{i}"] = case
    for name, text in rules.items():
        for target in ("grammar", "derivation"):
            seeds.add(target, name, text)
    test = (ROOT / "tests" / "unit" / "grammar" / "language" / "bilke_import_test.cpp").read_text()
    for i, text in enumerate(re.findall(r'R"\((.*?)\)"', test, re.DOTALL)):
        if "<" in text:
            seeds.add("facade_rules", str(i), text)


def seed_configs(seeds, program):
    template = subprocess.run([program, "help", "options", "--toml"], check=True, capture_output=True, text=True).stdout
    seeds.add("configs", "config", re.sub(r"(?m)^# (\w+ = )", r"\1", template), 0)
    configs = ROOT / "configs"
    first = {"styles/presets.toml": 1, "defaults/uses.toml": 3, "materials/materials.toml": 4,
             "styles/catalogue.toml": 5, "styles/ground_floor.toml": 6, "styles/non_houses.toml": 7,
             "styles/tags.toml": 8, "styles/neighbours.toml": 9}
    for path in sorted(configs.rglob("*.toml")):
        name = path.relative_to(configs).as_posix()
        kind = first.get(name, {"districts": 2, "profiles": 11, "elements": 12, "weights": 10}.get(path.parent.name))
        if kind is not None:
            seeds.add("configs", name.replace("/", "_"), path, kind)
    test = (ROOT / "tests" / "unit" / "attributes" / "overrides_test.cpp").read_text()
    for i, text in enumerate(re.findall(r'R"\((.*?)\)"', test, re.DOTALL)):
        seeds.add("overrides", str(i), text)
    seeds.add("overrides", "all", """[w1]
storeys = 4
height = 14.5
roof_shape = "gabled"
roof_height = 3
wall_colour = "#aabbcc"
wall_material = "brick"
construction_date = "1895..1902"
preset = "gz_plain"
[w1.storey.0]
height = 4.2
use = "retail"
parameters.sign = "x"
[w1.edge.e11_12]
kind = "street"
[w1.bay.3]
width = 2
["w2.w3"]
roof_pitch = 30
""")


def small_geopackage(path):
    """With small pages and without what only people and GIS programs read, the same rows take a quarter of the bytes."""
    database = sqlite3.connect(path)
    database.execute("UPDATE layer_styles SET styleQML = '<qgis/>', styleSLD = NULL")
    database.execute("DELETE FROM gpkg_data_columns WHERE rowid > 12")
    for (trigger,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
        database.execute(f'DROP TRIGGER "{trigger}"')
    database.commit()
    database.execute("PRAGMA page_size = 512")
    database.execute("VACUUM")
    database.close()
    return path


def seed_build(seeds, name, out):
    """The files of one build."""
    for glb in sorted(out.rglob("*.glb")):
        seeds.add("glb", f"{name}_{glb.stem}", glb)
        seeds.add("reference", f"{name}_{glb.stem}_glb", glb, 2)
    for gml in sorted(out.rglob("*.gml")):
        seeds.add("citygml", name, gml)
        seeds.add("reference", name + "_gml", gml, 0)
    for sequence in sorted(out.rglob("*.city.jsonl")):
        seeds.add("cityjson", name, sequence, 1)
        seeds.add("reference", name + "_cityjson", sequence, 1)
    for whole in sorted(out.glob("*.city.json")):
        seeds.add("cityjson", name + "_object", whole, 0)
    seeds.add("tileset", name, out / "tileset.json")
    seeds.add("reference", name + "_tileset", out / "tileset.json", 3)
    seeds.add("geopackage", name, small_geopackage(out / "buildings.gpkg"))
    with zipfile.ZipFile(out / "buildings.qgz") as project:
        seeds.add("qgis_project", name + "_archive", out / "buildings.qgz", 0)
        # Nobody reads the symbols back.
        text = re.sub(rb"<symbols>.*?</symbols>", b"<symbols/>", project.read("buildings.qgs"), flags=re.S)
        seeds.add("qgis_project", name + "_project", text, 1)
    seeds.add("build_record", name + "_build", out / "build.json", 0)
    seeds.add("build_record", name + "_report", out / "report.json", 1)
    # The pictures are most of the page, and nobody reads them back.
    seeds.add("build_record", name + "_page", re.sub(r"base64,[A-Za-z0-9+/=]+", "base64,AAAA",
                                                     (out / "report.html").read_text()), 2)
    seeds.add("build_record", name + "_index", out / "explain" / "index.txt", 3)
    places = (out / "explain" / "places.tsv").read_bytes()
    for records in sorted((out / "explain").glob("*.jsonl.gz")):
        seeds.add("build_record", name + "_records", gzip.decompress(records.read_bytes()), 4)
        tile = records.name.split(".")[0].encode()
        seeds.add("build_record", name + "_places",
                  (places + gzip.decompress(records.read_bytes())).replace(tile, b"15_1_2"), 5)


def seed_builds(seeds, program, extracts, folder):
    """Builds in several ways, so that every kind of file is there."""
    for extract, way, options in [
            ("garage", "lod1", ["--lod", "1"]), ("garage", "lod3", ["--lod", "3", "--single-glb", "--compress", "none"]),
            ("garage", "meshopt", ["--lod", "3", "--compress", "meshopt"]),
            ("garage", "nodes", ["--lod", "3", "--instancing", "nodes", "--evidence", "--compress", "none"]),
            ("church", "lod2", ["--lod", "2", "--single-cityjson"]), ("school", "lod2", ["--lod", "2", "--evidence"])]:
        path = folder / f"{extract}.osm"
        path.write_bytes(extracts[extract])
        out = folder / f"{extract}_{way}"
        subprocess.run([program, "build", path, "-o", out, "--quiet", "--jobs", "1", "--ground-height", "150",
                        *options], check=True)
        seed_build(seeds, f"{extract}_{way}", out)


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    tree = ET.parse(SAMPLE).getroot()
    extracts = {name: cut(tree, wanted) for name, wanted in CUTS.items()}
    seeds = Seeds(folder)
    seed_values(seeds)
    seed_extracts(seeds, {**extracts, "errors": cut(tree, planted_errors(tree))})
    seed_rules(seeds)
    seed_configs(seeds, program)
    with tempfile.TemporaryDirectory() as scratch:
        seed_builds(seeds, program, extracts, pathlib.Path(scratch))
    for found in sorted((ROOT / "tests" / "fuzz" / "found").glob("*/*")):
        seeds.add(found.parent.name, f"found_{found.name}", found)
    seeds.write_dictionaries()
    print(f"fuzz: {seeds.count} seeds for {len(seeds.words)} targets in {folder}")


if __name__ == "__main__":
    main()
