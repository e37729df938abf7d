#include "pipeline/geometry/weighted_skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/straight_skeleton.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/geometry/random_plans.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::geometry {
namespace {

using model::Point2;
using model::Polygon;
using testing_shapes::polygon;
using testing_shapes::random_plan;
using testing_shapes::ring;

std::size_t edges_of(const Polygon& p) {
  std::size_t n = p.outer.size();
  for (const auto& h : p.holes) n += h.size();
  return n;
}

std::vector<EdgeProfile> equal(const Polygon& p, double slope = 1) {
  return std::vector<EdgeProfile>(edges_of(p), {slope, {}});
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

/// Faces whose outer loop runs clockwise. (That areas add up says little: every arc is there both ways.)
std::size_t faces_that_look_down(const WeightedSkeleton& s) {
  std::size_t count = 0;
  for (const auto& face : s.faces) {
    std::vector<Point2> points;
    for (const auto n : face.loops[0]) points.push_back(s.nodes[n].point);
    count += !face.upright && signed_area(points) < -1e-6;
  }
  return count;
}

/// How far a point at a height is from the roof, if it lies in a face of an edge that is as far away as the point is
/// high.
double distance_to_roof(const Polygon& plan, const WeightedSkeleton& s, Point2 p, double height) {
  std::vector<std::pair<Point2, Point2>> edges;
  const auto add = [&](const model::Ring& r) {
    for (std::size_t i = 0; i < r.size(); ++i) edges.push_back({r.points[i], r.points[(i + 1) % r.size()]});
  };
  add(plan.outer);
  for (const auto& h : plan.holes) add(h);
  double best = 1e9;
  for (const auto& face : s.faces) {
    const auto& loop = face.loops[0];
    bool inside = false;
    double border = 1e9;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point2 a = s.nodes[loop[i]].point, b = s.nodes[loop[(i + 1) % loop.size()]].point;
      if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
      border = std::min(border, distance_to_segment(p, a, b));
    }
    const auto [a, b] = edges[face.edge];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double away = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / length;
    best = std::min(best, std::max(inside ? 0 : border, std::fabs(away - height)));
  }
  return best;
}

TEST(WeightedSkeleton, HipOfATenBySixPlan) {
  const Polygon plan = polygon({{0, 0}, {10, 0}, {10, 6}, {0, 6}});
  const auto s = weighted_skeleton(plan, equal(plan));
  ASSERT_TRUE(s) << name(s.error());
  ASSERT_EQ(s->nodes.size(), 6u);
  ASSERT_EQ(s->faces.size(), 4u);
  EXPECT_DOUBLE_EQ(s->height(), 3);
  EXPECT_EQ(s->faces[0].loops[0].size(), 4u);
  EXPECT_EQ(s->faces[1].loops[0].size(), 3u);
  EXPECT_NEAR(area_seen_from_above(*s), 60, 1e-9);
}

TEST(WeightedSkeleton, EdgesOnOneLineTakeTheGentlerSlope) {
  // From the beginning: two halves of one wall.
  Polygon plan = polygon({{0, 0}, {5, 0}, {10, 0}, {10, 6}, {0, 6}});
  std::vector<EdgeProfile> profiles = equal(plan);
  profiles[1].slope = kUpright;
  auto s = weighted_skeleton(plan, profiles);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->faces.size(), 4u);
  EXPECT_EQ(s->merged, (std::vector<std::uint32_t>{0, 0, 2, 3, 4}));
  // Later: eaves at y = 0 meet the line of a gable at y = 1 when they are 1 m high; from there on it is a roof as well.
  plan = polygon({{0, 1}, {4, 1}, {4, 0}, {10, 0}, {10, 7}, {0, 7}});
  profiles = equal(plan);
  profiles[0].slope = kUpright;
  s = weighted_skeleton(plan, profiles);
  ASSERT_TRUE(s) << name(s.error());
  EXPECT_NEAR(area_seen_from_above(*s), area(plan), 1e-9);
  for (const auto& face : s->faces) {
    if (!face.upright) continue;
    for (const auto n : face.loops[0]) EXPECT_LE(s->nodes[n].height, 1 + 1e-9);
  }
  EXPECT_NEAR(s->height(), 3.5, 1e-9);
}

