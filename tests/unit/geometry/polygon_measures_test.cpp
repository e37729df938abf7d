#include "pipeline/geometry/polygon_measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/geometry/find_slivers.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Point2;
using model::Polygon;
using testing_shapes::polygon;
using testing_shapes::ring;

TEST(PolygonMeasures, AreaAndCentroidOfAnL) {
  const Polygon l = polygon({{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}});
  EXPECT_DOUBLE_EQ(area(l), 64);
  const Point2 c = centroid(l.outer.points);
  // Two rectangles: 10x4 at (5,2) and 4x6 at (2,7).
  EXPECT_NEAR(c.x, (40 * 5 + 24 * 2) / 64.0, 1e-12);
  EXPECT_NEAR(c.y, (40 * 2 + 24 * 7) / 64.0, 1e-12);
}

TEST(PolygonMeasures, HolesCountAgainstTheArea) {
  Polygon p = polygon({{0, 0}, {10, 0}, {10, 10}, {0, 10}});
  p.holes.push_back(ring({{2, 2}, {2, 4}, {4, 4}, {4, 2}}));
  EXPECT_DOUBLE_EQ(area(p), 96);
}

TEST(PolygonMeasures, EquivalentWidthOfWings) {
  EXPECT_NEAR(equivalent_width(polygon({{0, 0}, {40, 0}, {40, 10}, {0, 10}})), 10, 1e-9);
  // A ring of 12 m wings around a courtyard measures about as one long wing.
  Polygon block = polygon({{0, 0}, {60, 0}, {60, 60}, {0, 60}});
  block.holes.push_back(ring({{12, 12}, {12, 48}, {48, 48}, {48, 12}}));
  EXPECT_NEAR(equivalent_width(block), 12, 1.0);
}

TEST(Slivers, OnlyWhatTurnsBackOverItselfIsOne) {
  constexpr double kWidth = 0.02;
  const auto slivers = [&](std::vector<Point2> points) { return find_slivers(ring(std::move(points)), kWidth); };
  EXPECT_TRUE(slivers({{0, 0}, {10, 0}, {10, 8}, {0, 8}}).empty());
  EXPECT_TRUE(slivers({{0, 0}, {10, 0}, {10, 1}}).empty()) << "a sharp house";
  EXPECT_TRUE(slivers({{0, 0}, {10, 0}, {10, 0.015625}, {10.015625, 0.015625}, {10.015625, 8}, {0, 8}}).empty())
      << "a step as wide as long";
  const auto pointed = slivers({{0, 0}, {14, 0}, {10, 0.0078125}, {10, 8}, {0, 8}});
  ASSERT_EQ(pointed.size(), 1u);
  EXPECT_TRUE(pointed[0].outward);
  EXPECT_NEAR(pointed[0].length, 4, 1e-3);
  const auto blunt = slivers({{0, 0}, {14, 0}, {14, 0.0078125}, {10, 0.0078125}, {10, 8}, {0, 8}});
  ASSERT_EQ(blunt.size(), 1u);
  EXPECT_NE(blunt[0].first, blunt[0].last);
  const auto crack = slivers({{0, 0}, {10, 0}, {10, 4}, {3, 4}, {10, 4.0078125}, {10, 8}, {0, 8}});
  ASSERT_EQ(crack.size(), 1u);
  EXPECT_FALSE(crack[0].outward);
}

TEST(Slivers, AreCutWhereTheyStart) {
  // 8 mm wide: cut straight across, so that the longer leg stays on its line.
  Polygon p = polygon({{0, 0}, {14, 0}, {10, 0.0078125}, {10, 8}, {0, 8}});
  EXPECT_EQ(cut_slivers(p, 0.02), 1);
  EXPECT_EQ(p.outer.points, (std::vector<Point2>{{0, 0}, {10, 0}, {10, 0.0078125}, {10, 8}, {0, 8}}));
  EXPECT_EQ(p.outer.points.size(), p.outer.nodes.size());
  // A grid step wide: its start is on the wall.
  p = polygon({{0, 0}, {14, 0}, {10, 0.0009765625}, {10, 8}, {0, 8}});
  EXPECT_EQ(cut_slivers(p, 0.02), 1);
  EXPECT_EQ(p.outer.points, (std::vector<Point2>{{0, 0}, {10, 0.0009765625}, {10, 8}, {0, 8}}));
  // With corners of neighbours on it.
  p = polygon({{0, 0}, {12, 0}, {14, 0}, {13, 0.0009765625}, {10, 0.001953125}, {10, 8}, {0, 8}});
  EXPECT_GT(cut_slivers(p, 0.02), 0);
  EXPECT_NEAR(area(p), 80, 0.02);
  EXPECT_TRUE(strictly_simple(p));
  for (const Point2 q : p.outer.points) EXPECT_LE(q.x, 12);
}

