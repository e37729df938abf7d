#include "pipeline/observation/wall_shifts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::observation {
namespace {

using model::Point2;

const std::vector<Point2> kBox = {{0, 0}, {12, 0}, {12, 8}, {0, 8}};

/// The group of the wall that looks to (x, y).
std::uint32_t facing(const Walls& walls, double x, double y) {
  for (const Wall& wall : walls.walls)
    if (wall.normal().x * x + wall.normal().y * y > 0.99) return wall.group;
  ADD_FAILURE() << "no wall looks to " << x << ", " << y;
  return 0;
}

Rings shifted(const Rings& rings, double x, double y, double by, double farthest = 1.5) {
  const Walls walls = find_walls(rings, {});
  std::vector<double> shifts(walls.movable.size(), 0.0);
  shifts[facing(walls, x, y)] = by;
  return shifted_outline(rings, walls, shifts, farthest);
}

TEST(WallShifts, AWallOfABoxMovesAndTheOthersStayOnTheirLines) {
  const Rings after = shifted({kBox}, 1, 0, 0.8);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(after[0], (std::vector<Point2>{{0, 0}, {12.8, 0}, {12.8, 8}, {0, 8}}));
}

TEST(WallShifts, NothingShiftedIsNothingChanged) {
  const Rings rings{{{0.1234567, 0}, {12, 0}, {12, 8}, {0, 8}}};
  const Walls walls = find_walls(rings, {});
  EXPECT_EQ(shifted_outline(rings, walls, std::vector<double>(walls.movable.size(), 0.0), 1.5), rings);
}

TEST(WallShifts, ACollinearRunIsOneWall) {
  const Rings rings{{{0, 0}, {3, 0}, {5, 0.02}, {5.1, 0.02}, {12, 0}, {12, 8}, {0, 8}}};
  const Walls walls = find_walls(rings, {});
  ASSERT_EQ(walls.walls.size(), 4u);
  const Rings after = shifted(rings, 0, -1, 0.5);
  ASSERT_EQ(after.size(), 1u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(after[0][i].y, rings[0][i].y - 0.5, 0.002) << i;
}

TEST(WallShifts, WallsOnOneLineMoveTogether) {
  // A recess between two parts of one front.
  const Rings rings{{{0, 0}, {5, 0}, {5, 2}, {8, 2}, {8, 0.05}, {13, 0.05}, {13, 9}, {0, 9}}};
  const Rings after = shifted(rings, 0, -1, 0.6);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_NEAR(after[0][0].y, -0.6, 1e-9);
  EXPECT_NEAR(after[0][5].y, -0.55, 1e-9);
  EXPECT_EQ(after[0][2], rings[0][2]);
}

TEST(WallShifts, ShortEdgesGoWithTheWallsBesideThem) {
  // A chamfered corner keeps its chamfer.
  const Rings rings{{{0, 0}, {11.8, 0}, {12, 0.2}, {12, 8}, {0, 8}}};
  ASSERT_EQ(find_walls(rings, {}).walls.size(), 4u);
  const Rings after = shifted(rings, 1, 0, -0.9);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_NEAR(after[0][1].x, 10.9, 1e-9);
  EXPECT_NEAR(after[0][2].x, 11.1, 1e-9);
  EXPECT_NEAR(after[0][2].y, 0.2, 1e-9);
}

TEST(WallShifts, NearParallelNeighboursMoveTogether) {
  // A front with a kink of 10 degrees: where its two lines meet says nothing.
  const Rings rings{{{0, 0}, {6, 0}, {12, 1.05}, {12, 8}, {0, 8}}};
  const Walls walls = find_walls(rings, {});
  EXPECT_EQ(walls.walls.size(), 5u);
  EXPECT_EQ(walls.movable.size(), 4u);
  const Rings after = shifted(rings, 0, -1, 0.5);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_LT(std::hypot(after[0][1].x - 6, after[0][1].y + 0.5), 0.06);
}

TEST(WallShifts, ACurveIsNotShifted) {
  std::vector<Point2> circle;
  for (int i = 0; i < 600; ++i) {
    const base::SinCos a = base::sin_cos(2 * base::kPi * i / 600);
    circle.push_back({100 * a.cos, 100 * a.sin});
  }
  const Walls walls = find_walls({circle}, {});
  for (const char movable : walls.movable) EXPECT_FALSE(movable);
}

TEST(WallShifts, ASpikeDoesNotGrow) {
  // At its tip two walls meet at 5 degrees: shifting one of them would move the tip by ten metres.
  const Rings rings{{{0, 0}, {12, 0}, {30, 3.2}, {12, 1.6}, {12, 8}, {0, 8}}};
  const Walls walls = find_walls(rings, {});
  for (std::uint32_t g = 0; g < walls.movable.size(); ++g)
    for (const double by : {-0.8, 0.8}) {
      std::vector<double> shifts(walls.movable.size(), 0.0);
      shifts[g] = by;
      const Rings after = shifted_outline(rings, walls, shifts, 1.5);
      if (after.empty()) continue;
      EXPECT_LT(std::hypot(after[0][2].x - 30, after[0][2].y - 3.2), 1.5);
    }
}

TEST(WallShifts, AHoleIsARingLikeAnother) {
  const Rings rings{{{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {{6, 6}, {6, 14}, {14, 14}, {14, 6}}};
  const Walls walls = find_walls(rings, {});
  EXPECT_EQ(walls.walls.size(), 8u);
  std::vector<double> shifts(walls.movable.size(), 0.0);
  for (const Wall& wall : walls.walls)
    if (wall.ring == 1 && wall.normal().x > 0.99) shifts[wall.group] = 1;  // the west wall of the yard moves into it
  const Rings after = shifted_outline(rings, walls, shifts, 1.5);
  ASSERT_EQ(after.size(), 2u);
  EXPECT_EQ(after[0], rings[0]);
  EXPECT_NEAR(geometry::signed_area(after[1]), -56, 1e-6);
}

TEST(WallShifts, WhatWouldNotStayCleanIsNotDone) {
  // Its wing is 0.7 m deep: a wall that goes in by 0.8 m turns its ends round.
  const Rings wing{{{0, 0}, {12, 0}, {12, 8}, {6, 8}, {6, 8.7}, {0, 8.7}}};
  const Walls walls = find_walls(wing, {});
  std::vector<double> shifts(walls.movable.size(), 0.0);
  for (const Wall& wall : walls.walls)
    if (wall.first == 4) shifts[wall.group] = -0.8;
  EXPECT_TRUE(shifted_outline(wing, walls, shifts, 1.5).empty());
  // A shed of 2 x 2 m would lose more than a quarter of its area.
  EXPECT_TRUE(shifted({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}}, 1, 0, -0.6).empty());
  // A wall may not run into the yard behind it.
  const Rings yard{{{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {{0.9, 6}, {0.9, 14}, {14, 14}, {14, 6}}};
  const Walls around = find_walls(yard, {});
  std::vector<double> in(around.movable.size(), 0.0);
  for (const Wall& wall : around.walls)
    if (wall.ring == 0 && wall.normal().x < -0.99) in[wall.group] = -1;
  EXPECT_TRUE(shifted_outline(yard, around, in, 1.5).empty());
}

TEST(WallShifts, WhatANeighbourSharesStays) {
  const Rings rings{kBox};
  const Walls walls = find_walls(rings, {{1, 0, 0, 1}});  // its west wall is a party wall
  EXPECT_FALSE(walls.movable[facing(walls, -1, 0)]);
  EXPECT_FALSE(walls.movable[facing(walls, 0, -1)]);
  EXPECT_FALSE(walls.movable[facing(walls, 0, 1)]);
  EXPECT_TRUE(walls.movable[facing(walls, 1, 0)]);
}

/// Star-shaped outlines, with right angles and without, with holes and notches.
TEST(WallShiftsProperty, TheOutlineStaysValidAndWithinTheBound) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> size(3, 14), shift(-1, 1), part(0, 1);
  int done = 0;
  for (int k = 0; k < 3000; ++k) {
    Rings rings(1);
    if (k % 2 == 0) {
      const double w = size(random), d = size(random), cut = part(random) * std::min(w, d) * 0.8;
      rings[0] = {{0, 0}, {w, 0}, {w, d - cut}, {w - cut, d - cut}, {w - cut, d}, {0, d}};
    } else {
      const int corners = 3 + k % 17;
      for (int i = 0; i < corners; ++i) {
        const base::SinCos a = base::sin_cos(2 * base::kPi * (i + 0.8 * part(random)) / corners);
        const double r = size(random);
        rings[0].push_back({r * a.cos, r * a.sin});
      }
    }
    for (Point2& p : rings[0]) p = model::snap(p);
    model::Polygon before;
    before.outer = {rings[0], std::vector<std::int64_t>(rings[0].size(), 0)};
    if (!geometry::strictly_simple(before) || geometry::signed_area(rings[0]) <= 0) continue;
    const Walls walls = find_walls(rings, {});
    std::vector<double> shifts(walls.movable.size(), 0.0);
    for (double& s : shifts)
      if (part(random) < 0.4) s = shift(random);
    const Rings after = shifted_outline(rings, walls, shifts, 1.5);
    if (after.empty()) continue;
    ++done;
    ASSERT_EQ(after[0].size(), rings[0].size());
    model::Polygon polygon;
    for (std::size_t i = 0; i < after[0].size(); ++i) {
      EXPECT_LE(std::hypot(after[0][i].x - rings[0][i].x, after[0][i].y - rings[0][i].y), 1.5);
      EXPECT_EQ(std::round(after[0][i].x * 1024) / 1024, model::snap(after[0][i].x));
      polygon.outer.points.push_back(model::snap(after[0][i]));
    }
    polygon.outer.nodes.assign(after[0].size(), 0);
    EXPECT_TRUE(geometry::strictly_simple(polygon)) << k;
    const double area = geometry::signed_area(rings[0]);
    EXPECT_LE(std::fabs(geometry::signed_area(after[0]) - area), kMostAreaChange * area * 1.001);
    // Not where the ring begins, nor what is called first, decides.
    Rings turned = rings;
    std::rotate(turned[0].begin(), turned[0].begin() + 1, turned[0].end());
    EXPECT_EQ(find_walls(turned, {}).walls.size(), walls.walls.size()) << k;
  }
  EXPECT_GT(done, 700);
}

}  // namespace
}  // namespace blockrand::observation
