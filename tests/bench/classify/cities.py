#!/usr/bin/env python3
"""How well classification does in a city that it has never seen: each city of folds.csv is left out of the fit, classified by
the program and compared with what was hidden.

    cities.py --program build/release/tests/facts_table --tables DIR --shared ../shared --work DIR [--tree] > table.md

folds.csv names the extracts, their city and whether it lies in the regions that the program knows. Conditions (facts_table.cpp):
everything hidden; tenths; only this quarter hidden. Pool: cities inside the regions with 30 labels of the attribute and more,
each of which is one vote; smaller ones together are one vote. Places outside have a table of their own.
Baselines: the majority of the city itself (it knows the answer), the majority of the other cities, the median (majority) of
visible neighbours within 150 m, and --tree: a gradient-boosted tree on the same features (Debian: python3-sklearn) and what
neighbours say. Needs python3-numpy, python3-scipy.
"""
import argparse
import csv
import math
import os
import shutil
import subprocess
import sys
import tomllib

import numpy as np
from scipy.spatial import cKDTree

import common
import fit
from common import ERAS, ROOFS, STYLES
from evaluate import calibration, confusion  # noqa: F401

CONDITIONS = ("hidden", "tenths", "quarter")
TITLES = {"hidden": "everything hidden", "tenths": "tenths", "quarter": "this quarter hidden"}
LABELS = ["storeys", "roof_shape", "year"]  # rows without one count for contradictions alone: a tenth is enough
LEAST = 30  # labels that make a city a vote of its own
DECADES = [1840, 1860, 1880, 1900, 1920, 1940, 1960, 1980, 2000]  # borders of 20-year classes
REACH = 150  # m: neighbours of the baseline
STOREYS = list(range(0, 31))


def read_folds():
    with open(os.path.join(common.HERE, "folds.csv"), newline="") as f:
        return list(csv.DictReader(f))


def stem(file):
    return os.path.basename(file).split(".")[0]


def extract_of(a, file):
    """Surveys without map data are written as bare OSM first."""
    if not file.endswith(".gpkg"):
        return os.path.join(a.shared, "data/osm", file)
    out = os.path.join(a.work, stem(file) + ".osm")
    if not os.path.exists(out):
        subprocess.run([sys.executable, os.path.join(common.HERE, "reference_osm.py"), os.path.join(a.shared, "data", file), out], check=True)
    return out


class City:
    """The answers for all extracts of a city, each house once: what stands in an earlier extract of folds.csv counts."""

    def __init__(self, name, inside, tables, catalogue):
        self.name, self.inside = name, inside
        seen, parts = set(), []
        for t in tables:
            keep = [i for i in range(t.n) if t.ids[i] not in seen]
            seen.update(t.ids[i] for i in keep)
            parts.append((t, keep))
        number = lambda c: np.concatenate([t.number(c)[k] for t, k in parts])
        text = lambda c: [t.text(c)[i] for t, k in parts for i in k]
        self.features = parts[0][0].features
        self.X = np.concatenate([t.X[k] for t, k in parts])
        self.part = np.concatenate([np.full(len(k), j) for j, (_, k) in enumerate(parts)])
        self.place = np.stack([number("x"), number("y")], 1) + self.part[:, None] * 1e7  # extracts do not hear each other
        self.tenth = np.array([tenth_of(i) for t, k in parts for i in (t.ids[j] for j in k)])
        self.quarter = number("in_quarter") > 0
        self.house = (number("area") >= 10)
        self.ids = [t.ids[i] for t, k in parts for i in k]
        years, sure = number("year"), number("year_confidence")
        dated = np.array(text("t_start_date")) != ""
        dated |= ~np.isnan(years) & (np.array(text("t_building:architecture")) == "")
        self.dated = ~np.isnan(years) & (sure > 0.5) & dated
        self.year = years
        self.era = np.array([fit.era_of(y) if d else -1 for y, d in zip(years, self.dated)])
        self.decade = np.array([np.searchsorted(DECADES, y, side="right") if d else -1 for y, d in zip(years, self.dated)])
        told = number("storeys")
        self.storeys = np.where(told > 0, told, math.nan)
        self.roof = np.array([ROOFS.index(common.family(s)) if s else -1 for s in text("roof_shape")])
        self.answers = {}
        for c in CONDITIONS + ("tagged",):
            a = {"style": np.stack([number(f"{c}_style_{s}") for s in STYLES], 1),
                 "era": np.stack([number(f"{c}_era_{s}") for s in ERAS], 1),
                 "storeys": number(f"{c}_storeys"), "storeys_p": number(f"{c}_storeys_p"), "within_p": number(f"{c}_storeys_within"),
                 "roof": np.array([ROOFS.index(r) for r in text(f"{c}_roof")]), "roof_p": number(f"{c}_roof_p"),
                 "substyle": text(f"{c}_substyle"), "non_house": number(f"{c}_non_house") > 0}
            if f"{c}_year" in parts[0][0].column:
                own = np.array([middle(catalogue[s], e) for s, e in zip(a["substyle"], a["era"].argmax(1))])
                told = number(f"{c}_year")
                a["year"] = np.where(told > 0, told, own)
            else:
                a["year"] = np.array([middle(catalogue[s], e) for s, e in zip(a["substyle"], a["era"].argmax(1))])
            self.answers[c] = a

    def asked(self, condition):
        return self.quarter if condition == "quarter" else np.full(len(self.ids), True)

    def neighbours(self, condition, i, labelled):
        """Indices of houses whose label is visible when i is asked, within REACH."""
        if condition == "hidden":
            return []
        if not hasattr(self, "trees"):
            self.trees = {}
        key = id(labelled)
        if key not in self.trees:
            rows = np.where(labelled)[0]
            self.trees[key] = (labelled, rows, cKDTree(self.place[rows]) if len(rows) else None)
        _, rows, tree = self.trees[key]
        if tree is None:
            return []
        near = rows[tree.query_ball_point(self.place[i], REACH)]
        return near[self.tenth[near] != self.tenth[i]] if condition == "tenths" else near[~self.quarter[near]]


