"""What imagery.json says of single walls against what is known: distance of walls from the true ones, before and after they are shifted."""
import numpy as np

import osm
from corrections import corrected, rigid
from displace import Buildings

TAKEN = ("corrected", "left_alone")


def rings_of(path, epsg):
    """{id: [(n + 1, 2) closed rings]} of an extract's buildings."""
    return Buildings(osm.Extract(path), epsg).rings


def true_place(p, wrong, right):
    """Where the point that lies at `p` on the wrong rings lies on the right ones: of the nearest wall, in proportion."""
    best = None
    for w, r in zip(wrong, right):
        a, d = w[:-1], w[1:] - w[:-1]
        t = np.clip(((p - a) * d).sum(1) / np.maximum((d * d).sum(1), 1e-12), 0, 1)
        off = np.hypot(*(a + t[:, None] * d - p).T)
        i = int(np.argmin(off))
        if best is None or off[i] < best[0]:
            best = off[i], r[i] + t[i] * (r[i + 1] - r[i])
    return best[1]


def judge(answers, right, wrong, touched, offsets=None):
    """answers: imagery.json's buildings; right, wrong: rings_of the true and the displaced extract; touched: ids that are not right.
    -> (walls, buildings): dicts of what every wall that is seen elsewhere, and every building that was looked at, is off by, in m."""
    walls, buildings = [], []
    for a in answers:
        told = a.get("walls")
        if not told or a["id"] not in right or a["id"] not in wrong:
            continue
        goal = [r + np.asarray(offsets.get(a["id"], (0, 0)) if offsets else (0, 0)) for r in right[a["id"]]]
        now = [rigid(r, a) for r in wrong[a["id"]]]
        for w in told.get("seen_elsewhere", []):
            at, normal = np.array(w["at"]), np.array(w["normal"])
            off = float((true_place(at, now, goal) - at) @ normal)
            walls.append(dict(w, id=a["id"], off=off, before=abs(off), after=abs(off - w["shift_m"]), clear=(w["before"], w["after"]), touched=a["id"] in touched, state=a["state"], leans=float(np.hypot(*a["lean_m"])),
                              taken=w["taken"] and told["state"] == "refined"))
        corners = lambda rings: np.vstack([r[:-1] for r in rings])
        error = lambda rings: np.hypot(*(corners(rings) - corners(goal)).T)
        before, after = error(now), error([corrected(r, a) for r in wrong[a["id"]]])
        buildings.append(dict(id=a["id"], touched=a["id"] in touched, taken=told["state"] == "refined", reason=told.get("reason", ""), before=float(before.mean()), after=float(after.mean()),
                              worst_before=float(before.max()), worst_after=float(after.max()), confidence=told.get("confidence")))
    return walls, buildings


HEAD = ["houses looked at", "off: wall or corner", "refined", "share", "walls shifted", "wall off before: median", "p90", "after: median", "p90", "nearer", "corners of refined before", "after", "right houses", "refined",
        "worse > 0.2 m", "share", "worse > 0.5 m", "share"]


def cells(walls, buildings):
    q = lambda v, p: f"{np.quantile(v, p):.2f}" if len(v) else ""
    share = lambda n, of: f"{100 * n / of:.1f} %" if of else ""
    shifted = [w for w in walls if w["taken"]]
    before, after = [w["before"] for w in shifted], [w["after"] for w in shifted]
    off, right = [b for b in buildings if b["touched"]], [b for b in buildings if not b["touched"]]
    taken = [b for b in off if b["taken"]]
    worse = lambda by: sum(b["after"] - b["before"] > by for b in right)
    mean = lambda k: f"{np.mean([b[k] for b in taken]):.2f}" if taken else ""
    return [len(buildings), len(off), len(taken), share(len(taken), len(off)), len(shifted), q(before, .5), q(before, .9), q(after, .5), q(after, .9),
            share(sum(a < b for a, b in zip(after, before)), len(shifted)), mean("before"), mean("after"), len(right), sum(b["taken"] for b in right),
            worse(.2), share(worse(.2), len(right)), worse(.5), share(worse(.5), len(right))]
