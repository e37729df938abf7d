#!/usr/bin/python3
"""Judges the program's analysis of aerial images (issue 20). Markdown tables to stdout, everything to a JSON file.

    evaluate.py kampala|synthetic|walls|pariser-platz|georeference|colours|ridges|gone|unmapped|courtyards [options]

Runs `blockrand build EXTRACT --imagery IMAGE --imagery-correct report` and reads imagery.json of the build. Needs the data folder
(--shared), rendered pictures (--images: FOLDER/SET/PLACE.tif with .truth.json, by render.py), osmium-tool, python3-gdal, python3-numpy.
"""
import argparse
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ET

import numpy as np
from osgeo import gdal, ogr

import candidates
import ciede2000
import corrections
import ghosts
import holes
import misregister
import omit
import osm
import refinement
from corrections import HEAD, Judged, cells, outlines, read_truth, summarise, table
from displace import Buildings, displace

HERE = os.path.dirname(os.path.abspath(__file__))
PLACES = {"berlin-zionskirchplatz-2020": "osm", "karlsruhe-suedweststadt-2026": "osm.pbf", "london-soho-2025": "osm.gz", "husum_altstadt": "osm.pbf",
          "zuerich-niederdorf-2025": "osm.pbf", "piestany-2025": "osm.gz"}


def truth_rows(name):
    with open(os.path.join(HERE, "truth", name)) as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def angle_between(a, b):
    """Least angle of two directions modulo 180 degrees."""
    return abs((a - b + 90) % 180 - 90)