KYEARS = [(1500, 1839), (1840, 1918), (1919, 1945), (1946, 2030)]


def middle(years, era):
    """Of the years that a sub-style and an era have in common: the middle of construction_date."""
    low, high = max(years[0], KYEARS[era][0]), min(years[1], KYEARS[era][1])
    if low > high:
        low, high = KYEARS[era]
    return (low + high) / 2


def tenth_of(id_):
    """As part_of in facts_table.cpp."""
    mask = (1 << 64) - 1
    h = (int(id_[1:]) * 4 + "nwr".index(id_[0])) & mask
    h = ((h ^ (h >> 31)) * 0x7fb5d329728ea185) & mask
    h = ((h ^ (h >> 27)) * 0x81dadef4bc2dd44d) & mask
    return (h ^ (h >> 33)) % 10


# ---- questions: truth, answer, confidence of each -------------------------------------------------------------------

def question(city, name, condition):
    """(rows, truth, answer, confidence) of labelled houses."""
    a = city.answers[condition]
    ask = city.asked(condition)
    if name == "era":
        rows = np.where(ask & (city.era >= 0))[0]
        return rows, city.era[rows], a["era"][rows].argmax(1), a["era"][rows].max(1)
    if name == "decade":
        rows = np.where(ask & (city.decade >= 0))[0]
        return rows, city.decade[rows], np.searchsorted(DECADES, a["year"][rows], side="right"), None
    if name == "storeys":
        rows = np.where(ask & ~np.isnan(city.storeys) & (a["storeys"] > 0))[0]
        return rows, city.storeys[rows], a["storeys"][rows], a["storeys_p"][rows]
    rows = np.where(ask & (city.roof >= 0))[0]
    return rows, city.roof[rows], a["roof"][rows], a["roof_p"][rows]


def labels_of(city, name):
    return {"era": city.era >= 0, "decade": city.decade >= 0, "storeys": ~np.isnan(city.storeys), "roof": city.roof >= 0}[name]


def value_of(city, name):
    return {"era": city.era, "decade": city.decade, "storeys": city.storeys, "roof": city.roof}[name]


def majority(values, weights=None):
    best = np.unique(values)
    weights = np.ones(len(values)) if weights is None else weights
    return best[int(np.argmax([weights[values == v].sum() for v in best]))]


def votes(cities, pool, name):
    """{vote: [cities]}: a city with 30 labels is a vote, the smaller ones together are one."""
    out = {}
    for c in cities:
        n = int(labels_of(c, name).sum())
        if (c.inside == pool) and n > 0:
            out.setdefault(c.name if n >= LEAST else "smaller", []).append(c)
    return out


