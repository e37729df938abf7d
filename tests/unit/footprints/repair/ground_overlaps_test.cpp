// Ground that two footprints claim.
#include "pipeline/footprints/repair/ground_overlaps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/geometry/footprint_overlap.h"
#include "tests/unit/footprints/repair/row_support.h"
#include "tests/unit/geometry/find_slivers.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::repair::test {
namespace {

using geometry::interiors_meet;
using model::IssueCode;
using testing::DoubleNear;
using testing::ElementsAre;

TerraceRow resolved(TerraceRow row, model::Report& report) {
  resolve_overlaps(row, {}, report);
  return row;
}
TerraceRow resolved(TerraceRow row) {
  model::Report report;
  return resolved(std::move(row), report);
}

TEST(InteriorsMeet, NamedCases) {
  const model::Polygon house = polygon(box(0, 0, 10, 10));
  EXPECT_TRUE(interiors_meet(house, polygon(box(9, 9, 20, 20)))) << "corners cross";
  EXPECT_TRUE(interiors_meet(house, house)) << "twins";
  EXPECT_TRUE(interiors_meet(house, polygon(box(2, 2, 8, 8)))) << "within";
  EXPECT_TRUE(interiors_meet(polygon(box(2, 2, 8, 8)), house)) << "around";
  EXPECT_TRUE(interiors_meet(house, polygon(box(0, 2, 10, 8)))) << "a band across, on the walls";
  EXPECT_TRUE(interiors_meet(house, polygon({{0, 0}, {10, 10}, {0, 10}}))) << "half of it, on its corners";
  EXPECT_TRUE(interiors_meet(house, polygon({{5, 0}, {10, 5}, {5, 10}, {0, 5}}))) << "within, corners on walls";
  EXPECT_TRUE(interiors_meet(polygon(box(0, 4, 10, 6)), polygon(box(4, 0, 6, 10)))) << "a cross, no corner inside";
  EXPECT_FALSE(interiors_meet(house, polygon(box(10, 0, 20, 10)))) << "a wall in common";
  EXPECT_FALSE(interiors_meet(house, polygon(box(10, 3, 20, 15)))) << "a piece of wall in common";
  EXPECT_FALSE(interiors_meet(house, polygon(box(10, 10, 20, 20)))) << "a corner in common";
  EXPECT_FALSE(interiors_meet(house, polygon({{10, 5}, {15, 0}, {15, 10}}))) << "a corner on the wall";
  EXPECT_FALSE(interiors_meet(polygon(box(-5, -5, 15, 15), {box(0, 0, 10, 10)}), house)) << "fills the courtyard";
  EXPECT_FALSE(interiors_meet(polygon(box(-5, -5, 15, 15), {box(-1, -1, 11, 11)}), house)) << "within the courtyard";
  EXPECT_FALSE(interiors_meet(polygon({{0, 0}, {30, 0}, {30, 20}, {20, 20}, {20, 10}, {10, 10}, {10, 20}, {0, 20}}),
                              polygon(box(10, 10, 20, 30))))
      << "fills the U and looks out";
  const double step = 1 / model::kGridStepsPerMetre;
  EXPECT_TRUE(interiors_meet(house, polygon(box(10 - step, 0, 20, 10)))) << "one grid step";
}

TEST(ConflictingEdges, NameWhatCrosses) {
  EXPECT_THAT(geometry::conflicting_edges(polygon(box(0, 0, 10, 10))), ElementsAre());
  model::Polygon bow;
  bow.outer.points = {at(0, 0), at(10, 10), at(10, 0), at(0, 10)};
  bow.outer.nodes.assign(4, 0);
  EXPECT_THAT(geometry::conflicting_edges(bow), ElementsAre(std::pair(geometry::EdgeOf{0, 0}, geometry::EdgeOf{0, 2})));
}

TEST(Overlaps, TheWeakerGivesWayAndBothHaveTheSamePoints) {
  // w2 is tagged better and lies 2 m over w1's corner.
  TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 10)), polygon(box(8, 3, 20, 15))});
  before.buildings[1].tags = 4;
  model::Report report;
  const TerraceRow row = resolved(before, report);
  ASSERT_TRUE(all_valid(row));
  EXPECT_TRUE(interiors_meet(before.buildings[0].polygons[0], before.buildings[1].polygons[0]));
  EXPECT_FALSE(interiors_meet(row.buildings[0].polygons[0], row.buildings[1].polygons[0]));
  EXPECT_THAT(area(row.buildings[0]), DoubleNear(100 - 14, 0.01));
  EXPECT_THAT(area(row.buildings[1]), DoubleNear(144, 0.01));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(9, 0.01));
  EXPECT_EQ(row.buildings[0].record.overlaps_resolved, 1u);
  EXPECT_THAT(codes_of(report, 1), ElementsAre(IssueCode::overlap_resolved));
  EXPECT_EQ(report.rows[0].detail, "to w2, 14.00 m2");
}