class Bench:
    def __init__(self, a):
        self.a = a
        self.result = {}
        os.makedirs(a.work, exist_ok=True)
        data = os.path.join(a.shared, "data")
        self.kampala_image = os.path.join(data, "imagery/kampala-oam/kampala_oam_epsg3857_7cm.tif")
        self.kampala_osm = os.path.join(data, "imagery/kampala-oam/osm_building_labels.osm")
        self.platz_image = os.path.join(data, "imagery/berlin-pariser-platz/pariser_platz_epsg25833_20cm.tif")
        self.platz_osm = os.path.join(data, "osm/berlin-pariser-platz-2014.osm.pbf")
        self.platz_reference = os.path.join(data, "reference/berlin-pariser-platz/Berlin_Pariser_Platz_v0.4.0.xml")
        self.wien_image = os.path.join(data, "imagery/wien-schoenbrunn/44_2_op_2023_30cm.tif")

    def extract_of(self, place):
        if place == "estate":
            return os.path.join(self.a.images, "estate.osm")
        return os.path.join(self.a.shared, "data/osm", f"{place}.{PLACES[place]}")

    def image_of(self, place):
        return os.path.join(self.a.images, self.a.set, place + ".tif")

    def images_of(self, place):
        """One or, with --also, two images of the place."""
        also = [os.path.join(self.a.images, self.a.also, place + ".tif")] if self.a.also else []
        return [self.image_of(place)] + also

    def truth_of(self, place):
        with open(os.path.join(self.a.images, self.a.set, place + ".truth.json")) as f:
            return json.load(f)

    def run(self, name, extract, image):
        """The program's answer: imagery.json of a build called `name`; {"error": ...} when it refuses."""
        out = os.path.join(self.a.work, name)
        answer = os.path.join(out, "imagery.json")
        if not self.a.reuse or not os.path.exists(answer):
            images = [v for one in ([image] if isinstance(image, str) else image) for v in ("--imagery", one)]
            command = [self.a.program, "build", extract, "-o", out, *images, "--imagery-correct", "report", "--lod", str(self.a.lod), "--formats", "gpkg",
                       "--ground-height", "0", "--no-report", "--no-explain", "--force", "--allow-shrink", "100", "--allow-empty", "--progress", "none", "-q"] + self.a.args
            start = time.time()
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            seconds = time.time() - start
            if done.returncode not in (0, 3):
                return {"error": f"exit {done.returncode}: {done.stdout.strip()[-300:]}", "images": [], "buildings": [], "seconds": seconds}
        else:
            seconds = None
        with open(answer) as f:
            result = json.load(f)
        result["seconds"] = seconds
        if not self.a.keep_builds:
            for entry in os.listdir(out):
                if entry not in ("imagery.json", "build.json"):
                    path = os.path.join(out, entry)
                    shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)
        return result

    def check_crs(self, name, epsg):
        path = os.path.join(self.a.work, name, "build.json")
        if os.path.exists(path):
            with open(path) as f:
                code = json.load(f)["crs"]["code"]
            if code != f"EPSG:{epsg}":
                raise SystemExit(f"{name}: the build is in {code}, the displacement in EPSG:{epsg}: displace with --epsg")

    # ---- known displacements --------------------------------------------------------------------------------------

    def displaced(self, place, extract, image, seed, share, keep=None, offsets=None, rotate=None):
        """One run on one displaced extract -> (Judged, answer)."""
        a = self.a
        name = f"{place}-{a.set + (f'+{a.also}' if a.also else '') if place in PLACES else 'real'}-{seed}-{int(100 * share)}"
        moved = os.path.join(a.work, name + ".osm")
        b, _ = displace(extract, moved, seed, a.min, a.max, a.rotate if rotate is None else rotate, share, a.jitter)
        epsg, truth = read_truth(moved[:-4] + ".csv")
        answer = self.run(name, moved, image)
        if "error" in answer:
            print(f"{name}: {answer['error']}", file=sys.stderr)
        self.check_crs(name, epsg)
        return Judged(answer["buildings"], truth, outlines(extract, epsg), outlines(moved, epsg), keep, offsets), answer

    def image_line(self, answer):
        i = (answer.get("images") or [{}])[0]
        s = i.get("shift_m") or (None, None)
        return f"{i.get('state', answer.get('error', 'none'))}" + (f" ({s[0]:+.2f}, {s[1]:+.2f})" if s[0] is not None else "")

    def kampala(self):
        labels = truth_rows("kampala_labels.csv")
        right = {f"w{int(r['index']) + 1}": r for r in labels if r["verdict"] == "right"}
        inside = {f"w{int(r['index']) + 1}" for r in labels}
        offsets = {f"w{int(r['index']) + 1}": (float(r["dx_m"]), float(r["dy_m"])) for r in labels}
        counts = {v: sum(r["verdict"] == v for r in labels) for v in sorted({r["verdict"] for r in labels})}
        print("### Kampala: real image of 0.075 m, labels mapped on it\n")
        print(f"{len(labels)} labels wholly inside: " + ", ".join(f"{n} {v}" for v, n in counts.items()) + f". Judged: the {len(right)} right ones; the others are counted below.\n")
        plain, hand, others, pooled = [], [], [], []
        for seed in self.a.seeds:
            for share in (1.0, 0.5):
                j, answer = self.displaced("kampala", self.kampala_osm, self.kampala_image, seed, share, inside)
                good = [r for r in j.rows if r["id"] in right]
                plain.append([seed, share] + cells(summarise(good)) + [self.image_line(answer)])
                if share == 1:
                    pooled += good
                    others.append([seed, len(j.rows) - len(good), sum(r["state"] == "corrected" for r in j.rows if r["id"] not in right)])
                epsg, truth = read_truth(os.path.join(self.a.work, f"kampala-real-{seed}-{int(100 * share)}.csv"))
                h = Judged(answer["buildings"], truth, outlines(self.kampala_osm, epsg), outlines(os.path.join(self.a.work, f"kampala-real-{seed}-{int(100 * share)}.osm"), epsg), set(right), offsets)
                hand.append([seed, share] + cells(h.summary()))
                self.result.setdefault("kampala", []).append(dict(seed=seed, share=share, rows=j.rows, images=answer.get("images"), seconds=answer["seconds"]))
        print("Against the labels as mapped (share: of the buildings that were displaced; the rest was right):\n")
        table(["seed", "share moved"] + HEAD + ["image, its shift"], plain + [["all", 1.0] + cells(summarise(pooled)) + [""]])
        print("Against the labels moved by the hand-read offsets (dx_m, dy_m: roof against label):\n")
        table(["seed", "share moved"] + HEAD, hand)
        print("Labels that are wrong, merged, missing, shifted or unclear, not judged (all moved):\n")
        table(["seed", "labels", "corrected"], others)
        j, answer = self.displaced("kampala", self.kampala_osm, self.kampala_image, 0, 0.0, inside)
        good = [r for r in j.rows if r["id"] in right]
        print("Nothing displaced:\n")
        table(HEAD + ["image, its shift"], [cells(summarise(good)) + [self.image_line(answer)]])

    def synthetic(self):
        print(f"### Synthetic orthophotos, set `{self.a.set}`, shifts of {self.a.min} to {self.a.max} m, rotation up to {self.a.rotate} degrees, jitter {self.a.jitter} m\n")
        lines, pooled = [], {}
        for place in self.a.places:
            if not os.path.exists(self.image_of(place)):
                print(f"{place}: not rendered ({self.image_of(place)}), left out\n")
                continue
            for seed in self.a.seeds:
                j, answer = self.displaced(place, self.extract_of(place), self.images_of(place), seed, self.a.share)
                s = j.summary()
                lines.append([place, seed] + cells(s) + [self.image_line(answer), "" if answer["seconds"] is None else f"{len(j.rows) / answer['seconds']:.0f}/s"])
                pooled.setdefault(seed, []).extend(j.rows)
                self.result.setdefault("synthetic", []).append(dict(place=place, seed=seed, summary=s, rows=j.rows, images=answer.get("images"), seconds=answer["seconds"]))
                print(f"{place} {seed}: {s['states']}", file=sys.stderr)
        for seed, rows in pooled.items():
            lines.append(["all", seed] + cells(summarise(rows)) + ["", ""])
        table(["place", "seed"] + HEAD + ["image, its shift", "whole run"], lines)
        reasons = {}
        for rows in pooled.values():
            for r in rows:
                if r["state"] != "corrected":
                    reasons[(r["state"], r["reason"])] = reasons.get((r["state"], r["reason"]), 0) + 1
        print("Why not corrected: " + "; ".join(f"{s} {w} {n}" for (s, w), n in sorted(reasons.items(), key=lambda x: -x[1])[:12]) + "\n")

    # ---- single walls ---------------------------------------------------------------------------------------------

    def walls(self):
        """Houses with one or two walls shifted by 0.3 to 1 m in every row that has such, a third of the rows moved as well; and all corners of half the rows off by --jitter."""
        places = [p for p in ["kampala"] + self.a.places if p == "kampala" or os.path.exists(self.image_of(p))]
        labels = truth_rows("kampala_labels.csv")
        right_labels = {f"w{int(r['index']) + 1}": (float(r["dx_m"]), float(r["dy_m"])) for r in labels if r["verdict"] == "right"}
        for kind, how in [k for k in (("walls", dict(low=1, high=3, share=.33, jitter=0, walls=1.0)), (f"corners by {self.a.jitter or .3} m", dict(low=0, high=0, share=.5, jitter=self.a.jitter or .3, walls=0))) if k[0].split()[0] in self.a.kinds]:
            lines, pooled = [], {}
            for place in places:
                extract, image = (self.kampala_osm, self.kampala_image) if place == "kampala" else (self.extract_of(place), self.image_of(place))
                for seed in self.a.seeds:
                    name = f"{kind.split()[0]}-{place}-{'real' if place == 'kampala' else self.a.set}-{seed}"
                    path = os.path.join(self.a.work, name + ".osm")
                    displace(extract, path, seed, how["low"], how["high"], 0, how["share"], how["jitter"], walls=how["walls"])
                    epsg, truth = read_truth(path[:-4] + ".csv")
                    answer = self.run(name, path, image)
                    if "error" in answer:
                        print(f"{name}: {answer['error']}", file=sys.stderr)
                    touched = {i for i, t in truth.items() if t["moved"] or t["reshaped"]}
                    told = [b for b in answer["buildings"] if place != "kampala" or b["id"] in right_labels]
                    w, b = refinement.judge(told, refinement.rings_of(extract, epsg), refinement.rings_of(path, epsg), touched, right_labels if place == "kampala" else None)
                    lines.append([place, seed] + refinement.cells(w, b))
                    group = "kampala" if place == "kampala" else "synthetic"
                    pooled.setdefault(group, ([], []))
                    pooled[group][0].extend(w), pooled[group][1].extend(b)
                    self.result.setdefault("walls", []).append(dict(kind=kind, place=place, seed=seed, walls=w, buildings=b))
            print(f"### Single walls, {kind}, set `{self.a.set}`\n")
            table(["place", "seed"] + refinement.HEAD, lines + [[g, "all"] + refinement.cells(*p) for g, p in pooled.items()])
            reasons = {}
            for _, b in pooled.values():
                for x in b:
                    if not x["taken"]:
                        reasons[x["reason"]] = reasons.get(x["reason"], 0) + 1
            print("Not refined: " + "; ".join(f"{w} {n}" for w, n in sorted(reasons.items(), key=lambda x: -x[1])) + "\n")

    # ---- Pariser Platz --------------------------------------------------------------------------------------------

    def reference_blocks(self, epsg):
        """gml id -> (name, polygon of the ground faces in the build's system, measured height)."""
        to = osm.transformation(3068, epsg)
        out = {}
        for b in ET.parse(self.platz_reference).getroot().iter():
            if not b.tag.endswith("}Building"):
                continue
            id_ = next(v for k, v in b.attrib.items() if k.endswith("id"))
            name = next((e.text for e in b if e.tag.endswith("}name")), "")
            height = next((float(e.text) for e in b if e.tag.endswith("}measuredHeight")), None)
            shape = None
            for solid in (e for e in b if e.tag.endswith("lod2Solid")):
                polygons = []
                for p in (e for e in solid.iter() if e.tag.endswith("}Polygon")):
                    rings = []
                    for l in (e for e in p.iter() if e.tag.endswith("posList")):
                        rings.append(np.array([float(v) for v in l.text.split()]).reshape(-1, 3))
                    polygons.append(rings)
                low = min(r[:, 2].min() for rings in polygons for r in rings)
                for rings in polygons:
                    if all((r[:, 2] < low + .1).all() for r in rings):
                        g = polygon_of([np.array([to.TransformPoint(float(x), float(y))[:2] for x, y, _ in r]) for r in rings])
                        shape = g if shape is None else shape.Union(g)
            if shape is not None:
                out[id_] = name, shape, height
        return out

    def pariser_platz(self):
        print("### Pariser Platz: 18 reference solids, real image of 0.2 m with leaning roofs\n")
        answer = self.run("pariser-platz", self.platz_osm, self.platz_image)
        if "error" in answer:
            print(answer["error"], "\n")
        epsg = 25833
        self.check_crs("pariser-platz", epsg)
        b = osm.Extract(self.platz_osm)
        buildings = Buildings(b, epsg)
        shapes = {o: polygon_of(r) for o, r in buildings.rings.items() if buildings.objects[o][1]}
        by_id = {x["id"]: x for x in answer["buildings"]}
        after_shapes = {o: polygon_of([corrections.corrected(x, by_id[o]) for x in buildings.rings[o]]) if by_id.get(o, {}).get("state") == "corrected" else g for o, g in shapes.items()}
        reference, lines, lower = self.reference_blocks(epsg), [], 0
        heights = []
        for r in truth_rows("pariser_platz_reference.csv"):
            if r["gml_id"] not in reference:
                lines.append([r["gml_id"], r["name"], r["in_image"], "not in the file", "", "", "", ""])
                continue
            name, shape, height = reference[r["gml_id"]]
            mine = [o for o, g in shapes.items() if g.Intersects(shape) and g.Intersection(shape).Area() > .5 * min(g.Area(), shape.Area())]
            iou = lambda gs: 0.0 if not gs else merge(gs).Intersection(shape).Area() / merge(gs).Union(shape).Area()
            before, after = iou([shapes[o] for o in mine]), iou([after_shapes[o] for o in mine])
            judged = r["in_image"] == "present"
            lower += judged and after < before - .05
            said = [by_id.get(o, {}).get("height_from_shadow_m") for o in mine if by_id.get(o, {}).get("height_from_shadow_m") is not None]
            if said and height and judged:
                heights.append(abs(float(np.median(said)) - height))
            states = ", ".join(f"{o} {by_id.get(o, {}).get('state', 'absent')}" + (" (%+.2f, %+.2f)" % tuple(by_id[o]["shift_m"]) if by_id.get(o, {}).get("state") == "corrected" else "") for o in mine)
            lines.append([r["gml_id"], name, r["in_image"] if judged else f"excluded: {r['in_image']}", f"{r['lean_east_m']}, {r['lean_north_m']}", states, f"{before:.3f}", f"{after:.3f}", f"{after - before:+.3f}"])
        table(["block", "name", "in the image", "lean read by eye", "OSM", "IoU before", "after", "change"], lines)
        i = (answer.get("images") or [{}])[0]
        s = i.get("shift_m") or [math.nan, math.nan]
        print(f"Image: {self.image_line(answer)}; its shift is {math.hypot(*s):.2f} m (bound 0.4). Lower by more than 0.05: {lower}.")
        print(f"Height from shadow: {len(heights)} blocks, mean absolute error {np.mean(heights):.1f} m.\n" if heights else "Height from shadow: none claimed.\n")
        self.result["pariser_platz"] = dict(lines=lines, lower=int(lower), images=answer.get("images"), shadow_errors=heights)

    # ---- georeference ---------------------------------------------------------------------------------------------

    def georeference(self):
        """20 bad and 20 good: five places, four kinds each."""
        rng = np.random.default_rng(20)
        synthetic = [p for p in ["husum_altstadt", "berlin-zionskirchplatz-2020", "estate"] + list(PLACES) if os.path.exists(self.image_of(p))]
        synthetic = list(dict.fromkeys(synthetic))[:3]
        places = [("kampala", self.kampala_osm, self.kampala_image), ("pariser-platz", self.platz_osm, self.platz_image)] + [(p, self.extract_of(p), self.image_of(p)) for p in synthetic]
        others = {"kampala": self.wien_image}
        bad, good = [], []
        picture = os.path.join(self.a.work, "misregistered.tif")
        for k, (place, extract, image) in enumerate(places):
            angle = rng.uniform(0, 2 * math.pi)
            other = others.get(place, self.kampala_image if k % 2 else self.wien_image)
            kinds = [("shift 15 m to %.0f degrees" % (math.degrees(math.pi / 2 - angle) % 360), dict(east=15 * math.cos(angle), north=15 * math.sin(angle))),
                     ("mirrored", dict(mirror=True)), ("turned by 90", dict(rotate90=True)), ("another place: " + os.path.basename(other).split("_")[0], dict())]
            for what, how in kinds:
                if what.startswith("another"):
                    # A small picture in the middle of a square would show no house, wrong or right.
                    epsg = gdal.Open(image).GetSpatialRef().GetAuthorityCode(None)
                    misregister.misregister(other, picture, place_of=image, at=misregister.most_built(other, image, list(outlines(extract, int(epsg)).values())))
                else:
                    misregister.misregister(image, picture, **how)
                bad.append(self.trial(place, extract, picture, what, None))
            for length in (0.0, 0.7, 1.3, 2.0):
                angle = rng.uniform(0, 2 * math.pi)
                e, n = length * math.cos(angle), length * math.sin(angle)
                misregister.misregister(image, picture, east=e, north=n)
                good.append(self.trial(place, extract, picture, f"shift {length} m", (e, n)))
        for title, rows, wanted in (("Wrong georeference: to be rejected", bad, "misfit"), ("Good georeference (up to 2 m): to be used", good, "used")):
            print(f"### {title}\n")
            table(["place", "what", "state", "score", "margin", "shift said", "shift put in", "right", "buildings seen", "of them moved"],
                  [[r["place"], r["what"], r["state"], num(r["score"]), num(r["margin"]), vector(r["shift"]), vector(r["put"]), "yes" if r["state"] == wanted else "NO", r["seen"], r["moved"]] for r in rows])
            print(f"{sum(r['state'] == wanted for r in rows)} of {len(rows)} {wanted}; " + ", ".join(f"{sum(r['state'] == s for r in rows)} {s}" for s in sorted({r['state'] for r in rows})) + "\n")
        self.result["georeference"] = dict(bad=bad, good=good)

    def trial(self, place, extract, picture, what, put):
        answer = self.run("georeference", extract, picture)
        i = (answer.get("images") or [{}])[0]
        print(f"{place} {what}: {self.image_line(answer)}", file=sys.stderr)
        seen = [b for b in answer["buildings"] if b.get("score_deviation")]
        return dict(place=place, what=what, state=i.get("state", "error" if "error" in answer else "none"), score=i.get("score"), margin=i.get("margin"), shift=i.get("shift_m"), put=put, error=answer.get("error"), seen=len(seen),
                    moved=sum(b["state"] == "corrected" for b in seen))

    def gone(self):
        print("### Buildings that are mapped where none stands: told to be gone\n")
        lines, total = [], np.zeros(4, int)
        for place in self.rendered() + ["kampala"]:
            extract = os.path.join(self.a.work, f"ghosts-{place}.osm")
            ghosts.add_ghosts(self.kampala_osm if place == "kampala" else self.extract_of(place), extract, self.a.seeds[0])
            answer = self.run(f"ghosts-{place}-{self.a.set}", extract, self.kampala_image if place == "kampala" else self.image_of(place))
            with open(extract[:-4] + ".csv") as f:
                truth = {r["id"]: int(r["ghost"]) for r in csv.DictReader(f)}
            flagged = [truth.get(b["id"], 0) for b in answer["buildings"] if "perhaps_gone" in b]
            seen = [truth.get(b["id"], 0) for b in answer["buildings"] if b.get("score_deviation")]
            row = np.array([sum(seen), sum(flagged), len(seen) - sum(seen), len(flagged) - sum(flagged)])
            lines.append([place, *row, percent(row[1], row[0]), percent(row[3], row[2])])
            total += row
        table(["place", "not there", "told so", "there", "told gone", "share found", "share wrong"], lines + [["all", *total, percent(total[1], total[0]), percent(total[3], total[2])]])
        self.result["gone"] = [[str(v) for v in line] for line in lines]

    def unmapped(self):
        """Candidates on maps that lack a fifth of their buildings, and on maps that lack none."""
        print("### Built where nothing is mapped: candidates\n")
        print("Right: half of the candidate lies on roofs that were left out of the map. Sheds: what the scene has and no map (mostly under 20 m2); neither right nor wrong. Wrong: all others.\n")
        lines, plain, total, total_plain, ious = [], [], np.zeros(5, int), np.zeros(3, int), []
        places = self.rendered() + ["kampala", "pariser-platz"]
        for place in places:
            real = place not in PLACES and place != "estate"
            whole, image = {"kampala": (self.kampala_osm, self.kampala_image), "pariser-platz": (self.platz_osm, self.platz_image)}.get(place) or (self.extract_of(place), self.image_of(place))
            scene, set_ = (None, "real") if real else (self.truth_of(place), self.a.set)
            answer = self.run(f"plain-{place}-{set_}", whole, image)
            seen = {b["id"] for b in answer["buildings"] if b.get("roof_evidence")}
            name = os.path.join(self.a.work, f"omit-{place}")
            omit.omit(whole, name + "-none.osm", 0, 0)
            with open(os.path.join(self.a.work, f"plain-{place}-{set_}", "build.json")) as f:
                epsg = int(json.load(f)["crs"]["code"].split(":")[1])
            said = [candidates.Truth(whole, name + "-none.osm", epsg, scene).judge(c)[0] for c in answer["unmapped"]]
            row = np.array([len(seen), said.count("shed"), said.count("wrong")])
            plain.append([place, *row])
            total_plain += 0 if real else row
            for seed in self.a.seeds:
                extract = f"{name}-{seed}.osm"
                omit.omit(whole, extract, seed)
                answer = self.run(f"omit-{place}-{set_}-{seed}", extract, image)
                truth = candidates.Truth(whole, extract, epsg, scene)
                said = [truth.judge(c) for c in answer["unmapped"]]
                gone = truth.large() & seen
                found = {o for what, o, _ in said if what == "right"} & gone
                best = {o: max(i for _, p, i in said if p == o) for o in found}
                row = np.array([len(gone), len(found), *(sum(w == kind for w, _, _ in said) for kind in ("right", "shed", "wrong"))])
                lines.append([place, seed, *row, percent(row[1], row[0]), percent(row[2], row[2] + row[4]), f"{np.median(list(best.values())):.2f}" if best else ""])
                if not real:
                    total, ious = total + row, ious + list(best.values())
        lines.append(["synthetic", "all", *total, percent(total[1], total[0]), percent(total[2], total[2] + total[4]), f"{np.median(ious):.2f}" if ious else ""])
        table(["place", "seed", "left out, 20 m2 and more", "found", "candidates right", "sheds", "wrong", "recall", "precision", "IoU of the found, median"], lines)
        print("Nothing left out:\n")
        table(["place", "buildings seen", "sheds", "wrong"], plain + [["synthetic", *total_plain]])
        self.result["unmapped"] = [[str(v) for v in line] for line in lines + plain]

    def courtyards(self):
        """Holes that holes.py cut where a roof lies (built over), and real ones (open)."""
        print("### Courtyards: open, or built over\n")
        lines, total = [], np.zeros(6, int)
        for place in self.rendered() + ["pariser-platz", "kampala"]:
            real = place in ("pariser-platz", "kampala")
            whole, image = {"kampala": (self.kampala_osm, self.kampala_image), "pariser-platz": (self.platz_osm, self.platz_image)}.get(place) or (self.extract_of(place), self.image_of(place))
            for seed in self.a.seeds:
                extract = os.path.join(self.a.work, f"holes-{place}-{seed}.osm")
                holes.cut_holes(whole, extract, seed)
                answer, truth = self.run(f"holes-{place}-{'real' if real else self.a.set}-{seed}", extract, image), holes.read_holes(extract[:-4] + ".csv")
                said = [(truth[b["id"]], c["courtyard"]) for b in answer["buildings"] for c in b.get("courtyards", []) if b["id"] in truth]
                count = lambda cut, state: sum(t == cut and (state is None or s == state) for t, s in said)
                row = np.array([count(1, None), count(1, "perhaps_built_over"), count(1, "open"), count(0, None), count(0, "open"), count(0, "perhaps_built_over")])
                lines.append([place, seed, *row, percent(row[1] + row[4], row[1] + row[2] + row[4] + row[5])])
                total += 0 if real else row
        lines.append(["synthetic", "all", *total, percent(total[1] + total[4], total[1] + total[2] + total[4] + total[5])])
        table(["place", "seed", "holes cut into roofs", "told built over", "told open", "real courtyards", "told open", "told built over", "of what is told right"], lines)
        self.result["courtyards"] = [[str(v) for v in line] for line in lines]

    # ---- what is seen of roofs ------------------------------------------------------------------------------------

    def colours(self):
        print("### Roof colour, CIEDE2000 against hand-picked places\n")
        lines, everything = [], []
        for name, file, key, extract, image in (("kampala", "kampala_roof_colours.csv", lambda r: f"w{int(r['index']) + 1}", self.kampala_osm, self.kampala_image),
                                                ("pariser-platz", "pariser_platz_roof_colours.csv", lambda r: {"way": "w", "relation": "r"}[r["osm"].split("/")[0]] + r["osm"].split("/")[1],
                                                 self.platz_osm, self.platz_image)):
            answer = {b["id"]: b for b in self.run(name if name != "kampala" else "kampala-plain", extract, image)["buildings"]}
            picked = {}
            for r in truth_rows(file):
                picked.setdefault(key(r), []).append([float(r[c]) for c in "rgb"])
            errors = {}
            for id_, places in picked.items():
                said = answer.get(id_, {}).get("roof_colour")
                if said:
                    errors[id_] = ciede2000.of_srgb(hex_rgb(said), np.mean(places, 0))
            everything += list(errors.values())
            self.result.setdefault("colours", {})[name] = errors
            lines.append([name, len(picked), len(errors)] + spread(errors.values()))
        lines.append(["both", 60, len(everything)] + spread(everything))
        table(["place", "roofs", "claimed", "median", "p90", "share up to 8"], lines)
        for name, errors in self.result["colours"].items():
            print(f"{name}, the farthest: " + ", ".join(f"{i} {e:.1f}" for i, e in sorted(errors.items(), key=lambda x: -x[1])[:8]))
        print("\nSynthetic roofs (truth: median of the sunlit plane in the picture):\n")
        lines = []
        for place in self.rendered():
            truth = self.truth_of(place)["buildings"]
            answer = {b["id"]: b for b in self.run(f"plain-{place}-{self.a.set}", self.extract_of(place), self.image_of(place))["buildings"]}
            seen = {i: t for i, t in truth.items() if t["roof_colour_srgb"] and t["roof_seen_m2"] > 20 and t["roof_sunlit_share"] > .2}
            errors = [ciede2000.of_srgb(hex_rgb(answer[i]["roof_colour"]), t["roof_colour_srgb"]) for i, t in seen.items() if answer.get(i, {}).get("roof_colour")]
            lines.append([place, len(seen), len(errors)] + spread(errors))
        table(["place", "roofs", "claimed", "median", "p90", "share up to 8"], lines)

    def rendered(self):
        return [p for p in self.a.places if os.path.exists(self.image_of(p))]

    def ridges(self):
        print("### Flat or pitched, ridge direction (within 15 degrees modulo 180), heights from shadows\n")
        form, ridge, height = [], [], []
        all_form, all_ridge, all_height = [], [], []
        for place in self.rendered():
            truth = self.truth_of(place)["buildings"]
            answer = {b["id"]: b for b in self.run(f"plain-{place}-{self.a.set}", self.extract_of(place), self.image_of(place))["buildings"]}
            seen = {i: t for i, t in truth.items() if t["roof_seen_m2"] > 10}
            f = [(t["form"], answer.get(i, {}).get("roof_form")) for i, t in seen.items() if t["form"] in ("flat", "pitched")]
            g = [(t["ridge_azimuth_deg"], answer.get(i, {}).get("ridge_azimuth_deg")) for i, t in seen.items() if t["ridge_azimuth_deg"] is not None]
            h = [(t["height_m"], t["eaves_m"], answer.get(i, {}).get("height_from_shadow_m")) for i, t in seen.items()]
            form.append([place] + form_cells(f))
            ridge.append([place] + ridge_cells(g))
            height.append([place] + height_cells(h))
            all_form, all_ridge, all_height = all_form + f, all_ridge + g, all_height + h
        labels = {r["index"]: r for r in truth_rows("kampala_labels.csv")}
        answer = {b["id"]: b for b in self.run("kampala-plain", self.kampala_osm, self.kampala_image)["buildings"]}
        said = lambda index: answer.get(f"w{int(index) + 1}", {})
        f = [(r["roof"], said(r["index"]).get("roof_form")) for r in labels.values() if r["roof"] in ("flat", "pitched") and r["verdict"] in ("right", "shifted")]
        g = [(float(r["azimuth_deg"]), said(r["index"]).get("ridge_azimuth_deg")) for r in truth_rows("kampala_ridges.csv")]
        form += [["synthetic"] + form_cells(all_form), ["kampala"] + form_cells(f)]
        ridge += [["synthetic"] + ridge_cells(all_ridge), ["kampala"] + ridge_cells(g)]
        height.append(["synthetic"] + height_cells(all_height))
        table(["place", "roofs", "claimed", "right", "share right", "flat said pitched", "pitched said flat", "always the commoner"], form)
        table(["place", "ridges", "claimed", "share", "within 15 degrees", "share right", "median error"], ridge)
        table(["place", "buildings", "claimed", "MAE against top, m", "MAE against eaves, m"], height)
        print("Kampala, ridges said wrong: " + (", ".join(f"{r['index']} ({float(r['azimuth_deg']):.0f}, said {said(r['index'])['ridge_azimuth_deg']:.0f})" for r in truth_rows("kampala_ridges.csv")
              if said(r["index"]).get("ridge_azimuth_deg") is not None and angle_between(float(r["azimuth_deg"]), said(r["index"])["ridge_azimuth_deg"]) > 15) or "none") + "\n")
        self.result["ridges"] = dict(form=form, ridge=ridge, height=height)


