#!/usr/bin/python3
"""Fits the logistic regressions of pipeline/observation (verdict.cpp, edge_refinement.cpp, roof_view.cpp, presence.cpp, unmapped.cpp, courtyard_view.cpp) on the tuning images; prints weights and what each
place that is left out says.

    fit.py confidence|walls|form|ridge|gone|unmapped|courtyards [--work FOLDER] [--images FOLDER] [--places PLACE ...]

confidence: of the runs that `evaluate.py synthetic --set tuning` and `evaluate.py kampala` left in --work; a row is right when it is
found within 0.6 m; of those that are found 0.4 m or more from where they are mapped. walls: of what `evaluate.py walls --set tuning` left
in --work/walls.json; a wall is right when it stands nearer to the truth by 0.05 m afterwards. form, ridge: of builds of the tuning images, which are made here where --work lacks them.
"""
import argparse
import collections
import csv
import glob
import json
import math
import os
import subprocess

import numpy as np

import candidates
import ghosts
import holes
import omit

HERE = os.path.dirname(os.path.abspath(__file__))
PLACES = {"berlin-zionskirchplatz-2020": "osm", "london-soho-2025": "osm.gz", "husum_altstadt": "osm.pbf", "zuerich-niederdorf-2025": "osm.pbf",
          "piestany-2025": "osm.gz"}


def fit(a, y, ridge=1.0, rounds=50):
    """Weights by Newton's method, with a small quadratic penalty."""
    w = np.zeros(a.shape[1])
    for _ in range(rounds):
        p = 1 / (1 + np.exp(-np.clip(a @ w, -30, 30)))
        w += np.linalg.solve((a * (p * (1 - p))[:, None]).T @ a + ridge * np.eye(len(w)), a.T @ (y - p) - ridge * w)
    return w


LAST = []  # (probability by the other places, is it so) of the last report


def report(rows, ridge=1.0):
    """rows: (place, features, right)."""
    a, y, place = np.array([r[1] for r in rows]), np.array([r[2] for r in rows], float), np.array([r[0] for r in rows])
    p = np.zeros(len(y))
    for left_out in sorted(set(place)):
        here = place == left_out
        if here.all():
            continue
        p[here] = 1 / (1 + np.exp(-a[here] @ fit(a[~here], y[~here], ridge)))
        print(f"{left_out:32} {here.sum():6}   right {np.mean((p[here] > .5) == (y[here] > .5)):.3f}   share of ones {y[here].mean():.2f}")
    LAST[:] = list(zip(p.tolist(), (y > .5).tolist()))
    sure, right = np.maximum(p, 1 - p), (p > .5) == (y > .5)
    for least in (.5, .6, .7, .75, .8, .85, .9):
        said = sure >= least
        print(f"from {least:.2f} on: said {said.mean():.2f}, of them right {right[said].mean() if said.any() else math.nan:.3f}")
    print("weights", [float(v) for v in np.round(fit(a, y, ridge), 2)])


def confidence(a):
    rows = []
    for table in sorted(glob.glob(os.path.join(a.work, "*-tuning-*.csv")) + glob.glob(os.path.join(a.work, "kampala-real-*.csv"))):
        with open(table) as f:
            truth = {r["id"]: r for r in csv.DictReader(line for line in f if not line.startswith("#"))}
        with open(os.path.join(table[:-4], "imagery.json")) as f:
            seen = json.load(f)["buildings"]
        houses = collections.Counter(b.get("row") for b in seen)
        done = set()
        for b in seen:
            if b.get("row") in done or b["id"] not in truth or not b.get("score_deviation"):
                continue
            done.add(b["row"])
            dx, dy = b["shift_m"]
            if math.hypot(dx, dy) < .4:
                continue
            off = math.hypot(dx + float(truth[b["id"]]["dx"]), dy + float(truth[b["id"]]["dy"]))
            d = b["score_deviation"]
            rows.append((os.path.basename(table).split("-tuning")[0].split("-real")[0],
                         [1, min(3, (b["evidence_after"] - b["evidence_before"]) / d), min(2.5, (b["evidence_after"] - b["score_elsewhere"]) / d),
                          min(4.5, (b["evidence_after"] - b["score_mean"]) / d), b["evidence_after"], math.log(max(1, b["walls_m"]) / 50),
                          max(0, math.hypot(dx, dy) - 2.8), min(2, b["height_doubt_m"]), math.log(houses[b["row"]])], off < .6))
    report(rows)


def walls(a):
    rows = []
    with open(os.path.join(a.work, "walls.json")) as f:
        runs = json.load(f)["walls"]
    for run in runs:
        for w in run["walls"]:
            here, there = w["clear"]
            rows.append((run["place"], [1, here, there - w["elsewhere"], math.log(w["length_m"]), w["side"], w["others"], w["leans"]], abs(w["off"] - w["shift_m"]) + .05 < abs(w["off"])))
    report(rows, .3)