def scores(name, truth, answer, p, w):
    """Weighted figures; w sums to 1 per vote."""
    out = {"n": len(truth)}
    w = w / w.sum()
    if name == "storeys":
        out["within"] = (w * (np.abs(truth - answer) <= 1)).sum()
        out["accuracy"] = (w * (np.abs(truth - answer) < 0.5)).sum()
        out["mae"] = (w * np.abs(truth - answer)).sum()
        right = np.abs(truth - answer) < 0.5
    else:
        right = truth == answer
        out["accuracy"] = (w * right).sum()
        f1s, recalls = [], []
        for k in np.unique(truth):
            tp = (w * ((truth == k) & (answer == k))).sum()
            said, is_ = (w * (answer == k)).sum(), (w * (truth == k)).sum()
            f1s.append(2 * tp / (said + is_))
            recalls.append(tp / is_)
        out["f1"], out["balanced"] = float(np.mean(f1s)), float(np.mean(recalls))
    if p is not None:
        error = 0
        for b in range(10):
            inside = (p >= b / 10) & ((p < (b + 1) / 10) | (b == 9))
            if inside.any():
                error += abs((w[inside] * p[inside]).sum() - (w[inside] * right[inside]).sum())
        out["ece"] = error
    return out


def interval(name, groups, key, rounds=200):
    """95 % of the pooled figure: houses drawn again within their vote, fixed seed."""
    rng = np.random.default_rng(1)
    values = []
    for _ in range(rounds):
        rows = [(t[i], a[i]) for t, a in groups for i in (rng.integers(0, len(t), len(t)),)]
        w = np.concatenate([np.full(len(t), 1 / len(t)) for t, _ in rows])
        values.append(scores(name, np.concatenate([t for t, _ in rows]), np.concatenate([a for _, a in rows]), None, w)[key])
    return np.quantile(values, [0.025, 0.975])


MAIN = {"era": "accuracy", "decade": "f1", "storeys": "within", "roof": "accuracy"}
HEADS = {"era": ["accuracy", "balanced", "f1", "ece"], "decade": ["accuracy", "balanced", "f1"],
         "storeys": ["within", "accuracy", "mae", "ece"], "roof": ["accuracy", "balanced", "f1", "ece"]}
NAMES = {"era": "Era of four", "decade": "20-year classes", "storeys": "Storeys", "roof": "Roof family"}


def print_table(cities, pool, tree_answers=None, per_city=True):
    for name in NAMES:
        groups = votes(cities, pool, name)
        if not groups:
            continue
        heads = HEADS[name]
        print(f"\n### {NAMES[name]}, {'pool' if pool else 'outside the regions'}: {len(groups)} votes\n")
        print("| condition | who | n | " + " | ".join(heads) + f" | 95 % of {MAIN[name]} |")
        print("|---|---|---|" + "---|" * (len(heads) + 1))
        everybody = [c for c in cities if c.inside]
        for condition in CONDITIONS:
            rows = {}
            for vote, members in groups.items():
                for c in members:
                    r, truth, answer, p = question(c, name, condition)
                    if len(r) == 0:
                        continue
                    own = majority(truth)
                    others = [o for o in everybody if o.name != c.name and labels_of(o, name).any()]
                    values = np.concatenate([value_of(o, name)[labels_of(o, name)] for o in others])
                    weights = np.concatenate([np.full(labels_of(o, name).sum(), 1 / labels_of(o, name).sum()) for o in others])
                    elsewhere = majority(values, weights)
                    labelled = labels_of(c, name)
                    heard = []
                    for i in r:
                        near = c.neighbours(condition, i, c.__dict__.setdefault("mask_" + name, labelled))
                        said = value_of(c, name)[near] if len(near) else []
                        heard.append(elsewhere if len(said) == 0 else np.median(said) if name == "storeys" else majority(said))
                    entry = rows.setdefault(vote, {})
                    for who, a, q in (("ours", answer, p), ("own majority", np.full(len(r), own), None),
                                      ("majority elsewhere", np.full(len(r), elsewhere), None),
                                      ("neighbours", np.array(heard), None)):
                        if who == "neighbours" and condition == "hidden":
                            continue
                        entry.setdefault(who, []).append((truth, a, q))
                    if tree_answers and (c.name, name, condition) in tree_answers:
                        a, q = tree_answers[c.name, name, condition]
                        entry.setdefault("boosted tree", []).append((truth, a, q))
            if not rows:
                continue
            whos = ["ours", "own majority", "majority elsewhere", "neighbours", "boosted tree"]
            for who in whos:
                per = {v: [np.concatenate([x[k] for x in e[who]]) if e[who][0][k] is not None else None for k in range(3)]
                       for v, e in rows.items() if who in e}
                if not per:
                    continue
                w = np.concatenate([np.full(len(t), 1 / len(t)) for t, _, _ in per.values()])
                p = np.concatenate([q for _, _, q in per.values()]) if all(q is not None for _, _, q in per.values()) else None
                s = scores(name, np.concatenate([t for t, _, _ in per.values()]), np.concatenate([a for _, a, _ in per.values()]), p, w)
                low, high = interval(name, [(t, a) for t, a, _ in per.values()], MAIN[name]) if who == "ours" else (math.nan, math.nan)
                print(f"| {TITLES[condition]} | {who} | {s['n']} | " + " | ".join("%.3f" % s[h] if h in s else "–" for h in heads)
                      + (f" | {low:.2f}–{high:.2f} |" if who == "ours" else " | |"))
                if who == "ours" and per_city:
                    line = []
                    for v, (t, a, q) in sorted(per.items()):
                        o = scores(name, t, a, q, np.full(len(t), 1.0))
                        line.append(f"{v} {o[MAIN[name]]:.2f} (n {o['n']})")
                    note = f"{NAMES[name]}, {TITLES[condition]}, {MAIN[name]} by city: " + ", ".join(line)
                    NOTES.append(note)
        while NOTES:
            print("\n* " + NOTES.pop(0))


