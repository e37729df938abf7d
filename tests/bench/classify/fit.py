#!/usr/bin/env python3
"""Fits the weights of configs/styles/weights/*.toml: one multinomial logistic regression on binned features per question.

    fit.py --tables DIR --shared ../shared -o configs/styles/weights [--leave PLACE ...]

DIR holds PLACE.csv for the places of common.FILES, made by facts_table. --leave keeps places out (k-fold by place).
Needs python3-numpy and python3-scipy (Debian).
"""
import argparse
import glob
import math
import os

import numpy as np
from scipy.optimize import minimize
from scipy.sparse import csr_matrix

import common
from common import ERAS, MORPHOLOGIES, ROOFS, STOREYS, STYLES

# Features that a question may ask. Left out are those whose value is a town's and not a house's (they would learn the
# names of the towns they were fitted on), and those that say the same as a better one.
TOWN = {"town_built", "town_party_share", "town_density"}
TAGS = {"tag_storeys", "tag_roof", "tag_roof_storeys", "tag_use", "tag_year", "tag_heritage", "tag_shop", "tag_number"}
# Edges where bins are categories.
EDGES = {"tag_roof": [1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5], "tag_use": [v + 0.5 for v in range(12)],
         "tag_storeys": [1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 8.5], "tag_year": [1840, 1919, 1946], "tag_roof_storeys": [0.5, 1.5],
         "tag_heritage": [1.5], "tag_shop": [], "tag_number": [0.5], "position": [1.5, 2.5, 3.5, 4.5, 5.5],
         # Where docs/style_measures.md 3.3 and 1.2 see the borders of morphologies: quantiles of the data cut elsewhere.
         "around_area": [60, 80, 110, 160, 230, 300, 480, 800], "around_frontage": [7.5, 9.5, 12, 15, 20, 24],
         "around_count": [10, 20, 30, 42, 60], "around_party_share": [0.06, 0.12, 0.22, 0.4, 0.55],
         "around_built": [0.12, 0.18, 0.24, 0.3, 0.36, 0.5, 0.62], "around_elongation": [1.2, 1.4, 1.7, 2.2],
         "around_depth": [8, 10, 12, 14, 16], "row_breadth": [9, 11, 13, 16, 20], "row_length": [15, 30, 60, 100],
         "setback": [0.25, 1, 3, 8], "rectangularity": [0.7, 0.84, 0.94, 0.99], "row_fill": [0.5, 0.7, 0.85, 0.97], "row_alike": [0.25, 0.75],
         "street_class": [4.5, 5.5, 6.5, 7.5], "yards": [0.5, 1.5], "neighbours": [0.5, 1.5, 2.5]}


ITERATIONS = 100  # of the fit; the last fifty change no weight by 0.01
MOST = 1500  # houses of one town that are looked at for dates, storeys and roofs: more of the same town teach nothing of the next


def spread(rows):
    """At most MOST of them, evenly."""
    return rows if len(rows) <= MOST else rows[np.linspace(0, len(rows) - 1, MOST).astype(int)]


