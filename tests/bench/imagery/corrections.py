"""What imagery.json says against what is known: displacement left after a correction, measured at the corners of the outline."""
import csv
import math

import numpy as np

import osm
from displace import Buildings

WORSE = 0.5  # m


def read_truth(path):
    """CSV of displace.py -> (EPSG, {id: dict of numbers})."""
    with open(path) as f:
        epsg = int(f.readline().split("EPSG:")[1].split()[0])
        return epsg, {r["id"]: {k: float(v) for k, v in r.items() if k != "id"} for r in csv.DictReader(f)}


def outlines(path, epsg):
    """{id: (n, 2) corners of all rings in order} of an extract's buildings, and {id: row}."""
    b = Buildings(osm.Extract(path), epsg)
    return {o: np.vstack([x[:-1] for x in r]) for o, r in b.rings.items()}


def rigid(points, answer):
    """Points (n, 2) where the row of a building was moved: turned (counter-clockwise) about its centre, then shifted; as they are where it was not."""
    if answer.get("state", "corrected") != "corrected":
        return points
    shift, turn = answer.get("shift_m") or (0, 0), math.radians(answer.get("rotation_deg") or 0)
    centre = np.array(answer.get("centre") or points.mean(0))
    c, s = math.cos(turn), math.sin(turn)
    return (points - centre) @ np.array([[c, s], [-s, c]]) + centre + np.asarray(shift, float)


def refined(answer):
    """Were walls of it shifted by themselves?"""
    return answer.get("walls", {}).get("state") == "refined"


def corrected(points, answer):
    """Corners (n, 2) after the correction that a building's answer holds: moved with their row, then with the nearest wall of their outline."""
    moved = rigid(points, answer)
    if not refined(answer):
        return moved
    before = [np.array(r).reshape(-1, 2) for r in answer["walls"]["outline_before"]]
    by = np.vstack([np.array(r).reshape(-1, 2) - rigid(b, answer) for r, b in zip(answer["walls"]["outline_after"], before)])
    a, b = np.vstack(before), np.vstack([np.roll(r, -1, 0) for r in before])
    next_by, at = [], 0
    for r in before:
        next_by.append(np.roll(by[at:at + len(r)], -1, 0))
        at += len(r)
    next_by, d = np.vstack(next_by), b - a
    t = np.clip(((points[:, None] - a) * d).sum(2) / np.maximum((d * d).sum(1), 1e-12), 0, 1)
    wall = np.hypot(*np.moveaxis(points[:, None] - a - t[..., None] * d, 2, 0)).argmin(1)
    t = t[np.arange(len(points)), wall][:, None]
    return moved + by[wall] * (1 - t) + next_by[wall] * t


class Judged:
    """Rows of one run: a list of dict(id, moved, state, before, after) with distances in m: mean over the corners."""

    def __init__(self, answers, truth, right, wrong, keep=None, offsets=None):
        """answers: imagery.json's buildings; truth: of read_truth; right/wrong: corners before and after the displacement;
        keep: ids to judge; offsets: id -> (2,) m by which the true place differs from `right`."""
        by_id = {a["id"]: a for a in answers}
        self.rows, self.absent, self.without = [], 0, 0
        for id_, t in truth.items():
            if (t["part"] and id_ not in by_id) or (keep is not None and id_ not in keep) or id_ not in right:
                continue
            a = by_id.get(id_)
            if a is None:
                self.absent += 1
                continue
            if a.get("state") == "outside":
                self.without += 1
                continue
            goal = right[id_] + (offsets.get(id_, (0, 0)) if offsets else (0, 0))
            before = np.hypot(*(wrong[id_] - goal).T).mean()
            after = np.hypot(*(corrected(wrong[id_], a) - goal).T).mean()
            self.rows.append(dict(id=id_, row=int(t["row"]), moved=bool(t["moved"]), state=a["state"], changed=a["state"] == "corrected" or refined(a), reason=a.get("reason") or "", before=float(before), after=float(after),
                                  confidence=a.get("confidence"), gain=a.get("gain")))

    def summary(self):
        return summarise(self.rows) | {"outside": self.without, "absent": self.absent}


def summarise(rows):
    moved, right = [r for r in rows if r["moved"]], [r for r in rows if not r["moved"]]
    taken = [r for r in moved if r["state"] == "corrected"]
    after, before = np.array([r["after"] for r in taken]), np.array([r["before"] for r in moved])
    q = lambda v, p: float(np.quantile(v, p)) if len(v) else None
    worse = lambda rs: sum(r["after"] - r["before"] > WORSE for r in rs)
    return dict(displaced=len(moved), right=len(right), before_median=q(before, .5), before_p90=q(before, .9), taken=len(taken),
                taken_share=len(taken) / len(moved) if moved else None, after_median=q(after, .5), after_p90=q(after, .9),
                worse_of_displaced=worse(moved), right_changed=sum(r["changed"] for r in right), worse_of_right=worse(right),
                worse_share=worse(right) / len(right) if right else None,
                right_after_median=q(np.array([r["after"] for r in right if r["changed"]]), .5),
                states={s: sum(r["state"] == s for r in rows) for s in sorted({r["state"] for r in rows})})


HEAD = ["displaced", "before median", "p90", "taken", "share", "after median", "p90", "made worse", "right", "of them changed", "worse > 0.5 m", "share"]


def cells(s):
    n = lambda v, form="%.2f": "" if v is None else form % v
    return [s["displaced"], n(s["before_median"]), n(s["before_p90"]), s["taken"], n(s["taken_share"] and 100 * s["taken_share"], "%.0f %%"), n(s["after_median"]), n(s["after_p90"]),
            s["worse_of_displaced"], s["right"], s["right_changed"], s["worse_of_right"], n(None if s["worse_share"] is None else 100 * s["worse_share"], "%.1f %%")]


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for r in rows:
        print("| " + " | ".join(str(c) for c in r) + " |")
    print(flush=True)
