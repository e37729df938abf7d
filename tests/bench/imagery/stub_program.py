#!/usr/bin/python3
"""Stands in for the program while evaluate.py is tested: writes imagery.json from the truth beside the extract, with known faults.

Takes what evaluate.py passes to `blockrand build`. Of ten buildings one is left alone and one correction is off by 1 m east.
"""
import csv
import json
import os
import sys

import numpy as np

import osm
from displace import Buildings


def main():
    a = sys.argv
    extract, out, image = a[2], a[a.index("-o") + 1], a[a.index("--imagery") + 1]
    os.makedirs(out, exist_ok=True)
    truth = os.path.splitext(extract)[0] + ".csv"
    b = Buildings(osm.Extract(extract))
    known = {}
    if extract.endswith(".osm") and os.path.exists(truth):
        with open(truth) as f:
            f.readline()
            known = {r["id"]: r for r in csv.DictReader(f)}
    rows = []
    for k, (o, row) in enumerate(b.rows.items()):
        if not b.objects[o][1]:
            continue
        t = known.get(o)
        moved = t and t["moved"] == "1"
        answer = dict(id=o, row=row, state="left_alone", reason="no gain", shift_m=None, rotation_deg=0, centre=None, gain=0, confidence=0, image=0, roof_colour="#806050", roof_form="pitched",
                      ridge_azimuth_deg=45.0, height_from_shadow_m=12.0)
        if moved and k % 10:
            d, turn = np.array([float(t["dx"]), float(t["dy"])]), float(t["rotation_deg"])
            answer.update(state="corrected", reason="", shift_m=[float(-d[0] + (k % 10 == 1)), float(-d[1])], rotation_deg=-turn, centre=[float(t["row_x"]) + d[0], float(t["row_y"]) + d[1]], gain=1, confidence=.9)
        rows.append(answer)
    with open(os.path.join(out, "imagery.json"), "w") as f:
        json.dump(dict(images=[dict(path=image, state="used", shift_m=[0.0, 0.0], score=1.0, margin=.5)], buildings=rows), f)
    with open(os.path.join(out, "build.json"), "w") as f:
        json.dump(dict(crs=dict(code=f"EPSG:{b.epsg}")), f)


if __name__ == "__main__":
    main()