class Model:
    """log-odds = prior + sum of weights of bins. Penalty: small weights, and neighbouring bins alike."""

    def __init__(self, features, answers, bins, l2, smooth=0.3):
        self.features, self.answers, self.bins, self.l2, self.smooth = features, answers, bins, l2, smooth

    def edges_of(self, name, values):
        if name in EDGES:
            return np.array(EDGES[name], float)
        values = values[~np.isnan(values)]
        if len(values) == 0:
            return np.array([])
        cuts = np.quantile(values, np.arange(1, self.bins) / self.bins)
        edges = np.unique([float("%.2g" % c) for c in cuts])
        # An edge in the rounding of its values would part what is equal.
        return edges[(edges > values.min() + 0.05) & (edges < values.max())]

    def bins_of(self, X):
        out = np.full(X.shape, -1)
        for j, e in enumerate(self.edges):
            known = ~np.isnan(X[:, j])
            out[known, j] = np.searchsorted(e, X[known, j], side="right")
        return out

    def fit(self, X, y, w):
        k, n = len(self.answers), len(y)
        self.base = [w[y == i].sum() / w.sum() for i in range(k)]
        self.edges = [self.edges_of(f, X[:, j]) for j, f in enumerate(self.features)]
        self.start = np.cumsum([0] + [len(e) + 1 for e in self.edges])
        m = self.start[-1]
        b = self.bins_of(X)
        rows, cols = np.nonzero(b >= 0)
        Z = csr_matrix((np.ones(len(rows)), (rows, b[rows, cols] + self.start[cols])), shape=(n, m))
        left = np.array([self.start[j] + i for j in range(len(self.edges)) for i in range(len(self.edges[j]))], int)
        # Categories have no neighbours.
        plain = np.array([0.0 if self.features[j] in ("tag_roof", "tag_use", "position") else 1.0
                          for j in range(len(self.edges)) for _ in range(len(self.edges[j]))])[:, None]
        share = w / w.sum()
        Y = np.zeros((n, k))
        Y[np.arange(n), y] = 1
        l2 = self.l2 / len(self.features)

        def loss(p):
            prior, T = p[:k], p[k:].reshape(m, k)
            L = Z @ T + prior
            L -= L.max(1, keepdims=True)
            E = np.exp(L)
            P = E / E.sum(1, keepdims=True)
            R = (P - Y) * share[:, None]
            D = (T[left + 1] - T[left]) * plain
            value = -(share * np.log(P[np.arange(n), y] + 1e-12)).sum() + l2 / 2 * (T ** 2).sum() + 2 * self.smooth * l2 * (D ** 2).sum()
            G = Z.T @ R + l2 * T
            np.add.at(G, left + 1, 4 * self.smooth * l2 * D)
            np.add.at(G, left, -4 * self.smooth * l2 * D)
            return value, np.r_[R.sum(0), G.ravel()]

        p = minimize(loss, np.zeros(k + m * k), jac=True, method="L-BFGS-B", options={"maxiter": ITERATIONS}).x
        self.prior, self.T = p[:k], p[k:].reshape(m, k)
        # Only differences between answers count.
        self.prior = self.prior - self.prior.mean()
        self.T = self.T - self.T.mean(1, keepdims=True)
        return self

    def log_odds(self, X):
        b = self.bins_of(X)
        L = np.tile(self.prior, (len(X), 1))
        for j in range(len(self.features)):
            known = b[:, j] >= 0
            L[known] += self.T[self.start[j] + b[known, j]]
        return L

    def toml(self, title):
        def number(v):
            return "0" if abs(v) < 0.005 else ("%.2f" % v).rstrip("0").rstrip(".")
        out = [f"# {line}" for line in title] + [""]
        out.append("answers = [" + ", ".join(f'"{a}"' for a in self.answers) + "]\n")
        out.append("[prior]")
        out += [f"{quoted(a)} = {number(v)}" for a, v in zip(self.answers, self.prior)]
        out.append("\n[base]")
        out += [f"{quoted(a)} = {max(v, 1e-4):.4f}" for a, v in zip(self.answers, self.base)]
        for j, f in enumerate(self.features):
            T = self.T[self.start[j]:self.start[j + 1]]
            if np.abs(T).max() < 0.02:
                continue
            out.append(f"\n[feature.{f}]")
            out.append("edges = [" + ", ".join("%g" % e for e in self.edges[j]) + "]")
            out += [f"{quoted(a)} = [" + ", ".join(number(v) for v in T[:, i]) + "]" for i, a in enumerate(self.answers)]
        return "\n".join(out) + "\n"


def quoted(a):
    return f'"{a}"' if not a.replace("_", "").isalpha() else a


# Set by hand: what the classes are by definition, and labels are too few to learn. A class is a time and a kind of house
# (issue 8): a date decides between the times, a church is `other` whenever it was built. Log-odds in the order of STYLES.
BY_HAND = {("style", "tag_year"): {0: (-1.5, -1.5, -2.5, 2.5), 1: (1.0, 1.0, -3.0, 0.0), 2: (-2.5, -2.5, 2.5, -0.5), 3: (-3.0, -3.0, 3.0, -1.0)},
           ("style", "tag_use"): {5: (-2.0, -1.0, -1.0, 3.0), 8: (-1.0, 0.0, 0.0, 1.0), 9: (-2.0, -3.0, -1.5, 5.0)},
           ("style", "tag_heritage"): {0: (0.0, 0.0, 0.0, 0.0), 1: (0.3, 0.0, -0.7, 0.4)}}


def set_by_hand(name, model):
    for (question, feature), bins in BY_HAND.items():
        if question == name and feature in model.features:
            first = model.start[model.features.index(feature)]
            for b, weights in bins.items():
                model.T[first + b] = weights


