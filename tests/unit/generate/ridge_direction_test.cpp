#include "pipeline/generate/ridge_direction.h"

#include <gtest/gtest.h>

#include "tests/unit/geometry/shapes.h"

namespace blockrand::generate {
namespace {

using model::Point2;
using testing_shapes::ring;

/// A house 6 m wide and 10 m deep: west and east walls are the long ones.
const model::Polygon kHouse{ring({{0, 0}, {6, 0}, {6, 10}, {0, 10}}), {}};
const WallStretch kEast{{6, 0}, {6, 10}}, kWest{{0, 10}, {0, 0}}, kNorth{{6, 10}, {0, 10}}, kSouth{{0, 0}, {6, 0}};
constexpr double kWidest = 17;

bool across(std::vector<WallStretch> walls, const model::Polygon& plan = kHouse) {
  return ridge_runs_across(plan, walls, kWidest);
}

TEST(RidgeDirection, RunsFromPartyWallToPartyWall) { EXPECT_TRUE(across({kEast, kWest})); }

TEST(RidgeDirection, LeavesTheOnePartyWallOfAnEndOfTerrace) { EXPECT_TRUE(across({kEast})); }

TEST(RidgeDirection, RunsAlongWhereNobodyStandsBeside) { EXPECT_FALSE(across({})); }

TEST(RidgeDirection, RunsAlongBetweenNeighboursAtTheShortSides) { EXPECT_FALSE(across({kNorth, kSouth})); }

TEST(RidgeDirection, RunsAlongAtACorner) { EXPECT_FALSE(across({kEast, kNorth})); }

TEST(RidgeDirection, DoesNotTurnForAGarage) { EXPECT_FALSE(across({{{6, 0}, {6, 4}}})); }

TEST(RidgeDirection, PiecesOfAWallCountTogether) {
  EXPECT_TRUE(across({{{6, 0}, {6, 2}}, {{6, 2}, {6, 4}}, {{6, 4}, {6, 5.5}}}));
}

TEST(RidgeDirection, NoRafterSpansALongHall) {
  const model::Polygon hall{ring({{0, 0}, {6, 0}, {6, 18}, {0, 18}}), {}};
  EXPECT_FALSE(across({{{6, 0}, {6, 18}}, {{0, 18}, {0, 0}}}, hall));
}

TEST(RidgeDirection, TakesThePartyWallsOfTheOutlineThatStandAtThePlan) {
  model::Building b;
  b.outline = {kHouse};
  const auto edge = [&](std::uint32_t number, model::EdgeKind kind, double start, double end) {
    model::FacadeEdge e;
    e.edge = number;
    e.kind = kind;
    e.start = start;
    e.end = end;
    b.edges.push_back(e);
  };
  edge(0, model::EdgeKind::street, 0, 6);
  edge(1, model::EdgeKind::party_wall, 0, 8);
  edge(1, model::EdgeKind::side, 8, 10);
  edge(3, model::EdgeKind::party_wall, 0, 10);
  const auto walls = party_walls_at(b, kHouse);
  ASSERT_EQ(walls.size(), 2u);
  EXPECT_EQ(walls[0].b, (Point2{6, 8}));
  const model::Polygon west_half{ring({{0, 0}, {3, 0}, {3, 10}, {0, 10}}), {}};
  EXPECT_EQ(party_walls_at(b, west_half).size(), 1u);
}

}  // namespace
}  // namespace blockrand::generate