NOTES = []


def contradictions(cities, catalogue_class, catalogue_years):
    """Houses whose era and style exclude each other (no modern house before 1919, no Gründerzeit after)."""
    print("\n### Style, sub-style and era contradict each other, share of houses\n")
    print("| city | everything as tagged | everything hidden |\n|---|---|---|")
    total = {}
    for c in cities:
        line = []
        for condition in ("tagged", "hidden"):
            a = c.answers[condition]
            rows = np.where(~a["non_house"] & (c.X[:, c.features.index("area")] >= 40))[0]
            bad = 0
            for i in rows:
                era, style = int(a["era"][i].argmax()), int(a["style"][i].argmax())
                sub = catalogue_years[a["substyle"][i]]
                wrong = (style == 2 and era < 2) or (style in (0, 1) and era != 1)
                wrong = wrong or catalogue_class[a["substyle"][i]] != STYLES[style]
                wrong = wrong or max(sub[0], KYEARS[era][0]) > min(sub[1], KYEARS[era][1])
                bad += wrong
            line.append("%.3f" % (bad / max(len(rows), 1)))
            total.setdefault(condition, []).append(bad / max(len(rows), 1))
        print(f"| {c.name} | " + " | ".join(line) + " |")
    print("| mean of cities | " + " | ".join("%.3f" % np.mean(total[c]) for c in ("tagged", "hidden")) + " |")


def styles(cities):
    """Hand-made labels of style, per city, by geometry and context (everything hidden) and as tagged."""
    print("\n### Style of appearance, hand-made labels, each city one vote\n")
    print("| condition | n | accuracy | balanced | f1 | ece |\n|---|---|---|---|---|---|")
    labels = [r for r in common.read_labels() if r["style"] in STYLES and r["sure"] == "1"]
    by_id = {}
    for r in labels:
        by_id[(common.city(common.PLACE_OF[r["file"]]), r["id"])] = STYLES.index(r["style"])
    for condition in ("hidden", "tagged"):
        T, A, P, W = [], [], [], []
        for c in cities:
            rows = [(i, by_id[(c.name, id_)]) for i, id_ in enumerate(c.ids) if (c.name, id_) in by_id]
            for i, t in rows:
                T.append(t), A.append(int(c.answers[condition]["style"][i].argmax())), P.append(c.answers[condition]["style"][i].max()), W.append(1 / len(rows))
        s = scores("style", np.array(T), np.array(A), np.array(P), np.array(W))
        print(f"| {condition} | {s['n']} | {s['accuracy']:.3f} | {s['balanced']:.3f} | {s['f1']:.3f} | {s['ece']:.3f} |")


def read_catalogue(configs):
    """{id: (from, to)}, {id: class}"""
    with open(os.path.join(configs, "styles/catalogue.toml"), "rb") as f:
        raw = tomllib.load(f)
    raw = raw.get("style", raw)
    items = raw.items() if isinstance(raw, dict) else [(s["id"], s) for s in raw]
    return {k: tuple(v["years"]) for k, v in items if isinstance(v, dict)}, {k: v["class"] for k, v in items if isinstance(v, dict)}


