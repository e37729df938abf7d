#!/usr/bin/env python3
"""Chooses the values of configs/styles/neighbours.toml that the weights do not hold, without the city they are scored on: for each
city left out the value that is best on the others (each vote one voice, as in cities.py), and what the city scores with that.

    nested.py --program build/release/tests/facts_table --tables DIR --shared ../shared --work DIR [--weights DIR] > table.md

Each value is run once on all extracts (without the whole of Berlin), with weights fitted without the city (cities.py, run).
--weights: a folder of an earlier run of cities.py, whose configs-CITY/styles/weights are taken instead of fitting anew.
"""
import argparse
import glob
import os
import re
import shutil
import subprocess
import sys

import numpy as np

import cities as bench
import common
import fit
from common import STYLES

# Runs: priors of [era] and [roof] move together (neither hears the other), then [style] with the shipped priors.
PRIORS = [("0.2", "0.1"), ("0.5", "0.2"), ("1", "0.5"), ("2", "1")]
DECISIONS = ["0.2", "0.3", "0.5", "1"]  # era


def write_values(path, values):
    with open(path) as f:
        text = f.read()
    for (table, key), value in values.items():
        head, tail = text.split(f"[{table}]\n")
        tail, n = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", tail, count=1)
        assert n == 1, (table, key)
        text = head + f"[{table}]\n" + tail
    with open(path, "w") as f:
        f.write(text)


def answers(a, name, values, folds):
    work = os.path.join(a.work, name)
    os.makedirs(work, exist_ok=True)
    for r in folds:
        out = os.path.join(work, bench.stem(r["file"]) + ".csv")
        if os.path.exists(out):
            continue
        folder = os.path.join(work, "configs")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(a.configs, folder)
        for f in glob.glob(os.path.join(a.weights, f"configs-{r['city']}", "styles/weights/*.toml")):
            shutil.copy(f, os.path.join(folder, "styles/weights"))
        write_values(os.path.join(folder, "styles/neighbours.toml"), values)
        subprocess.run([a.program, bench.extract_of(a, r["file"]), folder, out + ".new", "conditions"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.rename(out + ".new", out)
    return bench.read_cities(work, folds, a.configs, small=True)[0]


def fitted(a, folds):
    tables = fit.read_tables(a.tables)
    labels, areas = common.read_labels(), common.read_areas(a.shared, tables)
    for city in dict.fromkeys(r["city"] for r in folds):
        fit.write(fit.fit_all(tables, a.shared, {city}, labels, areas), os.path.join(a.work, f"configs-{city}", "styles/weights"))
    return a.work


def right(cities, name, condition):
    """{vote: (share right, n)}"""
    out = {}
    for vote, members in bench.votes(cities, True, name).items():
        hits = [h for c in members for r, truth, answer, _ in (bench.question(c, name, condition),) for h in truth == answer]
        out[vote] = (float(np.mean(hits)), len(hits)) if hits else (0.0, 0)
    return out


LABELS = {(common.city(common.PLACE_OF[r["file"]]), r["id"]): STYLES.index(r["style"])
          for r in common.read_labels() if r["style"] in STYLES and r["sure"] == "1"}


def style_right(cities, condition):
    out = {}
    for c in cities:
        rows = [(i, LABELS[c.name, id_]) for i, id_ in enumerate(c.ids) if (c.name, id_) in LABELS]
        if rows:
            hits = [int(c.answers[condition]["style"][i].argmax()) == t for i, t in rows]
            out[c.name] = (float(np.mean(hits)), len(hits))
    return out


def mean(scores, without=None):
    return float(np.mean([s for v, (s, n) in scores.items() if n > 0 and v != without]))


def choose(title, values, measures):
    """measures: {value: [scores of each measure]}; what is best on the others by the sum of all measures."""
    def total(v, without=None):
        return sum(mean(m, without) for m in measures[v])
    every = sorted({vote for m in measures[values[0]] for vote in m})
    best = max(values, key=total)
    print(f"\n### {title}\n\n| value | " + " | ".join(TITLES[title]) + " |\n|---|" + "---|" * len(TITLES[title]))
    for v in values:
        print(f"| {v}{' (shipped: best of all)' if v == best else ''} | " + " | ".join("%.3f" % mean(m) for m in measures[v]) + " |")
    picked = {c: max(values, key=lambda v: total(v, c)) for c in every}
    nested = [mean({c: measures[picked[c]][k][c] for c in measures[values[0]][k]}) for k in range(len(TITLES[title]))]
    print("| **chosen without the city** | " + " | ".join("%.3f" % s for s in nested) + " |")
    print("\nChosen: " + ", ".join(f"{c} {v}" for c, v in picked.items()))
    sys.stdout.flush()
    return best


TITLES = {"prior of [era]": ["era, tenths", "era, this quarter hidden"], "prior of [roof]": ["roof family, tenths", "this quarter hidden"],
          "era of [style]": ["era, hidden", "era, tenths", "style, hidden", "style, tagged"]}


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", required=True)
    p.add_argument("--tables")
    p.add_argument("--shared", required=True)
    p.add_argument("--work", required=True, help="answers that lie there are taken as they are")
    p.add_argument("--weights")
    p.add_argument("--configs", default=os.path.join(common.HERE, "../../../configs"))
    a = p.parse_args()
    folds = [r for r in bench.read_folds() if r["pool"] == "in" and not r["file"].startswith("berlin-2014")]
    a.weights = a.weights or fitted(a, folds)
    era, roof = {}, {}
    for e, r in PRIORS:
        cities = answers(a, f"prior-{e}-{r}", {("era", "prior"): e, ("roof", "prior"): r}, folds)
        era[e] = [right(cities, "era", "tenths"), right(cities, "era", "quarter")]
        roof[r] = [right(cities, "roof", "tenths"), right(cities, "roof", "quarter")]
    choose("prior of [era]", [e for e, _ in PRIORS], era)
    choose("prior of [roof]", [r for _, r in PRIORS], roof)
    style = {}
    for e in DECISIONS:
        cities = answers(a, f"style-{e}", {("style", "era"): e}, folds)
        style[e] = [right(cities, "era", "hidden"), right(cities, "era", "tenths"), style_right(cities, "hidden"), style_right(cities, "tagged")]
    choose("era of [style]", DECISIONS, style)


if __name__ == "__main__":
    main()
