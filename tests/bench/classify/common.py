"""What fit.py and evaluate.py share: the tables of facts_table, the labels, the fitted form of the model."""
import csv
import math
import os

import numpy as np

STYLES = ["gruenderzeit", "tenement", "modern", "other"]
ERAS = ["pre1840", "1840_1918", "1919_1945", "post1945"]
MORPHOLOGIES = ["perimeter_block", "old_town", "slab", "detached", "terrace"]
ROOFS = ["flat", "gabled", "hipped", "mansard", "other"]
STOREYS = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 14]
HERE = os.path.dirname(os.path.abspath(__file__))

FILES = {
    "luisenstadt": "berlin-luisenstadt-2021.osm", "zionskirchplatz": "berlin-zionskirchplatz-2020.osm",
    "frankfurter_allee": "berlin_frankfurter_allee.osm.pbf", "karl_marx_allee": "berlin_karl_marx_allee.osm.pbf",
    "husum": "husum_altstadt.osm.pbf", "ingolstadt": "ingolstadt-altstadt.osm", "helsinki": "helsinki-centre-2019.osm.pbf",
    "dortmund": "dortmund-innenstadt.osm.gz", "liechtenstein": "liechtenstein-2022-12.osm.pbf", "monaco": "monaco-2021.osm.pbf",
    "lauf": "lauf-2020-clipped.osm.pbf", "berlin": "berlin-2014-06.osm.pbf", "berlin_mitte": "berlin-mitte-2022.osm.gz",
    "berlin_schillerkiez": "berlin-schillerkiez-2019.osm.gz", "prague": "prague-vinohrady.osm.gz", "zuerich": "zuerich-niederdorf-2025.osm.pbf",
    "karlsruhe": "karlsruhe-suedweststadt-2026.osm.pbf", "geneve": "geneve-2020s.osm.pbf", "dreieich": "dreieich-2022.osm.gz",
    "piestany": "piestany-2025.osm.gz",
    # Outside the regions that the program knows: for dates alone, of which there are few inside, and with half the weight.
    "zeeland": "zeeland-brabant-2021.osm.pbf", "volgograd": "volgograd-traktorny-2024.osm.gz", "vichy": "vichy-eubucco-v0.osm"}
OUTSIDE = {"zeeland", "volgograd", "vichy"}
PLACE_OF = {v: k for k, v in FILES.items()}


def city(place):
    """All Berlin extracts are one place: they show the same houses."""
    return "berlin" if place in ("luisenstadt", "zionskirchplatz", "frankfurter_allee", "karl_marx_allee") or place.startswith("berlin") else place


FAMILY = {"flat": "flat", "gabled": "gabled", "gabled_height_moved": "gabled", "hipped": "hipped", "half-hipped": "hipped", "side_hipped": "hipped",
          "side_half-hipped": "hipped", "hipped-and-gabled": "hipped", "pyramidal": "hipped", "mansard": "mansard", "gambrel": "mansard"}


def family(shape):
    return FAMILY.get(shape, "other")


class Table:
    """One CSV of facts_table."""

    def __init__(self, place, path, asked=None, ids=()):
        """asked: columns; a row is kept that has something in one of them or one of the ids, and every tenth of the others."""
        self.place = place
        with open(path, newline="") as f:
            reader = csv.reader(f)
            self.head = next(reader)
            columns = [self.head.index(c) for c in asked or []]
            rows = [r for i, r in enumerate(reader) if not asked or i % 10 == 0 or r[0] in ids or any(r[c] for c in columns)]
        self.column = {name: i for i, name in enumerate(self.head)}
        first = self.column["area"]
        last = self.column["tag_number"]
        self.features = self.head[first:last + 1]
        self.n = len(rows)
        self.rows = rows
        self.ids = [r[0] for r in rows]
        self.index = {id_: i for i, id_ in enumerate(self.ids)}
        self.X = np.array([[float(v) if v else math.nan for v in r[first:last + 1]] for r in rows]) if rows else np.zeros((0, last + 1 - first))
        self.X = np.floor(self.X * 256 + 0.5) / 256  # as facts_extract

    def text(self, name):
        i = self.column[name]
        return [r[i] for r in self.rows]

    def number(self, name):
        return np.array([float(v) if v else math.nan for v in self.text(name)])

    def feature(self, name):
        return self.X[:, self.features.index(name)]


def read_labels(path=os.path.join(HERE, "labels.csv")):
    with open(path, newline="") as f:
        return list(csv.DictReader(f))


# A rebuilt centre is none of the five: its streets are a perimeter block's, its houses an old town's.
AREA_MORPHOLOGY = {"gruenderzeit_tenement_block": "perimeter_block", "gruenderzeit_suburban": "perimeter_block",
                   "gruenderzeit_block_late": "perimeter_block", "villa": "detached", "garden_terrace_1920s": "terrace",
                   "zeilenbau_1920s": "slab", "reform_block_1920s": "slab", "postwar_slab": "slab", "panel_estate": "slab",
                   "estate_1960s": "slab", "detached": "detached", "old_town": "old_town"}
AREA_ERA = {"gruenderzeit_tenement_block": "1840_1918", "gruenderzeit_suburban": "1840_1918", "gruenderzeit_block_late": "1840_1918",
            "garden_terrace_1920s": "1919_1945", "zeilenbau_1920s": "1919_1945", "reform_block_1920s": "1919_1945",
            "postwar_slab": "post1945", "panel_estate": "post1945", "estate_1960s": "post1945", "old_town": "pre1840", "postwar_centre": "post1945"}


def read_areas(shared, tables):
    """(name, place, class, indices of houses in it) of each circle of labels/areas.csv."""
    out = []
    with open(os.path.join(shared, "data/labels/areas.csv"), newline="") as f:
        for r in csv.DictReader(f):
            place = PLACE_OF.get(r["file"])
            if place not in tables:
                continue
            t = tables[place]
            inside = (t.feature("area") >= 40) & (np.array(t.text("non_house")) == "")
            if r["lon"]:
                east = (t.number("lon") - float(r["lon"])) * 111320 * math.cos(math.radians(float(r["lat"])))
                north = (t.number("lat") - float(r["lat"])) * 110540
                inside &= np.hypot(east, north) <= float(r["radius_m"])
            out.append((r["place"], place, r["class"], np.where(inside)[0]))
    return out