def run(a, folds):
    """Answers of the program for all extracts, with weights that have not seen their city."""
    tables = fit.read_tables(a.tables)
    labels, areas = common.read_labels(), common.read_areas(a.shared, tables)
    trained = {common.city(p) for p in tables}
    configs = a.configs
    full = None
    os.makedirs(a.work, exist_ok=True)
    for city in dict.fromkeys(r["city"] for r in folds):
        files = [r["file"] for r in folds if r["city"] == city and (not a.only or city in a.only)]
        files = [f for f in files if not (a.small and f.startswith("berlin-2014"))]
        todo = [f for f in files if not os.path.exists(os.path.join(a.work, stem(f) + ".csv"))]
        if not todo:
            continue
        if city in trained:
            models = fit.fit_all(tables, a.shared, {city}, labels, areas)
        else:
            full = full or fit.fit_all(tables, a.shared, set(), labels, areas)
            models = full
        folder = os.path.join(a.work, "configs-" + city)
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(configs, folder)
        fit.write(models, os.path.join(folder, "styles/weights"))
        for f in todo:
            out = os.path.join(a.work, stem(f) + ".csv")
            subprocess.run([a.program, extract_of(a, f), folder, out + ".new", "conditions"], check=True,
                           stdout=subprocess.DEVNULL)
            os.rename(out + ".new", out)
            print(f"{city}: {f}", file=sys.stderr)


def read_cities(work, folds, configs, small=False):
    years, classes = read_catalogue(configs)
    ids = {r["id"] for r in common.read_labels()}
    out = []
    for city in dict.fromkeys(r["city"] for r in folds):
        rows = [r for r in folds if r["city"] == city and os.path.exists(os.path.join(work, stem(r["file"]) + ".csv"))]
        if small:
            rows = [r for r in rows if not r["file"].startswith("berlin-2014")]
        if rows:
            out.append(City(city, rows[0]["pool"] == "in", [common.Table(city, os.path.join(work, stem(r["file"]) + ".csv"), LABELS, ids) for r in rows], years))
    return out, years, classes


def boosted(cities):
    """{(city, question, condition): (answer, confidence)} of a tree that was trained on the other cities, each with the same weight."""
    from sklearn.ensemble import HistGradientBoostingClassifier
    hidden = ["tag_storeys", "tag_roof", "tag_roof_storeys", "tag_year"]
    keep = [i for i, f in enumerate(cities[0].features) if f not in hidden]
    out = {}
    for name in NAMES:
        for condition in CONDITIONS:
            data = {}
            for c in cities:
                rows, truth, _, _ = question(c, name, condition)
                if len(rows) == 0:
                    continue
                kinds = len(DECADES) + 1 if name == "decade" else 4 if name == "era" else 5 if name == "roof" else 12
                extra = np.full((len(rows), kinds + 1), math.nan)
                for k, i in enumerate(rows):
                    near = c.neighbours(condition, i, c.__dict__.setdefault("mask_" + name, labels_of(c, name)))
                    extra[k, -1] = len(near)
                    if len(near):
                        w = np.exp(-np.hypot(*(c.place[near] - c.place[i]).T) / 40)
                        said = value_of(c, name)[near].astype(float)
                        said = np.clip(np.round(said), 0, kinds - 1).astype(int)
                        extra[k, :-1] = np.bincount(said, w, kinds) / w.sum()
                y = np.clip(np.round(truth), 0, 11).astype(int) if name == "storeys" else truth.astype(int)
                data[c.name] = (np.hstack([c.X[rows][:, keep], extra]), y)
            inside = {c.name for c in cities if c.inside}
            for c in cities:
                if c.name not in data:
                    continue
                train = [k for k in data if k != c.name and k in inside]
                X = np.concatenate([data[k][0] for k in train])
                y = np.concatenate([data[k][1] for k in train])
                w = np.concatenate([np.full(len(data[k][1]), len(data[k][1]) ** -0.5) for k in train])
                model = HistGradientBoostingClassifier(max_iter=80, learning_rate=0.06, max_leaf_nodes=12, min_samples_leaf=15,
                                                       l2_regularization=2.0, random_state=1)
                model.fit(X, y, sample_weight=w / w.mean())
                P = model.predict_proba(data[c.name][0])
                out[c.name, name, condition] = (model.classes_[P.argmax(1)].astype(float), P.max(1))
            print(f"tree: {name}, {condition}", file=sys.stderr)
    return out


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", required=True)
    p.add_argument("--tables", required=True)
    p.add_argument("--shared", required=True)
    p.add_argument("--work", required=True, help="answers that lie there are taken as they are")
    p.add_argument("--configs", default=os.path.join(common.HERE, "../../../configs"))
    p.add_argument("--only", nargs="*", default=[])
    p.add_argument("--small", action="store_true", help="without the whole of Berlin")
    p.add_argument("--tree", action="store_true")
    a = p.parse_args()
    folds = read_folds()
    run(a, folds)
    cities, years, classes = read_cities(a.work, folds, a.configs, a.small)
    tree = boosted(cities) if a.tree else None
    print_table(cities, True, tree)
    styles(cities)
    contradictions(cities, classes, years)
    print_table(cities, False, tree)


if __name__ == "__main__":
    main()
