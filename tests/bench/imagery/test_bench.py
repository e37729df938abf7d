#!/usr/bin/python3
"""Self tests of the evaluation of aerial images: /usr/bin/python3 test_bench.py (exit 77 where numpy, GDAL or osmium are missing)."""
import json
import math
import os
import shutil
import sys
import tempfile
import unittest

try:
    import numpy as np
    from osgeo import gdal  # noqa: F401
except ImportError as e:
    print(f"skipped: {e}")
    sys.exit(77)
if not shutil.which("osmium"):
    print("skipped: no osmium-tool")
    sys.exit(77)

import candidates
import ciede2000
import corrections
import displace
import estate
import ghosts
import holes
import misregister
import model
import omit
import osm
import render
from raster import Buffer, View

# Sharma, Wu, Dalal 2005, table 1: L, a, b of two colours, difference.
SHARMA = """50 2.6772 -79.7751 50 0 -82.7485 2.0425
50 3.1571 -77.2803 50 0 -82.7485 2.8615
50 2.8361 -74.0200 50 0 -82.7485 3.4412
50 -1.3802 -84.2814 50 0 -82.7485 1.0000
50 -1.1848 -84.8006 50 0 -82.7485 1.0000
50 -0.9009 -85.5211 50 0 -82.7485 1.0000
50 0 0 50 -1 2 2.3669
50 -1 2 50 0 0 2.3669
50 2.4900 -0.0010 50 -2.4900 0.0009 7.1792
50 2.4900 -0.0010 50 -2.4900 0.0010 7.1792
50 2.4900 -0.0010 50 -2.4900 0.0011 7.2195
50 2.4900 -0.0010 50 -2.4900 0.0012 7.2195
50 -0.0010 2.4900 50 0.0009 -2.4900 4.8045
50 -0.0010 2.4900 50 0.0010 -2.4900 4.8045
50 -0.0010 2.4900 50 0.0011 -2.4900 4.7461
50 2.5 0 50 0 -2.5 4.3065
50 2.5 0 73 25 -18 27.1492
50 2.5 0 61 -5 29 22.8977
50 2.5 0 56 -27 -3 31.9030
50 2.5 0 58 24 15 19.4535
50 2.5 0 50 3.1736 0.5854 1.0000
50 2.5 0 50 3.2972 0 1.0000
50 2.5 0 50 1.8634 0.5757 1.0000
50 2.5 0 50 3.2592 0.3350 1.0000
60.2574 -34.0099 36.2677 60.4626 -34.1751 39.4387 1.2644
63.0109 -31.0961 -5.8663 62.8187 -29.7946 -4.0864 1.2630
61.2901 3.7196 -5.3901 61.4292 2.2480 -4.9620 1.8731
35.0831 -44.1164 3.7933 35.0232 -40.0716 1.5901 1.8645
22.7233 20.0904 -46.6940 23.0331 14.9730 -42.5619 2.0373
36.4612 47.8580 18.3852 36.2715 50.5065 21.2231 1.4146
90.8027 -2.0831 1.4410 91.1528 -1.6435 0.0447 1.4441
90.9257 -0.5406 -0.9208 88.6381 -0.8985 -0.7239 1.5381
6.7747 -0.2908 -2.4247 5.8714 -0.0985 -2.2286 0.6377
2.0776 0.0795 -1.1350 0.9033 -0.0636 -0.5514 0.9082"""


class Colours(unittest.TestCase):
    def test_published_pairs(self):
        for line in SHARMA.splitlines():
            v = [float(x) for x in line.split()]
            self.assertAlmostEqual(ciede2000.difference(v[:3], v[3:6]), v[6], places=4, msg=line)
            self.assertAlmostEqual(ciede2000.difference(v[3:6], v[:3]), v[6], places=4, msg=line)

    def test_srgb(self):
        for rgb, want in (((255, 255, 255), (100, 0, 0)), ((255, 0, 0), (53.24, 80.09, 67.20)), ((0, 0, 255), (32.30, 79.19, -107.86))):
            np.testing.assert_allclose(ciede2000.lab(rgb), want, atol=.03)


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="imagery_test_")

    def tearDown(self):
        shutil.rmtree(self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)