TEST(Overlaps, NewPointsOnTheWinnersSlantedWallBecomeItsPoints) {
  TerraceRow before =
      row_of_polygons({polygon(box(0, 0, 10, 10)), polygon({{9, -5}, {20, 3.3}, {13, 14.7}, {7.7, 11.1}})});
  before.buildings[1].tags = 4;
  const TerraceRow row = resolved(before);
  ASSERT_TRUE(all_valid(row));
  EXPECT_GT(row.buildings[1].polygons[0].outer.size(), 4u);
  EXPECT_GT(shared_length(row.buildings[0], row.buildings[1]), 9.0);
  EXPECT_FALSE(interiors_meet(row.buildings[0].polygons[0], row.buildings[1].polygons[0]));
  EXPECT_THAT(area(row.buildings[1]), DoubleNear(area(before.buildings[1]), 0.02));
}

TEST(Overlaps, WhoKeepsTheGround) {
  const TerraceRow even = row_of_polygons({polygon(box(0, 0, 10, 10)), polygon(box(8, 0, 18, 10))});
  {
    TerraceRow row = even;
    row.buildings[1].has_parts = true;
    row.buildings[0].tags = 9;
    EXPECT_THAT(area(resolved(row).buildings[1]), DoubleNear(100, 0.01)) << "parts beat tags";
  }
  {
    TerraceRow row = even;
    row.buildings[1].tags = 2;
    EXPECT_THAT(area(resolved(row).buildings[1]), DoubleNear(100, 0.01)) << "more tags";
  }
  {
    TerraceRow row = even;
    row.buildings[0].polygons = {polygon(box(-3, 0, 10, 10))};
    EXPECT_THAT(area(resolved(row).buildings[1]), DoubleNear(100, 0.01)) << "the smaller";
  }
  EXPECT_THAT(area(resolved(even).buildings[0]), DoubleNear(100, 0.01)) << "the lower id";
}

TEST(Overlaps, NestedHouseGetsAHole) {
  model::Report report;
  const TerraceRow row = resolved(row_of_polygons({polygon(box(10, 10, 15, 15)), polygon(box(0, 0, 30, 30))}), report);
  ASSERT_TRUE(all_valid(row));
  ASSERT_EQ(row.buildings[1].polygons[0].holes.size(), 1u);
  EXPECT_THAT(area(row.buildings[0]), DoubleNear(25, 1e-9));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(20, 1e-9));
  EXPECT_THAT(codes_of(report, 1), ElementsAre(IssueCode::nested_building));
  EXPECT_THAT(codes_of(report, 2), ElementsAre(IssueCode::overlap_resolved));
}

TEST(Overlaps, NestedHouseAtTheWallGetsANotch) {
  const TerraceRow row = resolved(row_of_polygons({polygon(box(10, 0, 15, 5)), polygon(box(0, 0, 30, 30))}));
  ASSERT_TRUE(all_valid(row));
  EXPECT_TRUE(row.buildings[1].polygons[0].holes.empty());
  EXPECT_THAT(area(row.buildings[1]), DoubleNear(875, 1e-9));
}

TEST(Overlaps, ANestedHouseWhoseCornerReachesTheWall) {
  // A house in another, its corner almost on that one's wall, a third one on the other side of the wall: at any angle no
  // ground is claimed twice, no ring almost touches another.
  testing_shapes::Random random(9);
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE(round);
    const double angle = 2 * std::acos(-1) * random.unit(), c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](Points points) {
      for (model::Point2& p : points) p = {c * p.x - s * p.y, s * p.x + c * p.y};
      return polygon(points);
    };
    const double off = 0.001 + 0.04 * random.unit() * random.unit(), size = 2 + 3 * random.unit(),
                 spread = 0.3 + 0.5 * random.unit(), at = 6 + 8 * random.unit();
    const TerraceRow row = resolved(row_of_polygons(
        {turned({{at, 12 - off}, {at - spread * size, 12 - off - size}, {at + spread * size, 12 - off - size}}),
         turned(box(0, 0, 20, 12)), turned(box(0, 12, 20, 18))}));
    ASSERT_TRUE(all_valid(row));
    for (std::size_t a = 0; a < 3; ++a) {
      for (const model::Polygon& p : row.buildings[a].polygons) EXPECT_TRUE(geometry::rings_apart(p)) << a;
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_EQ(geometry::common_area(row.buildings[a].polygons, row.buildings[b].polygons), 0) << a << " and " << b;
    }
  }
}

TEST(Overlaps, IdenticalTwinsStayAndAreReported) {
  const TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 10)), polygon(box(0, 0, 10, 10))});
  model::Report report;
  const TerraceRow row = resolved(before, report);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(same_points(row.buildings[i], before.buildings[i]));
    EXPECT_THAT(row.buildings[i].record.overlap_left, DoubleNear(100, 1e-6));
    EXPECT_THAT(codes_of(report, static_cast<std::int64_t>(i + 1)), testing::Contains(IssueCode::overlap_kept));
  }
}

