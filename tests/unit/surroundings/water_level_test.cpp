// Still water is level, whatever the terrain below it does.
#include "pipeline/surroundings/water_level.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/unit/surroundings/surroundings_town.h"

namespace blockrand::surroundings::test {
namespace {

using model::GroundClass;
using model::Point2;
using model::Point3;

double waves(Point2 p) { return 20 + 0.4 * std::sin(p.x / 9) + 0.4 * std::cos(p.y / 7); }

Town lake(const Town::Tags& tags) {
  Town town;
  town.box(1, 500, 100, 510, 110, {{"building", "yes"}});
  town.box(2, 0, 0, 300, 200, tags);
  return town;
}

std::set<double> water_heights(const BuiltTown& built) {
  std::set<double> out;
  for (const model::GroundSurface& s : built.all().surfaces)
    if (s.ground == GroundClass::water)
      for (const model::FlatPolygon& face : s.faces)
        for (const Point3& p : face.outer) out.insert(p.z);
  return out;
}

TEST(WaterLevel, StillWaterHasOneHeightInAllSquares) {
  const BuiltTown built(lake({{"natural", "water"}}), waves);
  const std::set<double> heights = water_heights(built);
  ASSERT_EQ(heights.size(), 1u);
  EXPECT_LT(*heights.begin(), 20);
  EXPECT_GT(*heights.begin(), 18.5);
}

TEST(WaterLevel, FlowingWaterFollowsTheTerrain) {
  EXPECT_GT(water_heights(BuiltTown(lake({{"natural", "water"}, {"water", "river"}}), waves)).size(), 10u);
  // A river that is tagged as a lake falls too far.
  const auto falls = [](Point2 p) { return 20 + p.x / 20; };
  EXPECT_GT(water_heights(BuiltTown(lake({{"natural", "water"}}), falls)).size(), 10u);
}

// Along the shore the heights of both sides are joined by upright faces: every edge of a water's face that no other face of it
// shares is an edge of a step, or one where both heights are the same.
TEST(WaterLevel, BanksCloseTheStepToTheWater) {
  const BuiltTown built(lake({{"natural", "water"}}), waves);
  using Edge = std::pair<Point3, Point3>;
  std::map<Edge, int> edges;
  const auto count = [&](const std::vector<Point3>& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point3 a = ring[i], b = ring[(i + 1) % ring.size()];
      if (a == b) continue;
      ++edges[{a, b}], --edges[{b, a}];
    }
  };
  double shore = 0;
  for (const model::GroundSurface& s : built.all().surfaces) {
    for (const model::FlatPolygon& face : s.faces) {
      count(face.outer);
      for (const auto& hole : face.holes) count(hole);
    }
    for (const model::FlatPolygon& face : s.edges) {
      count(face.outer);
      ASSERT_GE(face.outer.size(), 3u);
      shore += 1;
    }
  }
  EXPECT_GT(shore, 40);
  // What stays open in the lake's neighbourhood are the upright sides of steps, which have their neighbour's beside them.
  double open = 0;
  for (const auto& [edge, n] : edges) {
    const auto& [a, b] = edge;
    const auto [x, y] = built.in_town({(a.x + b.x) / 2, (a.y + b.y) / 2});
    const bool upright = a.x == b.x && a.y == b.y;
    if (n > 0 && !upright && x > -5 && x < 305 && y > -5 && y < 205 && (x < 5 || x > 295 || y < 5 || y > 195))
      open += std::hypot(a.x - b.x, a.y - b.y);
  }
  // Where level water cuts the terrain along the shore, a point of the step stands between two of the faces.
  EXPECT_LT(open, 120);
}

TEST(WaterLevel, WithoutTerrainNothingChanges) {
  const std::set<double> heights = water_heights(BuiltTown(lake({{"natural", "water"}})));
  ASSERT_EQ(heights.size(), 1u);
  EXPECT_EQ(*heights.begin(), -0.5);
}

TEST(WaterLevel, KnowsStillWater) {
  const auto still = [](const std::map<std::string, std::string, std::less<>>& tags) {
    return is_still_water([&](std::string_view key) {
      const auto known = tags.find(key);
      return known == tags.end() ? std::string_view() : std::string_view(known->second);
    });
  };
  EXPECT_TRUE(still({{"natural", "water"}}));
  EXPECT_TRUE(still({{"natural", "water"}, {"water", "lake"}}));
  EXPECT_TRUE(still({{"waterway", "dock"}}));
  EXPECT_TRUE(still({{"landuse", "basin"}}));
  EXPECT_TRUE(still({{"leisure", "swimming_pool"}}));
  EXPECT_FALSE(still({{"natural", "water"}, {"water", "river"}}));
  EXPECT_FALSE(still({{"natural", "water"}, {"water", "canal"}}));
  EXPECT_FALSE(still({{"waterway", "riverbank"}}));
}

}  // namespace
}  // namespace blockrand::surroundings::test