def labelled(tables, labels, question, answers):
    """Rows of the hand-made labels: features, answer, weight, label."""
    out = []
    for r in labels:
        place = common.PLACE_OF[r["file"]]
        if place in tables and r["id"] in tables[place].index and r[question] in answers:
            out.append((tables[place].X[tables[place].index[r["id"]]], answers.index(r[question]), 1.0 if r["sure"] == "1" else 0.4, r))
    return out


def left_out(place, leave):
    return place in leave or common.city(place) in leave


def fit_all(tables, shared, leave=(), labels=None, areas=None, only=None):
    """The five models without the places of `leave`: names of extracts, cities, label places, or areas."""
    leave = set(leave)
    labels = common.read_labels() if labels is None else labels
    areas = common.read_areas(shared, tables) if areas is None else areas
    all_features = next(iter(tables.values())).features
    geometry = [f for f in all_features if f not in TAGS and f not in TOWN]
    models = {}
    feature_index = {f: i for i, f in enumerate(all_features)}

    def train(name, features, answers, rows, bins, l2, smooth=0.3):
        if only and name not in only:
            return
        X = np.array([r[0] for r in rows])[:, [feature_index[f] for f in features]]
        y = np.array([r[1] for r in rows])
        w = np.array([r[2] for r in rows])
        models[name] = Model(features, answers, bins, l2, smooth).fit(X, y, w)
        set_by_hand(name, models[name])

    def used(label):
        place = common.PLACE_OF[label["file"]]
        return not left_out(place, leave) and label["place"] not in leave

    # Style: labels alone.
    rows = [r for r in labelled(tables, labels, "style", STYLES) if used(r[3])]
    train("style", geometry + sorted(TAGS), STYLES, rows, bins=6, l2=1.0)

    # Era: dates of houses, each town with the same weight, those outside the regions with half of it. Labels made by hand and
    # circles are left out: they show what was looked for (quarters of the 1920s had two fifths of the weight), not how many there are.
    rows = []
    by_town = {}
    for place, t in tables.items():
        if left_out(place, leave):
            continue
        years, sure = t.number("year"), t.number("year_confidence")
        named = np.array(t.text("t_building:architecture")) != ""
        for i in spread(np.where(~np.isnan(years) & (sure > 0.5) & (t.feature("area") >= 10) & ~named)[0]):
            by_town.setdefault(common.city(place), []).append((t.X[i], era_of(years[i]), 0.5 if place in common.OUTSIDE else 1.0))
    few = [r for town in by_town.values() if len(town) < FEW for r in town]  # small ones together are one town
    for town in [t for t in by_town.values() if len(t) >= FEW] + [few]:
        rows += [(x, e, w / len(town)) for x, e, w in town]
    train("era", geometry + ["tag_heritage", "tag_number", "tag_shop", "tag_use"], ERAS, rows, bins=6, l2=6.0)

    # Morphology: the circles, each class with the same weight.
    rows = []
    weight = {}
    for name, place, kind, houses in areas:
        if left_out(place, leave) or name in leave or kind not in common.AREA_MORPHOLOGY:
            continue
        for x in tables[place].X[houses]:
            rows.append((x, MORPHOLOGIES.index(common.AREA_MORPHOLOGY[kind]), 1.0 / math.sqrt(len(houses))))
    rows += hand_score(feature_index)
    train("morphology", geometry, MORPHOLOGIES, rows, bins=6, l2=0.5)

    # Storeys and roofs: what is tagged; towns count by the root of their size, so that the largest does not speak alone.
    for name, answers in (("storeys", [str(s) for s in STOREYS]), ("roof", ROOFS)):
        rows = []
        for place, t in tables.items():
            if left_out(place, leave) or place in common.OUTSIDE:
                continue
            told = t.number("storeys") if name == "storeys" else np.array([math.nan if s == "" else 1 for s in t.text("roof_shape")])
            chosen = spread(np.where(~np.isnan(told) & (told > 0))[0])
            shapes = t.text("roof_shape")
            for i in chosen:
                y = int(np.argmin([abs(s - told[i]) for s in STOREYS])) if name == "storeys" else ROOFS.index(common.family(shapes[i]))
                rows.append((t.X[i], y, len(chosen) ** -0.5))
        asked = geometry + (["tag_use", "tag_roof", "tag_number", "tag_heritage", "tag_shop"] if name == "storeys"
                            else ["tag_use", "tag_storeys", "tag_number", "tag_heritage"])
        train(name, asked, answers, rows, bins=6, l2=1.0)
    return models


