#include "pipeline/footprints/repair/arcs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace blockrand::repair {
namespace {

using model::Point2;

constexpr double kPi = 3.14159265358979323846;

/// Points of a circle from one angle to another (degrees), both included.
std::vector<Point2> curve(Point2 centre, double radius, double from, double to, int edges) {
  std::vector<Point2> out;
  for (int i = 0; i <= edges; ++i) {
    const double a = (from + (to - from) * i / edges) * kPi / 180;
    out.push_back({centre.x + radius * std::cos(a), centre.y + radius * std::sin(a)});
  }
  return out;
}
std::vector<Point2> circle(Point2 centre, double radius, int edges) {
  auto out = curve(centre, radius, 0, 360, edges);
  out.pop_back();
  return out;
}
std::vector<Point2> operator+(std::vector<Point2> a, const std::vector<Point2>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
std::vector<Point2> started_at(std::vector<Point2> ring, std::size_t k) {
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(k), ring.end());
  return ring;
}

TEST(FindArcs, KeepsARoundedStreetCorner) {
  // A house of 20 x 15 m whose corner at (20, 0) is rounded with 4 m in six chords.
  const auto ring = std::vector<Point2>{{0, 0}} + curve({16, 4}, 4, -90, 0, 6) + std::vector<Point2>{{20, 15}, {0, 15}};
  const auto runs = find_arc_runs(ring);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].first, 1u);
  EXPECT_EQ(runs[0].count, 6u);
  EXPECT_NEAR(runs[0].radius, 4, 0.01);
  EXPECT_NEAR(runs[0].centre.x, 16, 0.01);
  EXPECT_NEAR(runs[0].centre.y, 4, 0.01);
  EXPECT_TRUE(runs[0].left);
}

TEST(FindArcs, KnowsARoundBayAndANiche) {
  const auto bay = std::vector<Point2>{{0, 0}, {6, 0}} + curve({8, 0}, 1.5, -180, 0, 8) +
                   std::vector<Point2>{{16, 0}, {16, 9}, {0, 9}};
  const auto runs = find_arc_runs(bay);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].first, 2u);
  EXPECT_EQ(runs[0].count, 8u);
  EXPECT_NEAR(runs[0].radius, 1.5, 0.01);
  EXPECT_TRUE(runs[0].left);

  const auto niche = std::vector<Point2>{{0, 0}, {6, 0}} + curve({8, 0}, 1.5, 180, 0, 8) +
                     std::vector<Point2>{{16, 0}, {16, 9}, {0, 9}};
  const auto inward = find_arc_runs(niche);
  ASSERT_EQ(inward.size(), 1u);
  EXPECT_EQ(inward[0].count, 8u);
  EXPECT_FALSE(inward[0].left);
}

TEST(FindArcs, KnowsARoundTowerAndARoundCourtyard) {
  const auto runs = find_arc_runs(circle({3, 4}, 5, 16));
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].first, 0u);
  EXPECT_EQ(runs[0].count, 16u);
  EXPECT_NEAR(runs[0].radius, 5, 0.001);

  model::Polygon block;
  block.outer.points = {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}};
  block.holes.emplace_back();
  block.holes[0].points = circle({0, 0}, 8, 20);
  std::reverse(block.holes[0].points.begin(), block.holes[0].points.end());
  const auto arcs = find_arcs({block});
  ASSERT_EQ(arcs.size(), 1u);
  EXPECT_EQ(arcs[0].polygon, 0u);
  EXPECT_EQ(arcs[0].ring, 1u);
  EXPECT_EQ(arcs[0].count, 20u);
  EXPECT_FALSE(arcs[0].convex);  // the building surrounds it
}