def form_cells(pairs):
    claimed = [(t, s) for t, s in pairs if s in ("flat", "pitched")]
    right = sum(t == s for t, s in claimed)
    common = max(sum(t == k for t, _ in pairs) for k in ("flat", "pitched")) / len(pairs) if pairs else math.nan
    return [len(pairs), len(claimed), right, percent(right, len(claimed)), sum(p == ("flat", "pitched") for p in claimed), sum(p == ("pitched", "flat") for p in claimed), f"{100 * common:.0f} %"]


def ridge_cells(pairs):
    claimed = [angle_between(t, s) for t, s in pairs if s is not None]
    right = sum(e <= 15 for e in claimed)
    return [len(pairs), len(claimed), percent(len(claimed), len(pairs)), right, percent(right, len(claimed)), f"{np.median(claimed):.1f}" if claimed else ""]


def height_cells(rows):
    claimed = [r for r in rows if r[2] is not None]
    return [len(rows), len(claimed)] + [f"{np.mean([abs(r[k] - r[2]) for r in claimed]):.2f}" if claimed else "" for k in (0, 1)]


def percent(n, of):
    return f"{100 * n / of:.1f} %" if of else ""


def spread(errors):
    e = np.array(list(errors))
    return [f"{np.median(e):.1f}", f"{np.quantile(e, .9):.1f}", f"{100 * np.mean(e <= 8):.0f} %"] if len(e) else ["", "", ""]


