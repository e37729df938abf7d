#include "pipeline/geometry/check_solid.h"

#include <gtest/gtest.h>

#include <set>

#include "pipeline/geometry/ring_defects.h"
#include "pipeline/geometry/triangulate.h"
#include "tests/unit/geometry/broken_solids.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Solid;

SolidCheck check(const Solid& solid) { return check_solid(solid); }

TEST(CheckSolid, SoundSolidsPass) {
  const model::Point3 far{391000, 5819000, 34};
  EXPECT_EQ(check(testing_shapes::box(far, 10, 8, 6)).text(), "none");
  EXPECT_EQ(check(testing_shapes::gabled_house(far, 12, 9, 5, 9)).text(), "none");
  EXPECT_EQ(check(testing_shapes::courtyard_block(far, 60, 30, 18)).text(), "none");
}

TEST(CheckSolid, VolumeOfABox) {
  const Solid box = testing_shapes::box({391000, 5819000, 34}, 10, 8, 6);
  EXPECT_DOUBLE_EQ(volume(box, *triangulate(box)), 480);
}

TEST(CheckSolid, TellsEveryBrokenSolidByItsNumber) {
  const auto broken = testing_shapes::broken_solids();
  EXPECT_GE(broken.size(), 80u);
  for (const auto& b : broken) EXPECT_EQ(check(b.solid).code(), b.code) << b.name << ": " << check(b.solid).text();
}

TEST(CheckSolid, EveryClassHasABrokenSolid) {
  std::set<int> there;
  for (const auto& b : testing_shapes::broken_solids()) there.insert(b.code);
  for (const SolidDefectInfo& defect : kSolidDefects) {
    // Loops do not repeat their first vertex: only files can leave a ring open (tests/end_to_end/validate_model_files_test.py).
    if (defect.number == 0 || defect.number == iso_code(SolidDefect::ring_open)) continue;
    EXPECT_TRUE(there.count(defect.number)) << defect.number << ' ' << defect.name;
  }
}

TEST(CheckSolid, NeighboursOfBrokenSolidsAreSound) {
  for (const auto& s : testing_shapes::sound_solids()) EXPECT_EQ(check(s.solid).text(), "none") << s.name;
}

TEST(CheckSolid, NumbersAreThoseOfVal3dity) {
  // https://val3dity.readthedocs.io/2.5.1/errors.html
  EXPECT_EQ(iso_code(SolidDefect::ring_open), 103);
  EXPECT_EQ(iso_code(SolidDefect::folded), 204);
  EXPECT_EQ(iso_code(SolidDefect::non_manifold_edge), 303);
  EXPECT_EQ(iso_code(SolidDefect::non_manifold_vertex), 303);
  EXPECT_EQ(iso_code(SolidDefect::inside_out), 405);
  EXPECT_EQ(SolidCheck{SolidDefect::open_edge}.text(), "302 shell not closed");
}