class Displacements(InFolder):
    def test_there_and_back(self):
        source, moved = self.path("estate.osm"), self.path("moved.osm")
        estate.estate(source)
        b, moves = displace.displace(source, moved, 3, 1, 3, rotate=2)
        self.assertGreater(len(moves), 100)
        epsg, truth = corrections.read_truth(self.path("moved.csv"))
        right, wrong = corrections.outlines(source, epsg), corrections.outlines(moved, epsg)
        for o, t in truth.items():
            way = np.hypot(*(wrong[o] - right[o]).T)
            self.assertGreater(way.max(), .5)
            self.assertLess(way.max(), 3 + displace.TURN + .01)
            undone = dict(shift_m=[-t["dx"], -t["dy"]], rotation_deg=-t["rotation_deg"], centre=[t["row_x"] + t["dx"], t["row_y"] + t["dy"]])
            self.assertLess(np.hypot(*(corrections.corrected(wrong[o], undone) - right[o]).T).max(), 1e-3, o)

    def test_only_buildings_move(self):
        source, moved = self.path("in.osm"), self.path("out.osm")
        # Two houses share a wall; a street and a fence use corners of the first; a third house is far away.
        nodes = [(8.6, 52.0), (8.6002, 52.0), (8.6002, 52.0001), (8.6, 52.0001), (8.6004, 52.0), (8.6004, 52.0001), (8.601, 52.0), (8.6011, 52.0), (8.6011, 52.0001), (8.59, 52.0)]
        ways = [([1, 2, 3, 4, 1], "building"), ([2, 5, 6, 3, 2], "building"), ([7, 8, 9, 7], "building"), ([10, 1], "highway"), ([4, 10], "barrier")]
        with open(source, "w") as f:
            f.write("<osm version='0.6'>" + "".join(f"<node id='{i}' lat='{y}' lon='{x}' version='1'/>" for i, (x, y) in enumerate(nodes, 1))
                    + "".join(f"<way id='{i}' version='1'>" + "".join(f"<nd ref='{r}'/>" for r in refs) + f"<tag k='{k}' v='yes'/></way>" for i, (refs, k) in enumerate(ways, 1)) + "</osm>")
        b, moves = displace.displace(source, moved, 1, 2, 2)
        self.assertEqual(b.rows["w1"], b.rows["w2"])
        self.assertNotEqual(b.rows["w1"], b.rows["w3"])
        before, after = osm.Extract(source), osm.Extract(moved)
        for way in (4, 5):
            self.assertEqual([before.nodes[n] for n in before.ways[way][0]], [after.nodes[n] for n in after.ways[way][0]])
        self.assertEqual(len(after.nodes), len(nodes) + 2)
        self.assertEqual(after.ways[1][0][1:3], after.ways[2][0][0::3][:2])  # the shared wall is still shared
        right, wrong = corrections.outlines(source, b.epsg), corrections.outlines(moved, b.epsg)
        for o in right:
            np.testing.assert_allclose(np.hypot(*(wrong[o] - right[o]).T), 2, atol=1e-3)
        np.testing.assert_allclose((wrong["w1"] - right["w1"])[0], (wrong["w2"] - right["w2"])[0], atol=1e-3)

    def test_share(self):
        source = self.path("estate.osm")
        estate.estate(source)
        b, moves = displace.displace(source, self.path("half.osm"), 1, 1, 3, share=.5)
        n = sum(b.rows[o] in moves for o in b.rows) / len(b.rows)
        self.assertTrue(.35 < n < .65, n)
        b, moves = displace.displace(source, self.path("none.osm"), 1, 1, 3, share=0)
        self.assertEqual(moves, {})


class Ghosts(InFolder):
    def test_they_stand_where_nothing_does(self):
        source, target = self.path("estate.osm"), self.path("ghosts.osm")
        estate.estate(source)
        ids = ghosts.add_ghosts(source, target, 3, .2)
        before, after = displace.Buildings(osm.Extract(source)), displace.Buildings(osm.Extract(target))
        self.assertGreater(len(ids), 3)
        self.assertEqual(set(after.rings) - set(before.rings), set(ids))
        for o in before.rings:
            np.testing.assert_allclose(before.rings[o][0], after.rings[o][0], atol=1e-6)
        for o in ids:
            self.assertEqual([x for x in after.rows if after.rows[x] == after.rows[o]], [o], "2 m from any other")