TEST(Overlaps, OutlineAroundItsHousesKeepsWhatIsLeft) {
  // Three houses cover most of an area drawn as a building; 6 m of it remain.
  const TerraceRow row = resolved(row_of_polygons({polygon(box(0, 0, 8, 10)), polygon(box(8, 0, 16, 10)),
                                                   polygon(box(16, 0, 24, 10)), polygon(box(0, 0, 30, 10))}));
  ASSERT_TRUE(all_valid(row));
  EXPECT_THAT(area(row.buildings[3]), DoubleNear(60, 1e-9));
}

TEST(Overlaps, LoserKeepsMoreThanHalfElseTheOtherYields) {
  // The weaker one would lose 60 %, the stronger one 30 %.
  TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 10)), polygon(box(4, 0, 24, 10))});
  before.buildings[1].tags = 3;
  const TerraceRow row = resolved(before);
  EXPECT_THAT(area(row.buildings[0]), DoubleNear(100, 1e-9));
  EXPECT_THAT(area(row.buildings[1]), DoubleNear(140, 1e-9));
}

TEST(Overlaps, CutInTwoIsTwoPieces) {
  TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 30)), polygon(box(-5, 12, 15, 18))});
  before.buildings[1].tags = 3;
  const TerraceRow row = resolved(before);
  ASSERT_TRUE(all_valid(row));
  EXPECT_EQ(row.buildings[0].polygons.size(), 2u);
  EXPECT_THAT(area(row.buildings[0]), DoubleNear(240, 1e-9));
}

TEST(Overlaps, StripBehindTheWinnerIsDropped) {
  // The winner crosses the loser 0.2 m before its end.
  TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 30)), polygon(box(-5, 22, 15, 29.8))});
  before.buildings[1].tags = 3;
  const TerraceRow row = resolved(before);
  ASSERT_TRUE(all_valid(row));
  EXPECT_EQ(row.buildings[0].polygons.size(), 1u);
  EXPECT_THAT(area(row.buildings[0]), DoubleNear(220, 1e-9));
}

TEST(Overlaps, ACutAlongAFrontLeavesNoNeedles) {
  // Rows of 30 houses, turned by 0.3 to 27 degrees, each a metre over its neighbour: rounding leaves the fronts a grid
  // step beside each other.
  constexpr int kHouses = 30;
  int slivers = 0, shared = 0;
  for (int turn = 1; turn <= 10; ++turn) {
    SCOPED_TRACE(turn);
    const double slope = 0.005 * turn * turn, scale = 1 / std::sqrt(1 + slope * slope);
    const auto turned = [&](double x, double y) {
      return model::Point2{(x - slope * y) * scale, (slope * x + y) * scale};
    };
    std::vector<model::Polygon> houses;
    for (int i = 0; i < kHouses; ++i)
      houses.push_back(polygon({turned(6 * i, 0), turned(6 * i + 7, 0), turned(6 * i + 7, 10), turned(6 * i, 10)}));
    const TerraceRow row = resolved(row_of_polygons(houses));
    ASSERT_TRUE(all_valid(row));
    double ground = 0;
    for (std::size_t i = 0; i < row.buildings.size(); ++i) {
      ground += area(row.buildings[i]);
      for (const model::Ring& r : rings(row.buildings[i]))
        slivers += static_cast<int>(geometry::find_slivers(r, 0.02).size());
      if (i == 0) continue;
      EXPECT_FALSE(interiors_meet(row.buildings[i - 1].polygons[0], row.buildings[i].polygons[0]));
      EXPECT_NEAR(shared_length(row.buildings[i - 1], row.buildings[i]), 10, 0.01);
      ++shared;
    }
    EXPECT_NEAR(ground, 10 * (6 * kHouses + 1), 0.3);
  }
  EXPECT_EQ(slivers, 0);
  EXPECT_EQ(shared, 290);
}

TEST(Overlaps, AWedgeAlongTheNeighboursWallIsCutWhereItStarts) {
  // w1 runs out in a tip of 4 m and 5 mm beside w2's wall, which keeps a corner where w1 ends.
  const TerraceRow row = resolved(
      row_of_polygons({polygon({{0, 0}, {10, 0}, {10, 14}, {9.995, 10}, {0, 10}}), polygon(box(10, 0, 20, 14))}));
  ASSERT_TRUE(all_valid(row));
  EXPECT_EQ(row.buildings[0].polygons[0].outer.size(), 5u);
  EXPECT_TRUE(has_point(row.buildings[0], at(10, 10)));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(10, 0.01));
  EXPECT_THAT(area(row.buildings[1]), DoubleNear(140, 1e-9));
}

TEST(Overlaps, OtherLevelsDoNotConflict) {
  TerraceRow before =
      row_of_polygons({polygon(box(0, 0, 10, 10)), polygon(box(5, 0, 15, 10)), polygon(box(5, 5, 15, 15))});
  before.buildings[1].level.canopy = true;
  before.buildings[2].level.low = 4;
  before.buildings[0].level.high = 4;
  model::Report report;
  const TerraceRow row = resolved(before, report);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(same_points(row.buildings[i], before.buildings[i]));
  EXPECT_TRUE(report.rows.empty());
}

}  // namespace
}  // namespace blockrand::repair::test
