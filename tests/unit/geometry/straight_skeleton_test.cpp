#include "pipeline/geometry/straight_skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Point2;
using model::Polygon;
using testing_shapes::polygon;

/// Times and places of the inner nodes, sorted: the same for two skeletons that agree.
std::vector<SkeletonNode> inner_nodes(const StraightSkeleton& s) {
  std::vector<SkeletonNode> out;
  for (const auto& n : s.nodes) {
    if (n.contour) continue;
    const bool known = std::any_of(out.begin(), out.end(), [&](const auto& o) {
      return std::hypot(o.point.x - n.point.x, o.point.y - n.point.y) < 1e-6;
    });
    if (!known) out.push_back(n);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return out;
}

TEST(ClosedFormSkeleton, AgreesWithCgalOnConvexQuadrilaterals) {
  testing_shapes::Random random(5);
  int compared = 0;
  for (int round = 0; round < 3000; ++round) {
    const double w = 4 + 30 * random.unit(), d = 4 + 20 * random.unit();
    const auto jitter = [&] { return (random.unit() - 0.5) * (round % 2 ? 0.1 : 3.0); };
    const Polygon plan = testing_shapes::turned(
        polygon({{jitter(), jitter()}, {w + jitter(), jitter()}, {w + jitter(), d + jitter()}, {jitter(), d + jitter()}}));
    if (!strictly_simple(plan)) continue;
    const auto ours = straight_skeleton_closed_form(plan);
    if (!ours) continue;
    const auto theirs = straight_skeleton_by_cgal(plan);
    ASSERT_TRUE(theirs);
    const auto a = inner_nodes(*ours), b = inner_nodes(*theirs);
    ASSERT_EQ(a.size(), b.size()) << "round " << round;
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i].time, b[i].time, 1e-6) << "round " << round;
    ++compared;
  }
  EXPECT_GT(compared, 2500);
}

TEST(ClosedFormSkeleton, SquareAndTriangleEndInAPoint) {
  const auto square = straight_skeleton_closed_form(polygon({{0, 0}, {10, 0}, {10, 10}, {0, 10}}));
  ASSERT_TRUE(square);
  EXPECT_DOUBLE_EQ(square->height(), 5);
  EXPECT_EQ(inner_nodes(*square).size(), 1u);
  const auto triangle = straight_skeleton_closed_form(polygon({{0, 0}, {6, 0}, {0, 8}}));
  ASSERT_TRUE(triangle);
  EXPECT_DOUBLE_EQ(triangle->height(), 2);  // radius of the inscribed circle
}

TEST(ClosedFormSkeleton, LeavesConcaveAndLargePlansToCgal) {
  EXPECT_FALSE(straight_skeleton_closed_form(polygon({{0, 0}, {10, 0}, {2, 2}, {0, 10}})));
  EXPECT_FALSE(straight_skeleton_closed_form(polygon({{0, 0}, {10, 0}, {12, 5}, {10, 10}, {0, 10}})));
  EXPECT_TRUE(straight_skeleton(polygon({{0, 0}, {10, 0}, {2, 2}, {0, 10}})));
}

TEST(StraightSkeleton, AFaceForEveryEdgeInOrder) {
  Polygon plan = polygon({{0, 0}, {40, 0}, {40, 30}, {0, 30}});
  plan.holes.push_back(testing_shapes::ring({{11, 11}, {11, 19}, {29, 19}, {29, 11}}));
  const auto s = straight_skeleton(plan);
  ASSERT_TRUE(s);
  ASSERT_EQ(s->faces.size(), 8u);
  for (std::uint32_t e = 0; e < 8; ++e) {
    EXPECT_EQ(s->faces[e].edge, e);
    EXPECT_EQ(s->faces[e].nodes[0], e);
  }
  EXPECT_NEAR(s->height(), 5.5, 1e-9);
}

TEST(StraightSkeleton, RefusesPlansBeyondItsBudget) {
  std::vector<Point2> points;
  const int n = static_cast<int>(kMostSkeletonCorners) + 1;
  for (int i = 0; i < n; ++i) {
    const double radius = i % 2 ? 200 : 190;
    points.push_back(model::snap(Point2{radius * std::cos(2 * M_PI * i / n), radius * std::sin(2 * M_PI * i / n)}));
  }
  EXPECT_FALSE(straight_skeleton(polygon(points)));
}

}  // namespace
}  // namespace blockrand::geometry
