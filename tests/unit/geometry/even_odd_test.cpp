// What rings enclose that cross themselves, once and very often.
#include "pipeline/geometry/even_odd.h"

#include <gtest/gtest.h>

#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Point2;
using testing_shapes::Random;
using testing_shapes::ring;

model::Ring scribble(std::size_t corners, std::uint64_t seed) {
  Random random(seed);
  std::vector<Point2> points;
  for (std::size_t i = 0; i < corners; ++i) {
    const double x = 100 * random.unit();
    points.push_back(model::snap(Point2{x, 100 * random.unit()}));
  }
  return ring(std::move(points));
}

TEST(ConvexHull, KeepsCornersAndTheirNodes) {
  model::Ring r = ring({{4, 4}, {0, 0}, {8, 0}, {4, 0}, {8, 8}, {4, 7}, {0, 8}, {0, 0}, {0, 3}});
  for (std::size_t i = 0; i < r.size(); ++i) r.nodes[i] = static_cast<std::int64_t>(10 + i);
  const model::Ring hull = convex_hull(r);
  EXPECT_EQ(hull.points, (std::vector<Point2>{{0, 0}, {8, 0}, {8, 8}, {0, 8}}));
  EXPECT_EQ(hull.nodes, (std::vector<std::int64_t>{11, 12, 14, 16}));
  EXPECT_EQ(convex_hull(ring({{0, 0}, {1, 1}, {2, 2}, {3, 3}})).size(), 0u) << "no area";
  EXPECT_EQ(convex_hull(ring({{0, 0}, {0, 0}})).size(), 0u);
}

TEST(EvenOdd, WalkingAlongTheRingMeasuresTheSame) {
  EXPECT_NEAR(tangled_area(ring({{0, 0}, {10, 8}, {10, 0}, {0, 8}})), 40, 1e-3) << "a figure eight";
  EXPECT_NEAR(tangled_area(ring({{0, 0}, {10, 0}, {10, 8}, {0, 8}})), 80, 1e-3) << "a house";
  EXPECT_NEAR(tangled_area(ring({{0, 0}, {12, 0}, {12, 10}, {2, 10}, {2, 2}, {10, 2}, {10, 12}, {0, 12}})),
              even_odd_area(ring({{0, 0}, {12, 0}, {12, 10}, {2, 10}, {2, 2}, {10, 2}, {10, 12}, {0, 12}})), 1e-2)
      << "twice around a court";
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const model::Ring r = scribble(8, seed);
    if (tangled(r)) continue;
    EXPECT_NEAR(tangled_area(r), even_odd_area(r), 0.02) << seed;
    ++compared;
  }
  EXPECT_GT(compared, 40);
}

TEST(EvenOdd, OnlyScribblesAreTangled) {
  EXPECT_FALSE(tangled(ring({{0, 0}, {10, 8}, {10, 0}, {0, 8}})));
  EXPECT_FALSE(tangled(scribble(8, 3)));
  EXPECT_TRUE(tangled(scribble(100, 4)));
}

}  // namespace
}  // namespace blockrand::geometry