class Omissions(InFolder):
    def test_a_share_of_the_houses_is_left_out_and_nothing_else(self):
        source, target = self.path("estate.osm"), self.path("omit.osm")
        estate.estate(source)
        gone = omit.omit(source, target, 3, .2)
        before, after = displace.Buildings(osm.Extract(source)), displace.Buildings(osm.Extract(target))
        self.assertAlmostEqual(len(gone) / len(before.rings), .2, delta=.02)
        self.assertEqual(set(before.rings) - set(after.rings), set(gone))
        for o in after.rings:
            np.testing.assert_array_equal(before.rings[o][0], after.rings[o][0])
        self.assertEqual(omit.omit(source, target, 3, .2), gone, "the same seed, the same houses")
        self.assertEqual(omit.omit(source, target, 3, 0), [])

    def test_candidates_are_judged_where_the_image_shows_the_roofs(self):
        source, target = self.path("estate.osm"), self.path("omit.osm")
        estate.estate(source)
        gone = omit.omit(source, target, 3, .2)
        whole = displace.Buildings(osm.Extract(source))
        lean = np.array([1.5, -1.0])
        scene = dict(buildings={o: dict(lean_m=list(lean), roof_seen_m2=99.0) for o in whole.rings}, unmapped=[dict(centre=[0.0, 0.0], size_m=[5, 3], height_m=2)])
        truth = candidates.Truth(source, target, whole.epsg, scene)
        self.assertEqual(set(truth.roofs), set(gone))
        house = max(gone, key=lambda o: truth.roofs[o].Area())
        self.assertIn(house, truth.large())
        self.assertNotIn(min(gone, key=lambda o: truth.roofs[o].Area()), truth.large(), "a garage")
        ring = whole.rings[house][0][:-1]
        what, o, iou = truth.judge(dict(outline=ring.tolist(), lean_m=list(lean)))
        self.assertEqual((what, o), ("right", house))
        self.assertGreater(iou, .99)
        self.assertLess(truth.judge(dict(outline=ring.tolist(), lean_m=[0, 0]))[2], .95)
        self.assertEqual(truth.judge(dict(outline=[[-3, -2], [3, -2], [3, 2], [-3, 2]], lean_m=[0, 0]))[0], "shed")
        self.assertEqual(truth.judge(dict(outline=(ring + 900).tolist(), lean_m=[0, 0]))[0], "wrong")


class Holes(InFolder):
    def test_they_lie_within_their_houses(self):
        source, target = self.path("in.osm"), self.path("out.osm")
        corners = lambda x, y, w, d: [(8.6 + (x + a) / 68500, 52 + (y + b) / 111200) for a, b in ((0, 0), (w, 0), (w, d), (0, d))]
        # A hall; four houses around a courtyard; a shed that is too small for a hole.
        houses = [corners(0, 0, 40, 20), corners(100, 0, 40, 10), corners(130, 10, 10, 20), corners(100, 30, 40, 10), corners(100, 10, 10, 20), corners(300, 0, 6, 6)]
        with open(source, "w") as f:
            f.write("<osm version='0.6'>" + "".join(f"<node id='{10 * k + i}' lat='{y:.7f}' lon='{x:.7f}' version='1'/>" for k, h in enumerate(houses, 1) for i, (x, y) in enumerate(h))
                    + "".join(f"<way id='{k}' version='1'>" + "".join(f"<nd ref='{10 * k + i}'/>" for i in (0, 1, 2, 3, 0)) + "<tag k='building' v='house'/></way>" for k in range(1, len(houses) + 1)) + "</osm>")
        ids = holes.cut_holes(source, target, 1, 1)
        self.assertEqual(len(ids), 1)
        after = displace.Buildings(osm.Extract(target))
        outer, inner = after.rings[ids[0]]
        self.assertTrue(all(displace.within(p, displace.segments([outer])) for p in inner))
        self.assertTrue(.07 < holes.area(inner) / holes.area(outer) < .26)
        truth = holes.read_holes(self.path("out.csv"))
        self.assertEqual(sorted(truth.values()), [0, 1])
        court = next(o for o, cut in truth.items() if not cut)
        self.assertAlmostEqual(holes.area(after.rings[court][1]), 20 * 20, delta=15)
        self.assertEqual(set(after.rings), {ids[0], court, "w6"}, "what is one building now is mapped once")


