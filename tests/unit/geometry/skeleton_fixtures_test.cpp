// The seed's regression fixtures of the weighted skeleton: docs/sources.md, Gunia C4 to C11.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/weighted_skeleton.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Point2;
using model::Point3;
using model::Polygon;
using testing::ElementsAre;
using testing_shapes::polygon;
using testing_shapes::turned;

constexpr double kDegree = 3.14159265358979323846 / 180;

std::vector<EdgeProfile> all(const Polygon& plan, const EdgeProfile& profile) {
  return std::vector<EdgeProfile>(plan.outer.size(), profile);
}

/// Nodes above the eaves to the millimetre, lowest first.
std::vector<Point3> high_nodes(const WeightedSkeleton& s) {
  std::set<std::array<double, 3>> places;
  const auto round = [](double v) { return std::round(v * 1000) / 1000 + 0.0; };
  for (const auto& n : s.nodes)
    if (n.height > 1e-9) places.insert({round(n.height), round(n.point.x), round(n.point.y)});
  std::vector<Point3> out;
  for (const auto& p : places) out.push_back({p[1], p[2], p[0]});
  return out;
}

double area_seen_from_above(const WeightedSkeleton& s) {
  double sum = 0;
  for (const auto& face : s.faces)
    for (const auto& loop : face.loops) {
      std::vector<Point2> points;
      for (const auto n : loop) points.push_back(s.nodes[n].point);
      sum += signed_area(points);
    }
  return sum;
}

const Polygon kTenBySix = polygon({{0, 0}, {10, 0}, {10, 6}, {0, 6}});

TEST(SkeletonFixtures, C4HipOfATenBySixPlan) {
  const auto s = weighted_skeleton(kTenBySix, all(kTenBySix, {1, {}}));
  ASSERT_TRUE(s);
  EXPECT_THAT(high_nodes(*s), ElementsAre(Point3{3, 3, 3}, Point3{7, 3, 3}));
  EXPECT_EQ(s->faces.size(), 4u);
}

TEST(SkeletonFixtures, C5GableOfATenBySixPlan) {
  const EdgeProfile eaves{1, {}}, gable{kUpright, {}};
  const auto s = weighted_skeleton(kTenBySix, std::vector{eaves, gable, eaves, gable});
  ASSERT_TRUE(s);
  EXPECT_THAT(high_nodes(*s), ElementsAre(Point3{0, 3, 3}, Point3{10, 3, 3}));
  EXPECT_EQ(std::count_if(s->faces.begin(), s->faces.end(), [](const auto& f) { return f.upright; }), 2);
  EXPECT_NEAR(area_seen_from_above(*s), 60, 1e-9);
}

TEST(SkeletonFixtures, C6MansardOfATenBySixPlan) {
  const auto s = weighted_skeleton(kTenBySix, all(kTenBySix, {std::tan(70 * kDegree), {{2, std::tan(30 * kDegree)}}}));
  ASSERT_TRUE(s);
  const double inset = 0.728, rest = 3.312;
  EXPECT_NEAR(s->height(), rest, 5e-4);
  std::size_t breaks = 0;
  for (const Point3& p : high_nodes(*s)) {
    if (p.z > 2.5) continue;
    ++breaks;
    EXPECT_NEAR(p.z, 2, 1e-9);
    EXPECT_NEAR(std::min(p.x, 10 - p.x), inset, 5e-4);
    EXPECT_NEAR(std::min(p.y, 6 - p.y), inset, 5e-4);
  }
  EXPECT_EQ(breaks, 4u);
  EXPECT_EQ(s->faces.size(), 8u);
}

TEST(SkeletonFixtures, C7TwoSquaresFallApartInOnePoint) {
  // Both reflex corners reach (8, 8) at one time: two splits in one event, each square goes on to a pyramid of its own.
  const Polygon plan = polygon({{0, 0}, {10, 0}, {10, 6}, {16, 6}, {16, 16}, {6, 16}, {6, 10}, {0, 10}});
  const auto s = weighted_skeleton(plan, all(plan, {1, {}}));
  ASSERT_TRUE(s);
  EXPECT_THAT(high_nodes(*s), ElementsAre(Point3{8, 8, 2}, Point3{5, 5, 5}, Point3{11, 11, 5}));
  EXPECT_EQ(s->faces.size(), 8u);
  EXPECT_NEAR(area_seen_from_above(*s), area(plan), 1e-9);
}