def roofs(a):
    """(place, building of imagery.json, its truth, unit vector to the sun)."""
    for place in a.places:
        out = os.path.join(a.work, f"roofs-{place}")
        if not os.path.exists(os.path.join(out, "imagery.json")):
            subprocess.run([a.program, "build", os.path.join(a.shared, "data/osm", f"{place}.{PLACES[place]}"), "-o", out, "--imagery",
                            os.path.join(a.images, "tuning", place + ".tif"), "--lod", "0", "--formats", "gpkg", "--ground-height", "0", "--no-report", "--no-explain",
                            "--progress", "none", "-q"], check=True)
        with open(os.path.join(out, "imagery.json")) as f:
            seen = json.load(f)
        with open(os.path.join(a.images, "tuning", place + ".truth.json")) as f:
            truth = json.load(f)["buildings"]
        azimuth = math.radians(seen["images"][0]["sun_azimuth_deg"])
        for b in seen["buildings"]:
            if b["id"] in truth and truth[b["id"]]["roof_seen_m2"] > 10 and b.get("roof_evidence", {}).get("lines"):
                yield place, b, truth[b["id"]], np.array([math.sin(azimuth), math.cos(azimuth)])


def lit(line, sun):
    """(facing, steady, wide, halves, consistency, bright line, offset, within) as roof_view.cpp has them."""
    angle, contrast, consistency, bright, offset, _, wide, within, halves = line
    turn = np.array([-math.sin(math.radians(angle)), math.cos(math.radians(angle))]) @ sun
    sign = -1 if turn < 0 else 1
    half = lambda v: float(np.clip(sign * v, -.5, .5))
    return abs(turn), half(contrast * (2 * consistency - 1)), half(wide), half(halves), consistency, min(.1, bright), offset, min(.3, within)


def strips(s, sun):
    n, b, bb, nx, ny, bnx, bny, nxx, nxy, nyy = s
    if n < 20:
        return 0, 0
    turn = (nx * sun[0] + ny * sun[1]) / n
    turns = (nxx * sun[0]**2 + 2 * nxy * sun[0] * sun[1] + nyy * sun[1]**2) / n - turn**2
    both = (bnx * sun[0] + bny * sun[1]) / n - turn * b / n
    if turns < .02:
        return 0, 0
    return float(np.clip(both / turns / (b / n + 25), -.5, .5)), float(np.clip(both / math.sqrt(turns * max(1e-9, bb / n - (b / n)**2)), -1, 1))


def form(a):
    rows = []
    for place, b, truth, sun in roofs(a):
        if truth["form"] not in ("flat", "pitched"):
            continue
        e = b["roof_evidence"]
        both = [lit(line, sun) for line in e["lines"]]
        facing, other, clear = max(both, key=lambda q: q[0]), min(both, key=lambda q: q[0]), max(both, key=lambda q: q[1])
        r, g, blue = (int(b.get("roof_colour", "#808080")[k:k + 2], 16) for k in (1, 3, 5))
        total = r + g + blue
        rows.append((place, [float(np.clip(3 * (r - blue) / (total + 1), -.5, 1)), float(np.clip(3 * (2 * g - r - blue) / (total + 1), 0, .5)), total / 765, 1,
                             facing[1], other[1], facing[2], other[2], facing[3], other[3], *strips(e["strips"], sun), min(.3, e["spread"]), math.log(e["short_m"] + 1),
                             math.log(e["long_m"] + 1), clear[4], clear[6], facing[0]], truth["form"] == "pitched"))
    report(rows)


def ridge(a):
    rows = []
    for place, b, truth, sun in roofs(a):
        if truth["ridge_azimuth_deg"] is None:
            continue
        e = b["roof_evidence"]
        off = [abs(((90 - line[0]) - truth["ridge_azimuth_deg"] + 90) % 180 - 90) for line in e["lines"]]
        if min(off) > 15:
            continue
        x, y = (lit(line, sun) for line in e["lines"])
        rows.append((place, [1, x[1] - y[1], x[2] - y[2], x[5] - y[5], y[6] - x[6], min(2, math.log((e["long_m"] + 1) / (e["short_m"] + 1))), x[4] - y[4], x[0] - y[0],
                             x[7] - y[7]], off[0] <= 15))
    report(rows)


def gone(a):
    """Buildings that ghosts.py put where none stands, on the tuning images."""
    rows = []
    for place in a.places:
        extract = os.path.join(a.work, f"ghosts-{place}.osm")
        if not os.path.exists(extract):
            ghosts.add_ghosts(os.path.join(a.shared, "data/osm", f"{place}.{PLACES[place]}"), extract, 1)
        out = os.path.join(a.work, f"ghosts-{place}")
        if not os.path.exists(os.path.join(out, "imagery.json")):
            subprocess.run([a.program, "build", extract, "-o", out, "--imagery", os.path.join(a.images, "tuning", place + ".tif"), "--lod", "0", "--formats", "gpkg",
                            "--ground-height", "0", "--no-report", "--no-explain", "--progress", "none", "-q"], check=True)
        with open(extract[:-4] + ".csv") as f:
            truth = {r["id"]: int(r["ghost"]) for r in csv.DictReader(f)}
        with open(os.path.join(out, "imagery.json")) as f:
            for b in json.load(f)["buildings"]:
                if b["id"] in truth and b.get("roof_evidence") and b.get("score_deviation"):
                    e = b["roof_evidence"]
                    rows.append((place, [1, e["green"], b["evidence_after"], min(4.5, (b["evidence_after"] - b["score_mean"]) / b["score_deviation"]), b["score_mean"],
                                         max(0, b.get("shadow", {}).get("clearness", 0)), min(.6, e["spread"]), b.get("roof_form") == "pitched"], truth[b["id"]]))
    report(rows)