def write_box(folder, height=12.0, size=(20.0, 15.0)):
    """A build of one flat box whose south-west corner lies at (500000, 5700000) of EPSG:25832, and an extract without streets."""
    x, y = (int(v * 1000) for v in size)
    z = int(height * 1000)
    vertices = [[0, 0, 0], [x, 0, 0], [x, y, 0], [0, y, 0], [0, 0, z], [x, 0, z], [x, y, z], [0, y, z]]
    faces = [[[3, 2, 1, 0]], [[0, 1, 5, 4]], [[1, 2, 6, 5]], [[2, 3, 7, 6]], [[3, 0, 4, 7]], [[4, 5, 6, 7]]]
    head = dict(type="CityJSON", version="2.0", transform=dict(scale=[.001] * 3, translate=[500000, 5700000, 0]), metadata=dict(referenceSystem="https://www.opengis.net/def/crs/EPSG/0/25832"))
    solid = dict(type="Solid", lod="2", boundaries=[faces], semantics=dict(surfaces=[dict(type="GroundSurface"), dict(type="WallSurface"), dict(type="RoofSurface")], values=[[0, 1, 1, 1, 1, 2]]))
    feature = dict(type="CityJSONFeature", id="w1", CityObjects=dict(w1=dict(type="Building", geometry=[solid])), vertices=vertices)
    os.makedirs(os.path.join(folder, "cityjson"))
    with open(os.path.join(folder, "cityjson", "1.city.jsonl"), "w") as f:
        f.write(json.dumps(head) + "\n" + json.dumps(feature) + "\n")
    extract = os.path.join(folder, "extract.osm")
    with open(extract, "w") as f:
        f.write("<osm version='0.6'><node id='1' lat='51.45' lon='9' version='1'/></osm>")
    return extract


class Rendering(InFolder):
    def test_box(self):
        extract = write_box(self.folder)
        with open(os.devnull, "w") as quiet:
            for seed in range(1, 40):  # a roof that differs enough from the paving
                picture, truth, epsg, t = render.render(self.folder, seed, "tuning", .2, extract, quiet, bare=True)
                b = truth["buildings"]["w1"]
                ground = np.median(picture[5:60, 5:60].reshape(-1, 3), 0)
                if np.abs(ground - b["roof_colour_srgb"]).max() > 50:
                    break
        self.assertEqual(epsg, 25832)
        self.assertEqual((b["form"], b["ridge_azimuth_deg"]), ("flat", None))
        np.testing.assert_allclose(b["centre"], (500010, 5700007.5), atol=.01)
        self.assertTrue(.05 * 12 < math.hypot(*b["lean_m"]) < .35 * 12)
        # Lean: away from the nadir by height over flight height of the distance.
        nadir = np.array(truth["frames"][0]["nadir"])
        np.testing.assert_allclose(b["lean_m"], 12 / (truth["flight_height_m"] - 12) * (np.array(b["centre"]) - nadir), atol=.02)
        # The roof seen: pixels near the roof's colour; their middle lies at the centre plus lean, their area is the roof's.
        rows, columns = np.indices(picture.shape[:2])
        x, y = t[0] + (columns + .5) * t[1], t[3] + (rows + .5) * t[5]
        colour = np.abs(picture.astype(float) - b["roof_colour_srgb"]).max(-1) < 22
        scale = truth["flight_height_m"] / (truth["flight_height_m"] - 12)
        middle = np.array(b["centre"]) + b["lean_m"]

        def contrast(dx, dy):
            """Share of roof-coloured pixels within the roof moved by (dx, dy), less that in a frame of 1 m around it; a turret stands on the roof."""
            u, v = np.abs(x - middle[0] - dx) / scale, np.abs(y - middle[1] - dy) / scale
            inside, around = (u < 10) & (v < 7.5), (u < 11) & (v < 8.5)
            return colour[inside].mean() - colour[around & ~inside].mean()
        best = max(((dx, dy) for dx in np.arange(-1.5, 1.6, .25) for dy in np.arange(-1.5, 1.6, .25)), key=lambda d: contrast(*d))
        np.testing.assert_allclose(best, (0, 0), atol=.3)
        self.assertGreater(contrast(0, 0), .7)
        # The shadow: along the ray from the middle away from the sun, dark up to height / tan(elevation) beyond the wall.
        azimuth, elevation = math.radians(truth["sun_azimuth_deg"]), math.radians(truth["sun_elevation_deg"])
        u = -np.array([math.sin(azimuth), math.cos(azimuth)])
        wall = min(10 / abs(u[0]), 7.5 / abs(u[1]))
        length = 12 / math.tan(elevation)
        s = np.arange(wall + length - 3, wall + length + 3, .1)
        profile = []
        for d in s:
            p = np.array(b["centre"]) + u * d
            c, r = int((p[0] - t[0]) / .2), int((p[1] - t[3]) / -.2)
            profile.append(picture[r - 1:r + 2, c - 1:c + 2].mean())
        profile = np.array(profile)
        middle = (np.median(profile[:15]) + np.median(profile[-15:])) / 2
        self.assertLess(np.median(profile[:15]), .75 * np.median(profile[-15:]))
        end = s[np.argmax(profile > middle)]
        self.assertAlmostEqual(end, wall + length, delta=.45)

    def test_same_seed_same_picture(self):
        extract = write_box(self.folder)
        with open(os.devnull, "w") as quiet:
            a = render.render(self.folder, 1, "judging", .4, extract, quiet)
            b = render.render(self.folder, 1, "judging", .4, extract, quiet)
        self.assertTrue((a[0] == b[0]).all())
        self.assertEqual(a[1], b[1])

    def test_view(self):
        v = View.camera((100, 50), 1000)
        p = v.place(np.array([[300., 50., 100.]]))[0]
        np.testing.assert_allclose(p, (100 + 200 / .9, 50))
        b = Buffer(View.sun((1.0, 0.0)), 0, 20, 200, 200, .1)
        roof = np.array([[12., 5, 5], [16, 5, 5], [16, 9, 5], [12, 9, 5]])
        b.polygon([roof], np.array([0., 0, 1]), 7)
        hit = np.argwhere(b.id == 7)
        np.testing.assert_allclose((hit.min(0), hit.max(0)), ((110, 70), (149, 109)))  # the sun in the east: 5 m to the west

    def test_ridge(self):
        roof = lambda *p: model.Face([np.array(p, float)], model.newell(np.array(p, float))[0], "Roof", 0)
        b = model.Building("w1", {})
        b.faces = [roof((0, 0, 5), (10, 0, 5), (10, 4, 8), (0, 4, 8)), roof((0, 4, 8), (10, 4, 8), (10, 8, 5), (0, 8, 5))]
        form, ridge, _ = model.roof_truth(b)
        self.assertEqual(form, "pitched")
        self.assertAlmostEqual(ridge, 90)


