#include "pipeline/geometry/straight_skeleton.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Point2;
using model::Polygon;
using testing_shapes::polygon;

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