TEST(FindArcs, LeavesPolygonsWithFewCornersAlone) {
  for (const int corners : {3, 4, 5, 6, 8}) EXPECT_TRUE(find_arc_runs(circle({0, 0}, 6, corners)).empty()) << corners;
  EXPECT_EQ(find_arc_runs(circle({0, 0}, 6, 10)).size(), 1u);
  // A chamfer, a polygonal bay of 45 degrees, a bent facade of three walls.
  EXPECT_TRUE(find_arc_runs(std::vector<Point2>{{0, 0}, {17, 0}, {20, 3}, {20, 12}, {0, 12}}).empty());
  EXPECT_TRUE(
      find_arc_runs(std::vector<Point2>{{0, 0}, {6, 0}, {7, -1}, {9, -1}, {10, 0}, {16, 0}, {16, 9}, {0, 9}}).empty());
  EXPECT_TRUE(find_arc_runs(std::vector<Point2>{{0, 0}, {6, 0}, {12, 1}, {18, 3}, {16, 12}, {0, 12}}).empty());
}

TEST(FindArcs, AnEllipseOrAWallWithBendsIsNoCircle) {
  std::vector<Point2> ellipse = circle({0, 0}, 10, 24);
  for (Point2& p : ellipse) p.y *= 0.6;
  for (const ArcRun& run : find_arc_runs(ellipse)) EXPECT_LT(run.count, 14u);  // stretches of it are
  // Chords that are wildly different: bends of a long street front.
  EXPECT_TRUE(
      find_arc_runs(std::vector<Point2>{{0, 0}, {2, 0}, {22, 2}, {25, 2.8}, {55, 13}, {58, 14.5}, {50, 30}, {0, 30}})
          .empty());
}

TEST(FindArcs, BothCurvesOfAnSAreFound) {
  const auto ring = std::vector<Point2>{{-20, 0}} + curve({0, 10}, 10, -90, 0, 8) + curve({20, 10}, 10, 180, 90, 8) +
                    std::vector<Point2>{{40, 20}, {40, 60}, {-20, 60}};
  auto points = ring;
  points.erase(std::unique(points.begin(), points.end(),
                           [](Point2 a, Point2 b) { return std::hypot(a.x - b.x, a.y - b.y) < 1e-9; }),
               points.end());
  const auto runs = find_arc_runs(points);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_TRUE(runs[0].left);
  EXPECT_FALSE(runs[1].left);
  EXPECT_EQ(runs[0].count, 8u);
  EXPECT_EQ(runs[1].count, 8u);
}

TEST(FindArcs, DoesNotDependOnWhereTheRingStarts) {
  const auto ring = std::vector<Point2>{{0, 0}} + curve({16, 4}, 4, -90, 0, 6) + curve({13, 12}, 7, 20, 90, 9) +
                    std::vector<Point2>{{0, 19}};
  const auto first = find_arc_runs(ring);
  ASSERT_EQ(first.size(), 2u);
  for (std::size_t k = 1; k < ring.size(); ++k) {
    const auto runs = find_arc_runs(started_at(ring, k));
    ASSERT_EQ(runs.size(), 2u) << k;
    for (const ArcRun& run : runs) {
      const auto same = std::find_if(first.begin(), first.end(), [&](const ArcRun& f) {
        return f.first == (run.first + k) % ring.size() && f.count == run.count &&
               std::fabs(f.radius - run.radius) < 1e-9;
      });
      EXPECT_NE(same, first.end()) << k;
    }
  }
}

TEST(FindArcs, SurvivesTheGridAndSlightNoise) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.012, 0.012);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    auto ring = std::vector<Point2>{{0, 0}} + curve({16, 4}, 4, -90, 0, 6) + std::vector<Point2>{{20, 15}, {0, 15}};
    for (Point2& p : ring) p = model::snap(Point2{p.x + off(random), p.y + off(random)});
    const auto runs = find_arc_runs(ring);
    found += runs.size() == 1 && runs[0].first == 1 && runs[0].count == 6;
  }
  EXPECT_GE(found, 198);
}

}  // namespace
}  // namespace blockrand::repair