TEST(SkeletonFixtures, C8MitreOfARightAngle) {
  // A profile of depth L: its mitre begins e = L from the corner along either edge and is L times the root of 2 long.
  constexpr double kDepth = 1.25;
  const Polygon plan = polygon({{0, 0}, {20, 0}, {20, 12}, {0, 12}});
  const auto s = weighted_skeleton(plan, all(plan, {1, {}}), kDepth);
  ASSERT_TRUE(s);
  const auto mitres = high_nodes(*s);
  ASSERT_EQ(mitres.size(), 4u);
  for (const Point3& p : mitres) {
    const double ex = std::min(p.x, 20 - p.x), ey = std::min(p.y, 12 - p.y);
    EXPECT_NEAR(ex, kDepth, 1e-9);
    EXPECT_NEAR(std::hypot(ex, ey), kDepth * std::sqrt(2.0), 1e-9);
  }
}

TEST(SkeletonFixtures, C9WallOffsetAtReflexCornersToo) {
  // All corners of walls w thick move by w times the root of 2, the reflex one of an L as well. The plane at height w *
  // slope is the offset, whatever the slope.
  constexpr double kWidth = 0.5, kSlope = 4;
  const Polygon plan = polygon({{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}});
  const auto s = weighted_skeleton(plan, all(plan, {kSlope, {}}), kWidth * kSlope);
  ASSERT_TRUE(s);
  const auto inner = high_nodes(*s);
  ASSERT_EQ(inner.size(), plan.outer.size());
  for (const Point2& corner : plan.outer.points) {
    double nearest = 1e9;
    for (const Point3& p : inner) nearest = std::min(nearest, std::hypot(p.x - corner.x, p.y - corner.y));
    EXPECT_NEAR(nearest, kWidth * std::sqrt(2.0), 1e-3);
  }
}

TEST(SkeletonFixtures, C10ScaledSlopesKeepThePlan) {
  const Polygon plan = polygon({{0, 0}, {24, 0}, {27, 10}, {15, 8}, {13, 16}, {-2, 11}});
  const double slopes[] = {0.5, 1, 0.75, 1.5, 1, 0.625};
  for (const double c : {0.5, 3.0}) {
    std::vector<EdgeProfile> plain, scaled;
    for (const double slope : slopes) {
      plain.push_back({slope, {{1, slope / 2}}});
      scaled.push_back({c * slope, {{c, c * slope / 2}}});
    }
    const auto a = weighted_skeleton(plan, plain), b = weighted_skeleton(plan, scaled);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->nodes.size(), b->nodes.size());
    ASSERT_EQ(a->faces.size(), b->faces.size());
    for (std::size_t i = 0; i < a->nodes.size(); ++i) {
      EXPECT_NEAR(a->nodes[i].point.x, b->nodes[i].point.x, 1e-4) << i;
      EXPECT_NEAR(a->nodes[i].point.y, b->nodes[i].point.y, 1e-4) << i;
      EXPECT_NEAR(a->nodes[i].height * c, b->nodes[i].height, 1e-4) << i;
    }
    for (std::size_t f = 0; f < a->faces.size(); ++f) EXPECT_EQ(a->faces[f].loops, b->faces[f].loops) << f;
  }
}

TEST(SkeletonFixtures, C11CombWithEqualTeeth) {
  std::vector<Point2> points{{0, 0}, {90, 0}};
  for (int tooth = 8; tooth >= 0; --tooth) {  // 9 teeth 4 m wide, 10 m apart, with a bar 6 m deep
    const double x = 10.0 * tooth + 3;
    points.insert(points.end(), {{x + 4, 6}, {x + 4, 15}, {x, 15}, {x, 6}});
    if (tooth == 8) points.insert(points.begin() + 2, Point2{90, 6});
  }
  points.push_back({0, 6});
  for (const Polygon& plan : {polygon(points), turned(polygon(points))}) {
    ASSERT_EQ(plan.outer.size(), 40u);
    const auto s = weighted_skeleton(plan, all(plan, {1, {}}));
    ASSERT_TRUE(s);
    // Faces of edges on one line are joined, so that not every edge has one of its own; but each bounds one.
    std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
    for (const auto& face : s->faces)
      for (const auto& loop : face.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) sides.insert({loop[i], loop[(i + 1) % loop.size()]});
    for (std::uint32_t edge = 0; edge < 40; ++edge)
      EXPECT_TRUE(sides.contains({edge, (edge + 1) % 40})) << "edge " << edge << " has no face";
    EXPECT_NEAR(area_seen_from_above(*s), area(plan), 1e-6);
    EXPECT_NEAR(s->height(), 3, 0.002);
  }
}

}  // namespace
}  // namespace blockrand::geometry
