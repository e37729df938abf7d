#!/usr/bin/env python3
"""How well classification does on places that it was not fitted on: hide, classify, compare with what was hidden.

    evaluate.py --program build/release/tests/facts_table --tables DIR --shared ../shared --work DIR [--folds NAME ...] > table.md

Folds are places, never buildings. `place` folds leave one extract or one circle of labels/areas.csv out (style, morphology);
`city` folds leave all that shows a town out, all Berlin files together (era, storeys, roof). Weights are fitted anew for each
fold by fit.py, and the program itself answers. --tables: as for fit.py. Needs python3-numpy, python3-scipy, osmium-tool.
"""
import argparse
import math
import os
import re
import shutil
import subprocess
import sys

import numpy as np

import common
import fit
from common import ERAS, MORPHOLOGIES, ROOFS, STYLES

MARGIN = 700  # m around a circle: what facts, votes and smoothing reach


def plain(name):
    return re.sub(r"\s+", "_", name.lower().replace(".", ""))


def confusion(truth, answer, n):
    m = np.zeros((n, n), int)
    for t, a in zip(truth, answer):
        m[t, a] += 1
    return m


def f1(m, only=None):
    """Macro-F1 and recall per class."""
    scores, recalls = [], []
    for i in range(len(m)):
        if m[i].sum() == 0:
            recalls.append(math.nan)
            continue
        recall = m[i, i] / m[i].sum()
        precision = m[i, i] / m[:, i].sum() if m[:, i].sum() else 0
        recalls.append(recall)
        if only is None or i in only:
            scores.append(2 * recall * precision / (recall + precision) if recall + precision else 0)
    return float(np.mean(scores)), recalls


def calibration(p, right, bins=10):
    """Expected calibration error, and the reliability table (mean probability, share right, n)."""
    rows, error = [], 0
    for b in range(bins):
        inside = (p >= b / bins) & ((p < (b + 1) / bins) | (b == bins - 1))
        if inside.sum():
            rows.append((p[inside].mean(), right[inside].mean(), int(inside.sum())))
            error += inside.sum() / len(p) * abs(p[inside].mean() - right[inside].mean())
    return error, rows


def interval(values, rounds=1000):
    """95 % bootstrap interval of a mean, fixed seed."""
    values = np.asarray(values, float)
    if len(values) == 0:
        return math.nan, math.nan
    rng = np.random.default_rng(1)
    means = [values[rng.integers(0, len(values), len(values))].mean() for _ in range(rounds)]
    return tuple(np.quantile(means, [0.025, 0.975]))