TEST(Slivers, OfCourtsPointIntoTheHouse) {
  Polygon p = polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}});
  p.holes.push_back(ring({{5, 5}, {5, 10}, {10, 10}, {10, 7}, {15, 6.9921875}, {10, 6.9921875}, {10, 5}}));
  Polygon crack = p;
  EXPECT_EQ(cut_slivers(crack, 0.02), 0) << "filling cracks could take ground from others";
  p.holes = {ring({{5, 5}, {5, 10}, {10, 10}, {10, 8.015625}, {6, 8.0078125}, {10, 8}, {10, 5}})};
  orient(p.holes[0], false);
  EXPECT_EQ(cut_slivers(p, 0.02), 1);
  EXPECT_TRUE(find_slivers(p.holes[0], 0.02).empty());
}

TEST(PolygonContains, BoundaryIsInside) {
  const auto square = ring({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  EXPECT_TRUE(contains(std::span<const Point2>(square.points), {0, 2}));
  EXPECT_TRUE(contains(std::span<const Point2>(square.points), {4, 4}));
  EXPECT_TRUE(contains(std::span<const Point2>(square.points), {2, 2}));
  EXPECT_FALSE(contains(std::span<const Point2>(square.points), {4.001, 2}));
}

TEST(RemoveCollinear, DropsFlatPointsAndKeepsCorners) {
  auto r = ring({{0, 0}, {5, 0.004}, {10, 0}, {10, 10}, {0, 10}});
  remove_collinear(r, 0.01);
  EXPECT_EQ(r.size(), 4u);
}

TEST(RemoveCollinear, DoesNotEatARoundedWallStepByStep) {
  // 360 points on a circle of 10 m: each lies 1.5 mm from its neighbours' line, together they are round.
  std::vector<Point2> points;
  for (int i = 0; i < 360; ++i)
    points.push_back(model::snap(Point2{10 * std::cos(i * M_PI / 180), 10 * std::sin(i * M_PI / 180)}));
  auto r = ring(points);
  remove_collinear(r, 0.01);
  EXPECT_GT(r.size(), 40u);
  EXPECT_NEAR(signed_area(r.points), M_PI * 100, 0.8);
}

TEST(RemoveCollinear, DoesNotDependOnTheStart) {
  std::vector<Point2> points{{0, 0}, {5, 0.004}, {10, 0}, {10, 5}, {10.003, 7}, {10, 10}, {4, 9.995}, {0, 10}};
  auto first = ring(points);
  remove_collinear(first, 0.01);
  std::vector<Point2> expected = first.points;
  std::sort(expected.begin(), expected.end());
  for (std::size_t shift = 1; shift < points.size(); ++shift) {
    std::rotate(points.begin(), points.begin() + 1, points.end());
    auto again = ring(points);
    remove_collinear(again, 0.01);
    std::sort(again.points.begin(), again.points.end());
    EXPECT_EQ(again.points, expected);
  }
}

TEST(StrictlySimple, NamesTheDegenerateCases) {
  EXPECT_TRUE(strictly_simple(polygon({{0, 0}, {4, 0}, {4, 4}, {0, 4}})));
  EXPECT_FALSE(strictly_simple(polygon({{0, 0}, {4, 4}, {4, 0}, {0, 4}}))) << "bow-tie";
  EXPECT_FALSE(strictly_simple(polygon({{0, 0}, {4, 0}, {4, 0}, {4, 4}}))) << "repeated point";
  EXPECT_FALSE(strictly_simple(polygon({{0, 0}, {8, 0}, {4, 0}, {4, 4}}))) << "spike on the line";
  EXPECT_FALSE(strictly_simple(polygon({{0, 0}, {8, 0}, {8, 4}, {4, 0}, {0, 4}}))) << "touches its own edge";
  EXPECT_FALSE(strictly_simple(polygon({{0, 0}, {4, 0}, {8, 0}}))) << "no area";
  Polygon holed = polygon({{0, 0}, {10, 0}, {10, 10}, {0, 10}});
  holed.holes.push_back(ring({{0, 5}, {2, 6}, {2, 4}}));
  EXPECT_FALSE(strictly_simple(holed)) << "hole touches the outer ring";
  holed.holes[0] = ring({{11, 5}, {12, 6}, {12, 4}});
  EXPECT_FALSE(strictly_simple(holed)) << "hole outside";
  holed.holes[0] = ring({{1, 1}, {1, 9}, {9, 9}, {9, 1}});
  EXPECT_TRUE(strictly_simple(holed));
  holed.holes.push_back(ring({{2, 2}, {2, 3}, {3, 3}}));
  EXPECT_FALSE(strictly_simple(holed)) << "hole in a hole";
}

std::vector<Polygon> valid(std::vector<model::Ring> rings, std::vector<bool> inner) {
  auto result = make_valid(rings, inner, 0.05, 0.03);
  for (const Polygon& p : result.polygons) EXPECT_TRUE(strictly_simple(p));
  return result.polygons;
}

double total_area(const std::vector<Polygon>& polygons) {
  double sum = 0;
  for (const Polygon& p : polygons) sum += area(p);
  return sum;
}

TEST(MakeValid, BowTieBecomesTwoTriangles) {
  const auto p = valid({ring({{0, 0}, {4, 4}, {4, 0}, {0, 4}})}, {false});
  EXPECT_EQ(p.size(), 2u);
  EXPECT_NEAR(total_area(p), 8, 0.05);
}

TEST(MakeValid, OverlapStaysInside) {
  // A ring that runs twice over one corner: even-odd filling would cut a hole.
  const auto p =
      valid({ring({{0, 0}, {10, 0}, {10, 10}, {4, 10}, {4, 4}, {6, 4}, {6, 6}, {2, 6}, {2, 10}, {0, 10}})}, {false});
  EXPECT_GT(total_area(p), 80);
}

TEST(MakeValid, HoleTouchingTheOuterRingGetsAWall) {
  const auto p = valid({ring({{0, 0}, {10, 0}, {10, 10}, {0, 10}}), ring({{0, 5}, {2, 6}, {2, 4}})}, {false, true});
  ASSERT_EQ(p.size(), 1u);
  EXPECT_EQ(p[0].holes.size(), 1u);
  EXPECT_NEAR(area(p[0]), 98, 0.01);
}

TEST(MakeValid, TwoHolesTouchingInAPoint) {
  const auto p = valid({ring({{0, 0}, {10, 0}, {10, 10}, {0, 10}}), ring({{2, 2}, {2, 5}, {5, 5}, {5, 2}}),
                        ring({{5, 5}, {5, 8}, {8, 8}, {8, 5}})},
                       {false, true, true});
  ASSERT_EQ(p.size(), 1u);
  EXPECT_EQ(p[0].holes.size(), 2u);
  EXPECT_NEAR(area(p[0]), 82, 0.02);
}

TEST(MakeValid, KeepsNodesOfPointsThatSurvive) {
  auto bow_tie = ring({{0, 0}, {4, 4}, {4, 0}, {0, 4}});
  bow_tie.nodes = {11, 12, 13, 14};
  const auto p = valid({bow_tie}, {false});
  int known = 0;
  for (const Polygon& q : p)
    for (const auto n : q.outer.nodes) known += n >= 11 && n <= 14;
  EXPECT_EQ(known, 4);
}

TEST(MakeValid, ACourtThatAlmostTouchesTheWallStandsApart) {
  // In floats, 100 m from the origin, a corner a millimetre from a slanted wall may lie beyond it.
  const double step = 1 / model::kGridStepsPerMetre;
  for (const Point2 corner : {Point2{5, 1 + step}, Point2{5, 1 + 2 * step}, Point2{5, 1.5}}) {
    const auto result =
        make_valid(std::vector{ring({{0, 0}, {10, 2}, {10, 10}, {0, 10}}), ring({corner, {6, 5}, {4, 5}})},
                   {false, true}, 0.05, 0.03);
    ASSERT_EQ(result.polygons.size(), 1u);
    ASSERT_EQ(result.polygons[0].holes.size(), 1u);
    const bool near = corner.y < 1 + 1.6 * step;
    EXPECT_EQ(result.separated, near);
    double least = 1e9;
    for (const Point2 p : result.polygons[0].holes[0].points)
      least = std::min(least, distance_to_segment(p, {0, 0}, {10, 2}));
    EXPECT_GT(least, near ? 0.015 : 0.0015);
  }
}

TEST(MakeValid, ZeroAreaVanishes) { EXPECT_TRUE(valid({ring({{0, 0}, {4, 0}, {8, 0}})}, {false}).empty()); }

TEST(MakeValid, RandomRingsAlwaysEndSimple) {
  testing_shapes::Random random(7);
  for (int round = 0; round < 400; ++round) {
    std::vector<Point2> points;
    const int n = 3 + static_cast<int>(random.next(12));
    // A coarse grid makes touching, overlapping and repeated points the normal case.
    for (int i = 0; i < n; ++i)
      points.push_back({static_cast<double>(random.next(8)), static_cast<double>(random.next(8))});
    const auto result = make_valid(std::vector{ring(points)}, {false}, 0.05, 0.03);
    for (const Polygon& p : result.polygons) ASSERT_TRUE(strictly_simple(p)) << "round " << round;
  }
}

TEST(Difference, OutlineMinusItsParts) {
  const std::vector<Polygon> outline{polygon({{0, 0}, {20, 0}, {20, 10}, {0, 10}})};
  const std::vector<Polygon> parts{polygon({{0, 0}, {5, 0}, {5, 10}, {0, 10}}),
                                   polygon({{5, 0}, {12, 0}, {12, 10}, {5, 10}})};
  const auto rest = difference(outline, parts, 0.05, 0.03);
  ASSERT_EQ(rest.polygons.size(), 1u);
  EXPECT_NEAR(area(rest.polygons[0]), 80, 1e-6);
  EXPECT_NEAR(common_area(outline, parts), 120, 1e-6);
}

}  // namespace
}  // namespace blockrand::geometry
