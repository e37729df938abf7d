#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "tests/unit/masonry/masonry_walls.h"

namespace blockrand::masonry {
namespace {

using model::Point2;

std::vector<Stone> of_role(const LaidWall& laid, std::initializer_list<StoneRole> roles) {
  std::vector<Stone> out;
  for (const Stone& s : laid.stones)
    if (std::ranges::find(roles, s.role) != roles.end()) out.push_back(s);
  return out;
}

LaidWall with(const Outline& opening, Bond bond) {
  WallToLay wall = plain_wall(6, 4.5);
  wall.openings = {opening};
  return *lay(wall, usual_masonry(bond));
}

TEST(Dressings, VoussoirsPointAtTheCentreAndTheKeystoneStandsInTheMiddle) {
  for (const Bond bond : kAllBonds) {
    const double left = 2.3, right = 3.5, spring = 2.2, rise = 0.6;
    const LaidWall laid = with(arched(left, 0.05, right, spring, rise), bond);
    EXPECT_EQ(laid.undressed, 0u);
    const std::vector<Stone> stones = of_role(laid, {StoneRole::voussoir, StoneRole::keystone});
    ASSERT_EQ(stones.size() % 2, 1u);
    ASSERT_GE(stones.size(), 3u);
    const std::size_t middle = stones.size() / 2;
    for (std::size_t i = 0; i < stones.size(); ++i)
      EXPECT_EQ(stones[i].role == StoneRole::keystone, i == middle) << kBondNames[static_cast<int>(bond)];
    EXPECT_NEAR(geometry::centroid(stones[middle].outline).x, (left + right) / 2, 0.003);
    // The sides of a stone (all but the lowest two, which stand on a course) run towards the centre.
    const Point2 centre{(left + right) / 2, spring};
    for (std::size_t i = 1; i + 1 < stones.size(); ++i) {
      const Point2 c = geometry::centroid(stones[i].outline);
      const double out = std::atan2(c.y - centre.y, c.x - centre.x);
      EXPECT_NEAR(out, 3.14159265 * (static_cast<double>(i) + 0.5) / static_cast<double>(stones.size()), 0.03);
      for (const Point2& p : stones[i].outline) EXPECT_GT(std::hypot(p.x - centre.x, p.y - centre.y), rise - 0.006);
    }
  }
}

TEST(Dressings, PointedArchesHaveTheirKeystoneInThePoint) {
  const LaidWall laid = with(pointed(2.3, 1, 3.5, 2), Bond::ashlar);
  const std::vector<Stone> key = of_role(laid, {StoneRole::keystone});
  ASSERT_EQ(key.size(), 1u);
  EXPECT_NEAR(geometry::centroid(key[0].outline).x, 2.9, 0.003);
  EXPECT_GT(geometry::centroid(key[0].outline).y, 2 + 1.2 * 0.866);
}

TEST(Dressings, RoundWindowsHaveStonesAllRound) {
  const LaidWall laid = with(round_window({3, 2.2}, 0.5), Bond::stretcher);
  const std::vector<Stone> stones = of_role(laid, {StoneRole::voussoir, StoneRole::keystone});
  // Of 0.5 m radius: 3.14 m of bricks on edge at 81 mm.
  EXPECT_NEAR(static_cast<double>(stones.size()), 3.13 / 0.081, 2.1);
  const auto lowest =
      std::ranges::min_element(stones, {}, [](const Stone& s) { return geometry::centroid(s.outline).y; });
  EXPECT_LT(geometry::centroid(lowest->outline).y, 1.7);
}

TEST(Dressings, LintelsLieOnBothJambsAndBearTheFirstCourseAbove) {
  for (const Bond bond : {Bond::ashlar, Bond::rubble, Bond::cyclopean}) {
    const LaidWall laid = with(rectangle(2.3, 1, 3.5, 2.4), bond);
    const std::vector<Stone> lintels = of_role(laid, {StoneRole::lintel});
    ASSERT_EQ(lintels.size(), 1u) << kBondNames[static_cast<int>(bond)];
    double left = 1e300, right = -1e300, low = 1e300, high = -1e300;
    for (const Point2& p : lintels[0].outline)
      left = std::min(left, p.x), right = std::max(right, p.x), low = std::min(low, p.y), high = std::max(high, p.y);
    EXPECT_LT(left, 2.3 - 0.1);
    EXPECT_GT(right, 3.5 + 0.1);
    EXPECT_NEAR(low, 2.4, 0.031);
    EXPECT_GT(high - low, 0.2);
    EXPECT_LT(high - low, 0.5);
    EXPECT_EQ(of_role(laid, {StoneRole::sill}).size(), 1u);
  }
}

TEST(Dressings, BrickHeadsAreStonesOnEndThatLeanOutwards) {
  const LaidWall laid = with(rectangle(2.3, 1, 3.5, 2.4), Bond::english);
  const std::vector<Stone> stones = of_role(laid, {StoneRole::lintel});
  EXPECT_EQ(stones.size() % 2, 1u);
  EXPECT_NEAR(static_cast<double>(stones.size()), 1.2 / 0.081, 1.1);
  // First and last lean away from the opening by the same amount.
  EXPECT_LT(stones.front().outline[3].x, 2.3 - 0.03);
  EXPECT_GT(stones.back().outline[2].x, 3.5 + 0.03);
  EXPECT_NEAR(2.3 - stones.front().outline[3].x, stones.back().outline[2].x - 3.5, 1e-9);
}

TEST(Dressings, DoorsHaveNoSill) {
  for (const Bond bond : kAllBonds)
    EXPECT_TRUE(of_role(with(rectangle(2.3, 0.05, 3.4, 2.2), bond), {StoneRole::sill}).empty());
}

TEST(Dressings, OpeningsWithoutRoomAreCounted) {
  WallToLay wall = plain_wall(3, 2.5);
  wall.openings = {rectangle(0.5, 0.8, 2.5, 2.48)};
  for (const Bond bond : kAllBonds) {
    const auto laid = lay(wall, usual_masonry(bond));
    EXPECT_EQ(laid->undressed, 1u) << kBondNames[static_cast<int>(bond)];
    EXPECT_TRUE(of_role(*laid, {StoneRole::lintel}).empty());
  }
}

}  // namespace
}  // namespace blockrand::masonry