class Misregistration(InFolder):
    def test_shift_and_turn(self):
        picture = np.random.default_rng(1).integers(0, 255, (40, 60, 3)).astype(np.uint8)
        good, bad = self.path("good.tif"), self.path("bad.tif")
        render.write(good, picture, 25832, (500000, .2, 0, 5700000, 0, -.2), None)
        misregister.misregister(good, bad, east=15, north=-3)
        np.testing.assert_allclose(gdal.Open(bad).GetGeoTransform(), (500015, .2, 0, 5699997, 0, -.2))
        misregister.misregister(good, bad, rotate90=True)
        d = gdal.Open(bad)
        self.assertEqual((d.RasterXSize, d.RasterYSize), (40, 60))
        g = d.GetGeoTransform()
        np.testing.assert_allclose((g[0] + 20 * g[1], g[3] + 30 * g[5]), (500006, 5699996))
        misregister.misregister(good, bad, mirror=True)
        np.testing.assert_array_equal(gdal.Open(bad).ReadAsArray(), np.moveaxis(picture, 2, 0)[:, :, ::-1])


class Walls(unittest.TestCase):
    def test_corners_go_with_the_nearest_wall_of_the_refined_outline(self):
        box = [0, 0, 10, 0, 10, 8, 0, 8]
        answer = dict(state="left_alone", shift_m=[.2, 0], rotation_deg=0, centre=[5, 4],
                      walls=dict(state="refined", outline_before=[box], outline_after=[[0, 0, 10.8, 0, 10.8, 8, 0, 8]]))
        got = corrections.corrected(np.array([[0., 0], [10, 0], [10.1, 4], [5, 8]]), answer)
        np.testing.assert_allclose(got, [[0, 0], [10.8, 0], [10.9, 4], [5.4, 8]], atol=1e-9)
        answer["walls"]["state"] = "refused"
        np.testing.assert_allclose(corrections.corrected(np.array([[10., 0]]), answer), [[10, 0]])

    def test_a_shifted_wall_leaves_the_others_on_their_lines(self):
        ring = np.array([[0., 0], [12, 0], [12, 8], [0, 8]])
        rng, done = np.random.default_rng(3), set()
        got = displace.shift_wall(ring, rng, done, [True] * 4)
        moved = [i for i in range(4) if np.hypot(*(got[i] - ring[i])) > .29]
        self.assertEqual(len(moved), 2)
        self.assertEqual(len(done), 1)
        self.assertEqual(sum(abs(got[i] - ring[i]).min() > 1e-9 for i in range(4)), 0)
        self.assertIsNone(displace.shift_wall(ring, rng, set(), [True, False, True, False]), "no wall has both its corners for itself")


if __name__ == "__main__":
    unittest.main()
