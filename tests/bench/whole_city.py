#!/usr/bin/python3
"""Builds a city too large for one run, box by box, and validates each box.

    whole_city.py EXTRACT --work FOLDER [--boxes 16] [--only 1,5-7] [--lod 3] [--formats cityjson] [--keep] [--program PATH]

The boxes are a k-d division: the centres of all building outlines are halved by their median along the longer side of their box, again
and again, until there are as many boxes as asked for (a power of two). The same extract gives the same boxes, numbered from west or
south. Prints a line for each box and one for all; `FOLDER/boxes.csv` has them. A box that was sound is not built again, so that the
run can be broken off and taken up. Needs osmium-tool.
"""
import argparse
import csv
import json
import math
import os
import resource
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def centres(extract):
    """(lon, lat) of the box around each way that is a building or part, or belongs to one that is a relation."""
    keys = [kind + key for key in ("building", "building:part") for kind in ("w/", "r/")]
    with tempfile.TemporaryDirectory() as folder:
        opl = os.path.join(folder, "buildings.opl")
        subprocess.run(["osmium", "tags-filter", extract, *keys, "-o", opl, "-f", "opl", "--overwrite"], check=True, stderr=subprocess.DEVNULL)
        places, out = {}, []
        with open(opl) as lines:
            for line in lines:
                fields = line.split()
                if line[0] == "n":
                    x, y = (f for f in fields if f[0] in "xy")
                    if len(x) > 1:
                        places[fields[0][1:]] = float(x[1:]), float(y[1:])
                elif line[0] == "w":
                    nodes = next(f for f in fields if f[0] == "N")[1:]
                    at = [places[n] for n in (ref.split("x")[0][1:] for ref in nodes.split(",") if ref) if n in places]
                    if at:
                        out.append(((min(p[0] for p in at) + max(p[0] for p in at)) / 2, (min(p[1] for p in at) + max(p[1] for p in at)) / 2))
    return out


def divide(points, box, count):
    """`count` boxes (west, south, east, north) that hold as many points each, more or less, and cover `box`."""
    if count == 1:
        return [box]
    shrink = math.cos(math.radians((box[1] + box[3]) / 2))
    axis = 0 if (box[2] - box[0]) * shrink > box[3] - box[1] else 1
    points = sorted(points, key=lambda p: p[axis])
    middle = round(points[len(points) // 2][axis], 7)
    low, high = list(box), list(box)
    low[axis + 2], high[axis] = middle, middle
    return divide(points[:len(points) // 2], tuple(low), count // 2) + divide(points[len(points) // 2:], tuple(high), count // 2)


def numbers(text, count):
    chosen = set()
    for part in text.split(","):
        first, _, last = part.partition("-")
        chosen.update(range(int(first), int(last or first) + 1))
    return sorted(n for n in chosen if 1 <= n <= count)


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("extract")
    p.add_argument("--work", required=True)
    p.add_argument("--boxes", type=int, default=16)
    p.add_argument("--only")
    p.add_argument("--lod", default="3")
    p.add_argument("--formats", default="cityjson")
    p.add_argument("--jobs", default="1")
    p.add_argument("--keep", action="store_true", help="builds of sound boxes")
    p.add_argument("--program", default=os.path.join(ROOT, "build/release/blockrand"))
    a = p.parse_args()
    if a.boxes & (a.boxes - 1) or a.boxes < 1:
        p.error("--boxes is a power of two")
    os.makedirs(a.work, exist_ok=True)
    points = centres(a.extract)
    around = (min(x for x, _ in points) - .01, min(y for _, y in points) - .01, max(x for x, _ in points) + .01, max(y for _, y in points) + .01)
    boxes = divide(points, tuple(round(v, 7) for v in around), a.boxes)
    table = os.path.join(a.work, "boxes.csv")
    done = {}
    if os.path.exists(table):
        with open(table) as f:
            done = {int(r["box"]): r for r in csv.DictReader(f)}
    failed = 0
    for n in numbers(a.only or f"1-{a.boxes}", a.boxes):
        if n in done and done[n]["sound"] == "yes":
            continue
        out, bbox = os.path.join(a.work, f"box{n}"), ",".join(f"{v:.7f}" for v in boxes[n - 1])
        start = cpu_seconds()
        built = subprocess.run([a.program, "build", a.extract, "-o", out, "--bbox", bbox, "--lod", a.lod, "--surroundings", "off", "--formats", a.formats, "--ground-height", "0", "--no-report",
                                "--no-explain", "--force", "--jobs", a.jobs, "--progress", "none", "-q"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        middle = cpu_seconds()
        row = dict(box=n, bbox=bbox.replace(",", " "), build_exit=built.returncode, models="", build_cpu_s=f"{middle - start:.0f}", validate_cpu_s="", sound="no")
        if built.returncode == 0:
            with open(os.path.join(out, "build.json")) as f:
                row["models"] = json.load(f)["counts"]["models"]
            judged = subprocess.run([a.program, "validate", out, "--jobs", a.jobs], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            row["validate_cpu_s"], row["sound"] = f"{cpu_seconds() - middle:.0f}", "yes" if judged.returncode == 0 else "no"
            with open(os.path.join(a.work, f"box{n}.validate.txt"), "w") as f:
                f.write(judged.stdout)
        else:
            print(built.stdout, file=sys.stderr)
        failed += row["sound"] != "yes"
        print(", ".join(f"{k} {v}" for k, v in row.items()), flush=True)
        done[n] = row
        with open(table, "w", newline="") as f:
            w = csv.DictWriter(f, list(row))
            w.writeheader()
            w.writerows(done[k] for k in sorted(done))
        if row["sound"] == "yes" and not a.keep:
            shutil.rmtree(out)
    sound = [r for r in done.values() if r["sound"] == "yes"]
    print(f"{len(sound)} of {a.boxes} boxes are sound: {sum(int(r['models']) for r in sound)} models")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