def num(v):
    return "" if v is None else f"{v:.3g}" if isinstance(v, (int, float)) else str(v)


def vector(v):
    return "" if not v else f"{v[0]:+.2f}, {v[1]:+.2f}"


def hex_rgb(text):
    return [int(text[i:i + 2], 16) for i in (1, 3, 5)]


def polygon_of(rings):
    """Even-odd polygon of (n, 2) rings: the first or largest is the outline, rings within are holes."""
    shape = None
    for r in sorted(rings, key=lambda r: -abs(np.dot(r[:, 0], np.roll(r[:, 1], -1)) - np.dot(r[:, 1], np.roll(r[:, 0], -1)))):
        ring = ogr.Geometry(ogr.wkbLinearRing)
        for x, y in r:
            ring.AddPoint_2D(float(x), float(y))
        ring.CloseRings()
        g = ogr.Geometry(ogr.wkbPolygon)
        g.AddGeometry(ring)
        if not g.IsValid():
            g = g.Buffer(0)
        shape = g if shape is None else shape.SymmetricDifference(g)
    return shape


def merge(shapes):
    out = shapes[0]
    for s in shapes[1:]:
        out = out.Union(s)
    return out


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("what", choices=["kampala", "synthetic", "walls", "pariser-platz", "georeference", "colours", "ridges", "gone", "unmapped", "courtyards"])
    a.add_argument("--program", default=os.path.join(HERE, "../../../build/release/blockrand"))
    a.add_argument("--shared", default="/work/shared" if os.path.isdir("/work/shared") else os.path.join(HERE, "../../../../shared"))
    a.add_argument("--images", default="/work/imagery_bench", help="rendered pictures: FOLDER/SET/PLACE.tif; estate.osm")
    a.add_argument("--set", choices=["tuning", "judging"], default="judging")
    a.add_argument("--also", choices=["tuning", "judging"], help="synthetic: with the pictures of this set as well, as images that overlap")
    a.add_argument("--places", nargs="+", default=list(PLACES), choices=list(PLACES) + ["estate"])
    a.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3, 4, 5])
    a.add_argument("--min", type=float, default=1)
    a.add_argument("--max", type=float, default=3)
    a.add_argument("--rotate", type=float, default=0)
    a.add_argument("--jitter", type=float, default=0)
    a.add_argument("--share", type=float, default=.5, help="synthetic: share of the buildings that are displaced")
    a.add_argument("--kinds", nargs="+", default=["walls", "corners"], choices=["walls", "corners"], help="walls: what is off")
    a.add_argument("--lod", type=int, default=0)
    a.add_argument("--work", default="/tmp/imagery_bench")
    a.add_argument("--json", help="else WORK/WHAT.json")
    a.add_argument("--reuse", action="store_true", help="take answers that --work already holds")
    a.add_argument("--keep-builds", action="store_true")
    a.add_argument("--args", nargs=argparse.REMAINDER, default=[], help="more arguments of the program; last")
    a = a.parse_args()
    bench = Bench(a)
    getattr(bench, a.what.replace("-", "_"))()
    with open(a.json or os.path.join(a.work, a.what + ".json"), "w") as f:
        json.dump(bench.result, f, indent=1)


if __name__ == "__main__":
    main()