TEST(CheckPolygon, KnowsRingsAndPlanes) {
  using Rings = std::vector<std::vector<model::Point3>>;
  const auto code = [](const Rings& rings) { return check_polygon(rings).code(); };
  const std::vector<model::Point3> frame{{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {0, 0, 1}};
  const std::vector<model::Point3> pane{{0.5, 0, 0.2}, {0.5, 0, 0.8}, {1.5, 0, 0.8}, {1.5, 0, 0.2}};
  EXPECT_EQ(code({frame}), 0);
  EXPECT_EQ(code({frame, pane}), 0);
  EXPECT_EQ(code({frame, {pane.rbegin(), pane.rend()}}), 208);
  EXPECT_EQ(code({frame, {{1.5, 0, 0.2}, {1.5, 0, 0.8}, {2.5, 0, 0.8}, {2.5, 0, 0.2}}}), 201);
  EXPECT_EQ(code({{{0, 0, 0}, {2, 0, 1}, {2, 0, 0}, {0, 0, 1}}}), 104);
  EXPECT_EQ(code({{{0, 0, 0}, {2, 0, 0}}}), 101);
  EXPECT_EQ(code({{{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {0, 0, 1}}}), 102);
  EXPECT_EQ(code({{{0, 0, 0}, {2, 0.1, 0}, {2, 0, 1}, {0, 0.1, 1}}}), 203);
}

TEST(CheckSolid, TellsWhatIsConcerned) {
  const auto of = [&](const std::string& name) {
    for (const auto& b : testing_shapes::broken_solids())
      if (b.name == name) return check(b.solid);
    ADD_FAILURE() << "no broken solid " << name;
    return SolidCheck{};
  };
  // The floor is face 0, holes follow the outer loop.
  EXPECT_EQ(of("a shaft in a shaft").text(), "207 inner rings nested at 0 and 2");
  EXPECT_EQ(of("two shafts that cross").text(), "201 rings intersect at 0 and 2");
  EXPECT_EQ(of("two boxes on one corner").defect, SolidDefect::non_manifold_vertex);
  EXPECT_EQ(of("two boxes on one edge").defect, SolidDefect::non_manifold_edge);
  EXPECT_NEAR(of("a roof with a fold of a centimetre").measure, 1.249, 1e-3);  // rad between two triangles
  EXPECT_NEAR(of("house with a corner 5 cm off its plane").measure, 0.0125, 1e-4);
}

TEST(CheckSolid, OnWallsThatStandAskew) {
  // The same classes on walls in no axis: the grid bends faces, which must not look like a defect of its own.
  for (const auto& b : testing_shapes::broken_solids()) {
    if (b.code < 104 || b.code > 208 || b.code == 203 || b.code == 204) continue;
    Solid s = b.solid;
    constexpr double c = 0.83867056794542402964, d = 0.54463903501502708222;
    for (auto& v : s.vertices) {
      const double x = v.x - 391000, y = v.y - 5819000, z = v.z - 34;
      v = model::snap(model::Point3{391000 + c * x - d * z, 5819000 + c * y + d * (d * x + c * z),
                                    40 + c * (d * x + c * z) - d * y});
    }
    const int code = check(s).code();
    // Rings that touch exactly before the turn touch, cross or miss each other by a grid step after it.
    const bool touch = b.name.find("touch") != std::string::npos || b.code == 205 || b.code == 202 ||
                       b.name.find("corners") != std::string::npos || b.name.find("common wall") != std::string::npos;
    if (touch)
      EXPECT_TRUE(code >= 104 && code <= 208) << b.name << ": " << check(s).text();
    else
      EXPECT_EQ(code, b.code) << b.name << ": " << check(s).text();
  }
}

TEST(RingDefects, InTheOrderOfTheirGravity) {
  const auto defect = [](std::vector<std::vector<Grid2>> rings) { return find_rings_defect(rings).defect; };
  const std::vector<Grid2> outer{{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  EXPECT_EQ(defect({outer}), SolidDefect::none);
  EXPECT_EQ(defect({outer, {{10, 10}, {10, 20}, {20, 20}, {20, 10}}}), SolidDefect::none);
  EXPECT_EQ(defect({outer, {{10, 10}, {20, 10}, {20, 20}, {10, 20}}}), SolidDefect::hole_turned);
  EXPECT_EQ(defect({{{0, 0}, {5, 5}}}), SolidDefect::too_few_points);
  EXPECT_EQ(defect({{{0, 0}, {5, 5}, {5, 5}, {0, 5}}}), SolidDefect::same_points);
  EXPECT_EQ(defect({{{0, 0}, {5, 5}, {10, 10}}}), SolidDefect::ring_crosses);
  EXPECT_EQ(defect({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}}), SolidDefect::ring_crosses);
  // A ring that touches itself with a corner on an edge.
  EXPECT_EQ(defect({{{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}}}), SolidDefect::ring_crosses);
  // Of two rings that touch and one beyond the outline, the one beyond is told.
  EXPECT_EQ(defect({outer, {{0, 50}, {10, 60}, {20, 50}, {10, 40}}, {{200, 10}, {200, 20}, {210, 20}, {210, 10}}}),
            SolidDefect::hole_outside);
  // Four holes that touch in a row hang together without enclosing anything; a fifth closes the ring.
  const std::vector<std::vector<Grid2>> row{outer,
                                            {{20, 20}, {20, 30}, {30, 30}, {30, 20}},
                                            {{30, 30}, {30, 40}, {40, 40}, {40, 30}},
                                            {{40, 30}, {50, 30}, {50, 20}, {40, 20}}};
  EXPECT_EQ(defect(row), SolidDefect::rings_meet);
  auto closed = row;
  closed.push_back({{30, 20}, {40, 20}, {35, 10}});
  EXPECT_EQ(defect(closed), SolidDefect::face_split);
}

TEST(CheckSolid, SelfIntersectionThatTopologyCannotSee) {
  // One vertex of a house pulled through the opposite wall: closed and oriented, but crossing itself.
  Solid house = testing_shapes::gabled_house({391000, 5819000, 34}, 12, 9, 5, 9);
  // Turn each face into triangles, so that planarity has no say.
  const auto triangles = triangulate(house);
  ASSERT_TRUE(triangles);
  std::vector<Grid3> grid;
  for (const auto& v : house.vertices) grid.push_back(to_grid(v) - to_grid(house.vertices[0]));
  EXPECT_EQ(check_mesh(grid, triangles->triangles).text(), "none");
  for (auto& g : grid)
    if (g.z > 8 * 1024) g.z -= 12 * 1024;  // the ridge goes below the ground
  EXPECT_EQ(check_mesh(grid, triangles->triangles).defect, SolidDefect::self_intersection);
}

TEST(Triangulate, ConcaveOutlineWithThreeHoles) {
  // docs/internal/seeds.md P2-06: the triangles' area is the outline's minus the holes'.
  std::vector<Grid2> points;
  std::vector<std::vector<std::uint32_t>> loops;
  const auto add = [&](std::initializer_list<Grid2> loop) {
    auto& l = loops.emplace_back();
    for (const Grid2 p : loop) {
      l.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(p);
    }
  };
  add({{0, 0}, {100, 0}, {100, 100}, {60, 100}, {60, 60}, {0, 60}});
  add({{10, 10}, {10, 20}, {20, 20}, {20, 10}});
  add({{30, 10}, {30, 40}, {40, 40}, {40, 10}});
  add({{70, 70}, {70, 90}, {90, 90}, {90, 70}});
  const auto triangles = triangulate(points, loops);
  ASSERT_TRUE(triangles);
  std::int64_t twice = 0;
  for (const auto& t : *triangles) {
    const Grid2 u = points[t[1]] - points[t[0]], v = points[t[2]] - points[t[0]];
    EXPECT_GT(u.x * v.y - u.y * v.x, 0);
    twice += u.x * v.y - u.y * v.x;
  }
  EXPECT_EQ(twice, 2 * (100 * 60 + 40 * 40 - 100 - 300 - 400));
}

TEST(Triangulate, RefusesCrossingAndTouchingLoops) {
  const std::vector<Grid2> points{{0, 0}, {10, 10}, {10, 0}, {0, 10}};
  EXPECT_FALSE(triangulate(points, std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 3}}));
  const std::vector<Grid2> touching{{0, 0}, {20, 0}, {20, 20}, {0, 20}, {0, 10}, {5, 12}, {5, 8}};
  EXPECT_FALSE(triangulate(touching, std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 3}, {4, 5, 6}}));
}