class Evaluation:
    def __init__(self, a):
        self.a = a
        os.makedirs(a.work, exist_ok=True)
        self.tables = fit.read_tables(a.tables)
        self.labels = common.read_labels()
        self.areas = common.read_areas(a.shared, self.tables)
        self.configs = os.path.join(common.HERE, "../../../configs")

    def source(self, place):
        return os.path.join(self.a.shared, "data/osm", common.FILES[place])

    def clip(self, name, place, indices):
        """The part of an extract around some buildings."""
        out = os.path.join(self.a.work, f"clip-{name}.osm.pbf")
        if not os.path.exists(out):
            t = self.tables[place]
            lon, lat = t.number("lon")[indices], t.number("lat")[indices]
            dy = MARGIN / 110540
            dx = dy / math.cos(math.radians(float(lat.mean())))
            box = f"{lon.min() - dx:.5f},{lat.min() - dy:.5f},{lon.max() + dx:.5f},{lat.max() + dy:.5f}"
            subprocess.run(["osmium", "extract", "-b", box, "-s", "smart", "--overwrite", "-o", out, self.source(place)], check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return out

    def answer(self, name, extract, models, base=None):
        """The table of facts_table with weights of a fold."""
        configs = os.path.join(self.a.work, f"configs-{name}")
        shutil.rmtree(configs, ignore_errors=True)
        shutil.copytree(self.configs, configs)
        if base:
            for f in os.listdir(base):
                shutil.copy(os.path.join(base, f), os.path.join(configs, "styles/weights"))
        fit.write(models, os.path.join(configs, "styles/weights"))
        out = os.path.join(self.a.work, f"answers-{name}-{os.path.basename(extract).split('.')[0]}.csv")
        command = [self.a.program, extract, configs, out, "answers"]
        if self.a.quick:
            command.append("quick")
        subprocess.run(command, check=True)
        return common.Table(name, out)

    # ---- style and morphology -------------------------------------------------------------------------------------

    def place_folds(self):
        """(name, extract, label places, area) of each place that labels or circles know."""
        folds = {}
        for area, place, kind, houses in self.areas:
            whole = len(houses) > 0.9 * (self.tables[place].feature("area") >= 40).sum()
            name = place if place != "berlin" else "berlin_" + plain(area)
            extract = self.source(place) if place != "berlin" else None
            folds[name] = [name, place, extract, area, kind, houses]
        for r in self.labels:
            place = common.PLACE_OF[r["file"]]
            name = place if place != "berlin" else r["place"]
            if name not in folds:
                folds[name] = [name, place, self.source(place) if place != "berlin" else None, None, None, None]
        return list(folds.values())

    def styles(self):
        style_rows, morphology_rows = [], []
        for name, place, extract, area, kind, houses in self.place_folds():
            if self.a.folds and name not in self.a.folds:
                continue
            mine = [r for r in self.labels if common.PLACE_OF[r["file"]] == place and (place != "berlin" or r["place"] == name)]
            t = self.tables[place]
            if extract is None:
                chosen = houses if houses is not None else np.array([t.index[r["id"]] for r in mine if r["id"] in t.index])
                extract = self.clip(name, place, chosen)
            leave = {name, place} if place != "berlin" else {name}
            if area:
                leave.add(area)
            if common.city(place) != place or place == "berlin":
                leave.discard("berlin")
            models = fit.fit_all(self.tables, self.a.shared, leave, self.labels, self.areas, only=("style", "era", "morphology"))
            answers = self.answer(name, extract, models)
            for r in mine:
                if r["id"] in answers.index:
                    style_rows.append((r, answers, answers.index[r["id"]]))
            if houses is not None and kind in common.AREA_MORPHOLOGY:
                for i in houses:
                    id_ = t.ids[i]
                    if id_ in answers.index:
                        morphology_rows.append((name, kind, answers, answers.index[id_]))
            print(f"{name}: {len(mine)} labels, {0 if houses is None else len(houses)} houses", file=sys.stderr)
        self.print_styles(style_rows)
        self.print_morphology(morphology_rows)

    def print_styles(self, rows):
        print("\n### Style of appearance, hand-made labels, leave one place out\n")
        print("| labels | evidence | n | accuracy | macro-F1 of 4 | macro-F1 of the three | recall gruenderzeit, tenement, modern, other | calibration error |")
        print("|---|---|---|---|---|---|---|---|")
        for title, chosen in (("sure", [r for r in rows if r[0]["sure"] == "1"]), ("all", rows)):
            truth = [STYLES.index(r[0]["style"]) for r in chosen]
            for what, prefix in (("with tags", "tagged"), ("geometry and context", "untagged"), ("the same without the region's prior", "noregion"),
                                 ("the same, not smoothed", "nosmooth"), ("geometry permuted", "permuted")):
                if f"{prefix}_style_{STYLES[0]}" not in chosen[0][1].column:
                    continue
                P = np.array([[float(t.rows[i][t.column[f"{prefix}_style_{s}"]]) for s in STYLES] for _, t, i in chosen])
                answer = P.argmax(1)
                m = confusion(truth, answer, 4)
                all4, recalls = f1(m)
                three, _ = f1(m, only=(0, 1, 2))
                error, table = calibration(P.max(1), answer == np.array(truth))
                print(f"| {title} | {what} | {len(chosen)} | {np.mean(answer == np.array(truth)):.3f} | {all4:.3f} | {three:.3f} | "
                      + ", ".join("%.2f" % r for r in recalls) + f" | {error:.3f} |")
                if title == "sure" and prefix in ("tagged", "untagged"):
                    self.note(f"confusion ({what}, sure): rows truth, columns answer, {', '.join(STYLES)}: {m.tolist()}")
                    self.note(f"reliability ({what}, sure): " + ", ".join(f"{p:.2f}: {r:.2f} (n {n})" for p, r, n in table))
                    by_place = {}
                    for (r, _, _), a, t in zip(chosen, answer, truth):
                        by_place.setdefault(common.city(common.PLACE_OF[r["file"]]), []).append(a == t)
                    self.note("accuracy by town: " + ", ".join(f"{k} {np.mean(v):.2f} (n {len(v)})" for k, v in sorted(by_place.items())))
            majority = max(set(truth), key=truth.count)
            m = confusion(truth, [majority] * len(truth), 4)
            print(f"| {title} | majority class | {len(chosen)} | {np.mean(np.array(truth) == majority):.3f} | {f1(m)[0]:.3f} | {f1(m, (0, 1, 2))[0]:.3f} | | |")
            # Tag-only era rules: what a date or the building value alone would say.
            guess = []
            for _, t, i in chosen:
                year = t.rows[i][t.column["year"]]
                use = t.rows[i][t.column["tag_use"]]
                guess.append((0 if 1840 <= float(year) < 1919 else 2 if float(year) >= 1919 else 3) if year else 3 if use in ("5", "8", "9") else majority)
            m = confusion(truth, guess, 4)
            print(f"| {title} | tags alone (date, use) | {len(chosen)} | {np.mean(np.array(truth) == np.array(guess)):.3f} | {f1(m)[0]:.3f} | {f1(m, (0, 1, 2))[0]:.3f} | "
                  + ", ".join("%.2f" % r for r in f1(m)[1]) + " | |")
        # Wing or rear building against front.
        truth, answer = [], []
        for r, t, i in rows:
            if r["position"] in ("front", "wing", "rear") and r["sure"] == "1":
                p = t.rows[i][t.column["position"]]
                truth.append(r["position"] != "front")
                answer.append(bool(p) and float(p) >= 5)
        truth, answer = np.array(truth), np.array(answer)
        both, behind, said = (truth & answer).sum(), truth.sum(), answer.sum()
        print(f"\nWing or rear building against front (sure): F1 {2 * both / (behind + said):.3f}, precision {both / said:.2f}, recall {both / behind:.2f}, n {len(truth)}, behind {behind}.")
        gz = [(r["style"] == "gruenderzeit", STYLES[int(np.argmax([float(t.rows[i][t.column[f'untagged_style_{s}']]) for s in STYLES]))] == "gruenderzeit")
              for r, t, i in rows if r["sure"] == "1"]
        a = np.array(gz)
        print(f"Gründerzeit against the rest by geometry and context (sure): F1 {2 * (a[:, 0] & a[:, 1]).sum() / (a[:, 0].sum() + a[:, 1].sum()):.3f}.")

    def print_morphology(self, rows):
        print("\n### Morphology, circles of labels/areas.csv, leave one circle out\n")
        print("| | n | accuracy | macro-F1 | recall " + ", ".join(MORPHOLOGIES) + " |\n|---|---|---|---|---|")
        truth = np.array([MORPHOLOGIES.index(common.AREA_MORPHOLOGY[kind]) for _, kind, _, _ in rows])
        P = np.array([[float(t.rows[i][t.column[f"untagged_morphology_{m}"]]) for m in MORPHOLOGIES] for _, _, t, i in rows])
        answer = P.argmax(1)
        m = confusion(truth, answer, 5)
        macro, recalls = f1(m)
        print(f"| ours | {len(truth)} | {np.mean(truth == answer):.3f} | {macro:.3f} | " + ", ".join("%.2f" % r for r in recalls) + " |")
        areas = sorted({name for name, _, _, _ in rows})
        each = {n: np.mean([a == t for (name, _, _, _), a, t in zip(rows, answer, truth) if name == n]) for n in areas}
        print(f"| ours, mean over circles | {len(areas)} | {np.mean(list(each.values())):.3f} | | |")
        print("| hand score of docs/style_measures.md 3.3 on 14 unseen areas (published) | 2898 | 0.725 | 0.681 | |")
        print("| random forest of docs/style_measures.md 5.4 (published) | 2898 | 0.770 | 0.721 | |")
        gz = truth == 0
        said = answer == 0
        both = (gz & said).sum()
        print(f"\nPerimeter block against the rest: F1 {2 * both / (gz.sum() + said.sum()):.3f}, precision {both / said.sum():.2f}, recall {both / gz.sum():.2f}"
              " (published: .83).")
        error, table = calibration(P.max(1), answer == truth)
        print(f"Calibration error {error:.3f}. Reliability: " + ", ".join(f"{p:.2f}: {r:.2f} (n {n})" for p, r, n in table))
        print("By circle: " + ", ".join(f"{k} {v:.2f}" for k, v in each.items()))

    # ---- era, storeys, roof ---------------------------------------------------------------------------------------

    def cities(self):
        answers = {}
        for town in sorted({common.city(p) for p in self.tables if p not in common.OUTSIDE}):  # those are in cities.py alone
            if self.a.folds and town not in self.a.folds:
                continue
            models = fit.fit_all(self.tables, self.a.shared, {town}, self.labels, self.areas)
            for place in self.tables:
                if common.city(place) == town and not (self.a.small and place == "berlin"):
                    answers[place] = self.answer(town, self.source(place), models)
                    print(f"{place}: {answers[place].n} buildings", file=sys.stderr)
        self.print_eras(answers)
        self.print_storeys(answers)
        self.print_roofs(answers)

    def print_eras(self, answers):
        print("\n### Era, mapped dates hidden, leave one town out\n")
        rows, seen = [], set()
        for place, t in answers.items():
            years, sure = t.number("year"), t.number("year_confidence")
            dated = np.array(t.text("t_start_date")) != ""  # building:architecture names a style, no date
            for i in np.where(~np.isnan(years) & (sure > 0.5) & dated)[0]:
                key = (common.city(place), t.ids[i])
                if key not in seen:
                    seen.add(key)
                    rows.append((common.city(place), t, i, fit.era_of(years[i])))
        if not rows:
            return
        count = {}
        for r in rows:
            count[r[0]] = count.get(r[0], 0) + 1
        town = [r[0] if count[r[0]] >= 30 else "others" for r in rows]
        truth = np.array([r[3] for r in rows])
        print("| place | evidence | n | accuracy (95 %) | macro-F1 | recall " + ", ".join(ERAS) + " | calibration error |\n|---|---|---|---|---|---|---|")
        for what, prefix in (("dates hidden, tenth by tenth", "hidden"), ("geometry and context alone", "untagged")):
            P = np.array([[float(t.rows[i][t.column[f"{prefix}_era_{e}"]]) for e in ERAS] for _, t, i, _ in rows])
            answer = P.argmax(1)
            for name in sorted(set(town)) + ["all"]:
                chosen = np.array([name in (w, "all") for w in town])
                m = confusion(truth[chosen], answer[chosen], 4)
                macro, recalls = f1(m)
                right = truth[chosen] == answer[chosen]
                low, high = interval(right)
                error, _ = calibration(P[chosen].max(1), right)
                print(f"| {name} | {what} | {chosen.sum()} | {right.mean():.3f} ({low:.2f}–{high:.2f}) | {macro:.3f} | "
                      + ", ".join("–" if math.isnan(r) else "%.2f" % r for r in recalls) + f" | {error:.3f} |")
        for name in sorted(set(town)) + ["all"]:
            chosen = np.array([name in (w, "all") for w in town])
            majority = np.bincount(truth[chosen], minlength=4).argmax()
            m = confusion(truth[chosen], np.full(chosen.sum(), majority), 4)
            print(f"| {name} | majority era ({ERAS[majority]}) | {chosen.sum()} | {(truth[chosen] == majority).mean():.3f} | {f1(m)[0]:.3f} | | |")

    def print_storeys(self, answers):
        print("\n### Storeys, hidden tenth by tenth, leave one town out\n")
        print("| extract | n | within 1 | exact | MAE | RMSE | within 1, all storeys of the extract hidden | neighbour median: with touching tagged neighbours n, its within 1, ours on these | constant 3 within 1 |")
        print("|---|---|---|---|---|---|---|---|---|")
        pool, seen = [], set()
        for place, t in answers.items():
            told, ours, alone = t.number("storeys"), t.number("storeys_hidden"), t.number("storeys_alone")
            has = ~np.isnan(told) & (told > 0) & (ours > 0)
            if has.sum() == 0:
                continue
            medians = np.full(t.n, math.nan)
            touching = t.text("contacts")
            for i in np.where(has)[0]:
                near = [told[t.index[c.split(":")[0]]] for c in touching[i].split() if c.split(":")[0] in t.index]
                near = [v for v in near if not math.isnan(v)]
                if near:
                    medians[i] = np.median(near)
            m = has & ~np.isnan(medians)
            ok = np.abs(ours - told) <= 1
            base = np.abs(medians - told) <= 1
            # Each house once: extracts of one town show the same ones, the younger first.
            fresh = [i for i in np.where(has)[0] if (common.city(place), t.ids[i]) not in seen]
            seen.update((common.city(place), t.ids[i]) for i in fresh)
            pool += [(place, told[i], ours[i], alone[i]) for i in fresh]
            print(f"| {place} | {has.sum()} | {ok[has].mean():.3f} | {(np.abs(ours - told) < 0.5)[has].mean():.3f} | {np.abs(ours - told)[has].mean():.2f} | "
                  f"{math.sqrt(((ours - told)[has] ** 2).mean()):.2f} | {(np.abs(alone - told) <= 1)[has].mean():.3f} | "
                  f"{m.sum()}, {base[m].mean() if m.any() else math.nan:.3f}, {ok[m].mean() if m.any() else math.nan:.3f} | {(np.abs(told - 3) <= 1)[has].mean():.3f} |")
        v = np.array([(a, b, c) for _, a, b, c in pool])
        for title, chosen in (("pooled", np.full(len(pool), True)), ("pooled without all of Berlin 2014", np.array([p[0] != "berlin" for p in pool]))):
            w = v[chosen]
            if len(w):
                print(f"| {title} | {len(w)} | {(np.abs(w[:, 1] - w[:, 0]) <= 1).mean():.3f} | {(np.abs(w[:, 1] - w[:, 0]) < 0.5).mean():.3f} | {np.abs(w[:, 1] - w[:, 0]).mean():.2f} | "
                      f"{math.sqrt(((w[:, 1] - w[:, 0]) ** 2).mean()):.2f} | {(np.abs(w[:, 2] - w[:, 0]) <= 1).mean():.3f} | | {(np.abs(w[:, 0] - 3) <= 1).mean():.3f} |")

    def print_roofs(self, answers):
        print("\n### Roof families (flat, gabled, hipped, mansard, other), hidden tenth by tenth, leave one town out\n")
        print("| extract | n | accuracy | macro-F1 | all roofs of the extract hidden | majority |\n|---|---|---|---|---|---|")
        pool = []
        for place, t in answers.items():
            shapes, ours, alone = t.text("roof_shape"), t.text("roof_hidden"), t.text("roof_alone")
            rows = [(place, ROOFS.index(common.family(s)), ROOFS.index(o), ROOFS.index(l)) for s, o, l in zip(shapes, ours, alone) if s]
            if not rows:
                continue
            pool += rows
            self.roof_row(place, rows)
        self.roof_row("pooled", pool)
        self.roof_row("pooled without all of Berlin 2014", [r for r in pool if r[0] != "berlin"])

    @staticmethod
    def roof_row(title, rows):
        if not rows:
            return
        v = np.array([r[1:] for r in rows])
        majority = np.bincount(v[:, 0], minlength=5).argmax()
        print(f"| {title} | {len(v)} | {(v[:, 0] == v[:, 1]).mean():.3f} | {f1(confusion(v[:, 0], v[:, 1], 5))[0]:.3f} | {(v[:, 0] == v[:, 2]).mean():.3f} | "
              f"{(v[:, 0] == majority).mean():.3f} ({ROOFS[majority]}) |")

    notes = []

    def note(self, text):
        self.notes.append(text)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", required=True)
    p.add_argument("--tables", required=True)
    p.add_argument("--shared", required=True)
    p.add_argument("--work", required=True)
    p.add_argument("--folds", nargs="*", default=[])
    p.add_argument("--what", choices=("styles", "cities", "all"), default="all")
    p.add_argument("--small", action="store_true", help="without the whole of Berlin")
    p.add_argument("--quick", action="store_true", help="no hiding tenth by tenth")
    e = Evaluation(p.parse_args())
    if e.a.what != "cities":
        e.styles()
    if e.a.what != "styles":
        e.cities()
    for n in e.notes:
        print("\n* " + n)


if __name__ == "__main__":
    main()