def unmapped_features(e):
    """As unmapped.cpp has them."""
    score, around, filled, elongation, likeness, green_around, mapped_around, shadow, brightness, area = e
    return [1, score, score - around, filled, math.log(elongation), likeness, green_around, mapped_around, min(.4, max(-.2, shadow)), min(0, max(-.2, shadow) - .1), min(1.2, max(.5, brightness)),
            math.log(area / 100)]


def built(a, extract, out, place):
    """Builds an extract on the tuning image of a place where --work lacks it -> imagery.json."""
    if not os.path.exists(os.path.join(out, "imagery.json")):
        subprocess.run([a.program, "build", extract, "-o", out, "--force", "--imagery", os.path.join(a.images, "tuning", place + ".tif"), "--lod", "0", "--formats", "gpkg",
                        "--ground-height", "0", "--no-report", "--no-explain", "--progress", "none", "-q"], check=True)
    with open(os.path.join(out, "imagery.json")) as f:
        return json.load(f)


def unmapped(a):
    """Candidates where omit.py left buildings out, on the tuning images. Sheds that no map has count for nothing."""
    rows = []
    for place in a.places:
        whole = os.path.join(a.shared, "data/osm", f"{place}.{PLACES[place]}")
        with open(os.path.join(a.images, "tuning", place + ".truth.json")) as f:
            scene = json.load(f)
        for seed in (1, 2):
            extract = os.path.join(a.work, f"omit-{place}-{seed}.osm")
            if not os.path.exists(extract):
                omit.omit(whole, extract, seed)
            out = os.path.join(a.work, f"omit-{place}-{seed}")
            seen = built(a, extract, out, place)
            with open(os.path.join(out, "build.json")) as f:
                truth = candidates.Truth(whole, extract, int(json.load(f)["crs"]["code"].split(":")[1]), scene)
            for c in seen["unmapped"] + seen["unmapped_unsure"]:
                what = truth.judge(c)[0]
                if what != "shed":
                    rows.append((place, unmapped_features(c["evidence"] + [c["area_m2"]]), what == "right"))
    report(rows)
    for least in (.5, .6, .7, .8, .85, .9):
        told = [r for r in LAST if r[0] >= least]
        print(f"told from {least}: {len(told)}, of them right {np.mean([r[1] for r in told]) if told else math.nan:.3f}; of the right ones told {sum(r[1] for r in told) / max(1, sum(r[1] for r in LAST)):.2f}")


def courtyards(a):
    """Holes that holes.py cut where a roof lies, and real ones, on the tuning images."""
    rows = []
    for place in a.places:
        for seed in (1, 2, 3):
            extract = os.path.join(a.work, f"holes-{place}-{seed}.osm")
            if not os.path.exists(extract):
                holes.cut_holes(os.path.join(a.shared, "data/osm", f"{place}.{PLACES[place]}"), extract, seed, .6)
            truth = holes.read_holes(extract[:-4] + ".csv")
            for b in built(a, extract, extract[:-4], place)["buildings"]:
                for c in b.get("courtyards", []):
                    if b["id"] in truth and (truth[b["id"]] or seed == 1):
                        alike, level, dark, green, edge, around = c["evidence"]
                        rows.append((place, [1, alike, min(1, level), dark, green, edge - around], truth[b["id"]]))
    # As many open as built over: few maps have holes where a roof lies.
    cut = [r for r in rows if r[2]]
    real = [r for r in rows if not r[2]]
    print(f"{len(cut)} cut, {len(real)} real")
    report(cut + real * round(len(cut) / len(real)))
    for least in (.8, .85, .9, .95):
        over, open_ = [r for r in LAST if r[0] >= least], [r for r in LAST if r[0] <= 1 - least]
        print(f"from {least}: built over {len(over)}, right {np.mean([r[1] for r in over]):.3f}; open {len(open_)}, right {1 - np.mean([r[1] for r in open_]):.3f}")


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("what", choices=["confidence", "walls", "form", "ridge", "gone", "unmapped", "courtyards"])
    a.add_argument("--program", default=os.path.join(HERE, "../../../build/release/blockrand"))
    a.add_argument("--shared", default="/work/shared" if os.path.isdir("/work/shared") else os.path.join(HERE, "../../../../shared"))
    a.add_argument("--images", default="/work/imagery_bench")
    a.add_argument("--work", default="/tmp/imagery_bench")
    a.add_argument("--places", nargs="+", default=list(PLACES), choices=list(PLACES))
    a = a.parse_args()
    os.makedirs(a.work, exist_ok=True)
    globals()[a.what](a)


if __name__ == "__main__":
    main()