# Ranges in which the hand score of docs/style_measures.md 3.3 is full, and block shares of its 2.2: houses drawn from them stand
# for the morphologies that few circles show (terraces: one).
HAND_SCORE = {
    "perimeter_block": {"around_party_share": (.22, .55), "around_area": (230, 480), "around_frontage": (15, 24), "around_depth": (12, 16),
                        "around_built": (.3, .5), "depth_ratio": (1.35, 2.5), "street_distance": (6, 16), "corners": (6, 12),
                        "block_built": (.35, .6), "area": (230, 600), "frontage": (14, 24)},
    "old_town": {"around_area": (60, 190), "around_frontage": (4, 13), "around_party_share": (.2, .9), "around_built": (.36, .8),
                 "street_distance": (1, 6), "block_area": (.2, 1.2), "around_count": (42, 120), "block_built": (.35, .85),
                 "area": (80, 260), "frontage": (5, 14)},
    "slab": {"around_party_share": (0, .06), "around_area": (400, 1500), "around_count": (2, 10), "around_elongation": (1.7, 8),
             "around_built": (.08, .24), "rectangularity": (.96, 1.0), "block_built": (.12, .28), "area": (400, 1500), "row_breadth": (9, 18),
             "row_length": (30, 120)},
    "detached": {"around_party_share": (0, .08), "around_area": (80, 240), "around_built": (.06, .2), "around_count": (14, 45),
                 "around_elongation": (1, 1.4), "street_distance": (10, 40), "block_built": (.15, .27), "area": (80, 380), "party_share": (0, .05)},
    "terrace": {"around_frontage": (4.5, 7.5), "around_area": (40, 80), "around_party_share": (.4, 1), "around_depth": (8, 12),
                "around_built": (.12, .25), "around_count": (40, 200), "block_built": (.15, .28), "area": (40, 80), "frontage": (4.5, 7.5),
                "front_depth": (8, 12), "party_share": (.4, .8), "row_count": (4, 14)}}
HAND_WEIGHT = 750.0  # of all drawn houses together; a circle of 400 houses has 20. With 300 an unseen terrace is told as detached


def hand_score(feature_index, each=100):
    rng = np.random.default_rng(20261122)
    rows = []
    for name, ranges in HAND_SCORE.items():
        for _ in range(each):
            x = np.full(len(feature_index), math.nan)
            for f, (low, high) in ranges.items():
                x[feature_index[f]] = rng.uniform(low, high)
            rows.append((x, MORPHOLOGIES.index(name), HAND_WEIGHT / (each * len(HAND_SCORE))))
    return rows


FEW = 30  # dates


def era_of(year):
    return 0 if year < 1840 else 1 if year < 1919 else 2 if year < 1946 else 3


TITLES = {
    "style": ["Which class of appearance: log-odds per feature and bin.", "Fitted on tests/bench/classify/labels.csv (labelled by hand)."],
    "era": ["When it was built.", "Fitted on mapped dates, each town with the same weight."],
    "morphology": ["How the houses of the quarter stand (references/styles.md 3.3).", "Fitted on the circles of labels/areas.csv."],
    "storeys": ["Full storeys, where neighbours do not tell.", "Fitted on tagged storeys."],
    "roof": ["Family of the roof's shape, where neighbours do not tell.", "Fitted on tagged roofs."]}


def write(models, folder):
    os.makedirs(folder, exist_ok=True)
    for name, model in models.items():
        title = TITLES[name] + ["Made by tests/bench/classify/fit.py, which names the data; read by hand. Features: styles/classify/features.h.",
                                "log-odds(answer) = prior + the weight of the bin that each known feature lies in; bin i is [edge i-1, edge i)."]
        with open(os.path.join(folder, name + ".toml"), "w") as f:
            f.write(model.toml(title))


def read_tables(folder):
    return {p: common.Table(p, os.path.join(folder, common.FILES[p].split(".")[0] + ".csv")) for p in common.FILES
            if os.path.exists(os.path.join(folder, common.FILES[p].split(".")[0] + ".csv"))}


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--tables", required=True)
    arguments.add_argument("--shared", required=True)
    arguments.add_argument("-o", "--output", required=True)
    arguments.add_argument("--leave", nargs="*", default=[])
    a = arguments.parse_args()
    write(fit_all(read_tables(a.tables), a.shared, a.leave), a.output)


if __name__ == "__main__":
    main()