TEST(WeightedSkeleton, EavesWithoutLengthFillACorner) {
  // Upright walls in the north and west, slopes from the south and east, and from the corner between the former: the roof
  // of an L whose inner corner has been filled.
  for (const bool is_turned : {false, true}) {
    const Polygon square = polygon({{0, 0}, {12, 0}, {12, 12}, {0, 12}});
    const Polygon plan = is_turned ? testing_shapes::turned(square) : square;
    std::vector<EdgeProfile> profiles = equal(plan);
    profiles[2].slope = profiles[3].slope = kUpright;
    const std::vector<CornerEaves> corner{{3, {}}};
    const auto s = weighted_skeleton(plan, profiles, {}, corner);
    ASSERT_TRUE(s) << name(s.error());
    EXPECT_NEAR(s->height(), 6, is_turned ? 0.002 : 1e-9);
    EXPECT_NEAR(area_seen_from_above(*s), area(plan), 1e-6);
    EXPECT_EQ(std::count_if(s->faces.begin(), s->faces.end(),
                            [](const auto& f) { return f.edge == WeightedSkeletonFace::kCorner; }),
              2);
    EXPECT_EQ(std::count_if(s->faces.begin(), s->faces.end(), [](const auto& f) { return !f.upright; }), 4);
    // With a change of pitch the corner's slopes change as well.
    for (EdgeProfile& p : profiles)
      if (p.slope != kUpright) p = {2, {{3, 0.5}}};
    const auto broken = weighted_skeleton(plan, profiles, {}, std::vector<CornerEaves>{{3, {2, {{3, 0.5}}}}});
    ASSERT_TRUE(broken) << name(broken.error());
    EXPECT_NEAR(broken->height(), 3 + 4.5 * 0.5, is_turned ? 0.002 : 1e-9);
    EXPECT_NEAR(area_seen_from_above(*broken), area(plan), 1e-6);
    // Only between two upright edges, in a convex corner.
    EXPECT_EQ(weighted_skeleton(plan, profiles, {}, std::vector<CornerEaves>{{0, {}}}).error(),
              SkeletonFailure::bad_slope);
    EXPECT_EQ(weighted_skeleton(plan, profiles, {}, std::vector<CornerEaves>{{9, {}}}).error(),
              SkeletonFailure::bad_slope);
  }
  const Polygon ell = polygon({{0, 0}, {20, 0}, {20, 20}, {10, 20}, {10, 10}, {0, 10}});
  std::vector<EdgeProfile> profiles = equal(ell);
  profiles[3].slope = profiles[4].slope = kUpright;
  EXPECT_EQ(weighted_skeleton(ell, profiles, {}, std::vector<CornerEaves>{{4, {}}}).error(),
            SkeletonFailure::bad_slope);
}

TEST(WeightedSkeleton, SaysWhyItGivesUp) {
  const Polygon plan = polygon({{0, 0}, {10, 0}, {10, 6}, {0, 6}});
  EXPECT_EQ(weighted_skeleton(plan, equal(plan, kUpright)).error(), SkeletonFailure::unbounded);
  EXPECT_EQ(weighted_skeleton(plan, equal(plan, 0)).error(), SkeletonFailure::bad_slope);
  EXPECT_EQ(weighted_skeleton(polygon({{0, 0}, {9000, 0}, {9000, 6}, {0, 6}}), equal(plan)).error(),
            SkeletonFailure::too_large);
  EXPECT_EQ(weighted_skeleton(polygon({{0, 0}, {10, 0}}), std::vector<EdgeProfile>(2)).error(),
            SkeletonFailure::too_large);
  std::vector<EdgeProfile> falling = equal(plan);
  falling[0].changes = {{2, 1}, {1, 2}};
  EXPECT_EQ(weighted_skeleton(plan, falling).error(), SkeletonFailure::bad_slope);
  falling[0].changes = {{2, 2}, {2.0004, 0.3}};  // one height on the grid
  EXPECT_EQ(weighted_skeleton(plan, falling).error(), SkeletonFailure::bad_slope);
  EXPECT_EQ(weighted_skeleton(plan, equal(plan, 1e6)).error(), SkeletonFailure::bad_slope);
  for (const double deck : {-1.0, 0.0, 0.0001, 1e16, std::nan("")})
    EXPECT_EQ(weighted_skeleton(plan, equal(plan), deck).error(), SkeletonFailure::bad_slope) << deck;
}