TEST(Grid, PlacesBeyondAllEarthLieAtItsEnd) {
  const auto end = static_cast<std::int64_t>(kFarthestStep);
  EXPECT_EQ(to_grid(1e300), end);
  EXPECT_EQ(to_grid(-1e300), -end);
  EXPECT_EQ(std::abs(to_grid(std::numeric_limits<double>::quiet_NaN())), end);
  EXPECT_EQ(to_grid(6'378'137.0), 6'378'137LL * 1024);
  // Differences of such places are exact.
  const Grid3 a = to_grid(model::Point3{1e300, -1e300, 1e300}), b = to_grid(model::Point3{-1e300, 1e300, -1e300});
  EXPECT_EQ((a - b).x, 2 * end);
  EXPECT_EQ(orientation(a, b, Grid3{end, end, -end}, Grid3{-end, -end, end}),
            -orientation(b, a, Grid3{end, end, -end}, Grid3{-end, -end, end}));
}

TEST(Grid, PolygonsBeyondAllEarthAreTriangulatedOrRefused) {
  const std::vector<Grid2> far{to_grid(model::Point2{0, 0}), to_grid(model::Point2{1e300, 0}),
                               to_grid(model::Point2{1e300, 1e300}), to_grid(model::Point2{0, 1e300})};
  const auto square = triangulate(far, std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 3}});
  ASSERT_TRUE(square);
  EXPECT_EQ(square->size(), 2u);
}

TEST(Orientation, ExactWhereDoublesAreNot) {
  // Four points whose determinant is 1 although its products exceed 2^60.
  const std::int64_t big = 1 << 30;
  EXPECT_EQ(orientation(Grid3{0, 0, 0}, Grid3{big, 0, 0}, Grid3{0, big, 0}, Grid3{big / 2, big / 2, 0}), 0);
  EXPECT_EQ(orientation(Grid3{0, 0, 0}, Grid3{big, 0, 0}, Grid3{0, big, 0}, Grid3{big / 2, big / 2, 1}), -1);
  EXPECT_EQ(orientation(Grid3{0, 0, 0}, Grid3{big, 0, 0}, Grid3{0, big, 0}, Grid3{big / 2, big / 2, -1}), 1);
}

}  // namespace
}  // namespace blockrand::geometry