TEST(WeightedSkeleton, AgreesWithCgalWhereSlopesAreEqual) {
  const char* more = std::getenv("BLOCKRAND_MANY");
  const std::uint64_t rounds = more ? 10000 : 1500;
  std::uint64_t compared = 0, failed = 0;
  double worst = 0;
  for (std::uint64_t i = 0; i < rounds; ++i) {
    const Polygon plan = random_plan(7, i);
    const auto ours = weighted_skeleton(plan, equal(plan));
    ASSERT_TRUE(ours) << i << " " << name(ours.error());
    EXPECT_NEAR(area_seen_from_above(*ours), area(plan), 1e-6 * area(plan)) << i;
    const auto theirs = straight_skeleton(plan);
    if (!theirs) {
      ++failed;
      continue;
    }
    ++compared;
    // Every node of theirs lies on our roof: in the face of an edge that it is as far from as it is high. (Where two
    // edges on one line meet, CGAL has nodes within what is one plane.) And every node of ours on theirs.
    double off = 0;
    for (const auto& n : theirs->nodes)
      if (!n.contour) off = std::max(off, distance_to_roof(plan, *ours, n.point, n.time));
    for (const auto& n : ours->nodes) {
      double nearest = 1e9;
      for (const auto& m : theirs->nodes)
        nearest = std::min(
            nearest, std::max(std::hypot(m.point.x - n.point.x, m.point.y - n.point.y), std::fabs(m.time - n.height)));
      off = std::max(off, nearest);
    }
    worst = std::max(worst, off);
    EXPECT_LT(off, 1e-6) << "polygon " << i << " of " << edges_of(plan) << " corners";
  }
  std::printf("%lu polygons compared with CGAL, which gave up on %lu; largest distance of a node %.2g m\n", compared,
              failed, worst);
  EXPECT_GT(compared, rounds * 9 / 10);
}

TEST(WeightedSkeleton, RandomSlopesCoverThePlan) {
  const char* more = std::getenv("BLOCKRAND_MANY");
  const std::uint64_t rounds = more ? 100000 : 3000;
  std::uint64_t failures = 0, unbounded = 0;
  for (std::uint64_t i = 0; i < rounds; ++i) {
    const Polygon plan = random_plan(11, i);
    testing_shapes::Random random(i);
    std::vector<EdgeProfile> profiles = equal(plan);
    for (EdgeProfile& p : profiles) {
      const auto kind = random.next(6);
      p.slope = kind == 0 ? kUpright : kind == 1 ? 1 : 0.2 + 3 * random.unit();
      if (kind == 2) p.changes = {{1, 0.5}, {2, i % 2 ? kUpright : 0.3}};
      if (kind == 3) p.changes = {{1, 0.5}};
      if (p.slope == kUpright && i % 3 == 0) p.changes = {{0.7, 0.9}};
    }
    const auto s = weighted_skeleton(plan, profiles, random.next(4) == 0 ? std::optional<double>(1.5) : std::nullopt);
    if (!s) {
      if (s.error() == SkeletonFailure::unbounded)
        ++unbounded;
      else
        ++failures;
      EXPECT_EQ(s.error(), SkeletonFailure::unbounded) << i;
      continue;
    }
    EXPECT_NEAR(area_seen_from_above(*s), area(plan), 1e-6 * area(plan)) << i;
    EXPECT_EQ(faces_that_look_down(*s), 0u) << i;
  }
  std::printf("%lu polygons with random slopes: %lu failed, %lu closed by no slope\n", rounds, failures, unbounded);
  EXPECT_EQ(failures, 0u);
  EXPECT_LT(unbounded, rounds / 50);
}

}  // namespace
}  // namespace blockrand::geometry
