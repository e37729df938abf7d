// Which corners of neighbours become one, and which must not.
#include "pipeline/footprints/repair/shared_walls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/footprints/repair/row_support.h"

namespace blockrand::repair::test {
namespace {

using model::IssueCode;
using model::Point2;
using testing::Contains;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::Not;

TerraceRow repaired(TerraceRow row, model::Report& report) {
  repair_terrace_row(row, without_squaring(), report);
  return row;
}
TerraceRow repaired(TerraceRow row) {
  model::Report report;
  return repaired(std::move(row), report);
}

TEST(SharedWalls, GapBetweenRowHousesIsClosed) {
  model::Report report;
  const TerraceRow row = repaired(
      row_of_polygons({polygon(box(0, 0, 10, 8)), polygon({{10.2, 0.1}, {20, 0}, {20, 8}, {10.2, 8.1}})}), report);
  ASSERT_TRUE(all_valid(row));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(8.0, 0.2));
  EXPECT_LE(row.buildings[0].record.max_shift, 0.2);
  EXPECT_LE(row.buildings[1].record.max_shift, 0.2);
  EXPECT_EQ(row.buildings[0].record.moved, 2u);
  EXPECT_EQ(row.buildings[0].record.shared_walls, 1u);
  EXPECT_EQ(row.buildings[0].record.gaps_closed, 1u);
  EXPECT_EQ(row.buildings[1].record.gaps_closed, 1u);
  EXPECT_THAT(codes_of(report, 1), ElementsAre(IssueCode::shared_wall_made));
  EXPECT_EQ(report.rows[0].detail, "1 with w2");
}

TEST(SharedWalls, OverlapOfDrawingNoiseIsHalved) {
  const TerraceRow row = repaired(row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(9.7, 0, 20, 8))}));
  ASSERT_TRUE(all_valid(row));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(8.0, 0.01));
  EXPECT_EQ(common_area(row.buildings[0], row.buildings[1]), 0);
  EXPECT_THAT(area(row.buildings[0]), DoubleNear(80 - 0.15 * 8, 0.02));
}

TEST(SharedWalls, WallOnTheSameNodesStaysAsItIsAndIsNoClosedGap) {
  model::Report report;
  const TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(10, 0, 20, 8))});
  const TerraceRow row = repaired(before, report);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(same_points(row.buildings[i], before.buildings[i]));
  EXPECT_EQ(row.buildings[0].record.shared_walls, 1u);
  EXPECT_EQ(row.buildings[0].record.gaps_closed, 0u);
  EXPECT_THAT(report.rows, ElementsAre());
}

TEST(SharedWalls, CornerInTheMiddleOfAWallIsPutIntoIt) {
  // The second house is 3 m less deep.
  TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 12)), polygon(box(10.2, 0, 20, 9))});
  before.buildings[0].polygons[0].outer.nodes = {11, 12, 13, 14};
  const TerraceRow row = repaired(before);
  ASSERT_TRUE(all_valid(row));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(9.0, 0.02));
  ASSERT_EQ(row.buildings[0].polygons[0].outer.size(), 5u);
  // What repair put in has no node, what was there keeps it.
  EXPECT_THAT(row.buildings[0].polygons[0].outer.nodes, testing::UnorderedElementsAre(0, 11, 12, 13, 14));
}

TEST(SharedWalls, PiecesOfAWallLieInLine) {
  const TerraceRow row = repaired(row_of_polygons(
      {polygon(box(0, 0, 10, 30)), polygon({{10.3, 0}, {20, 0}, {20, 9}, {10.1, 9}}),
       polygon({{9.9, 9}, {20, 9}, {20, 19}, {10.2, 19}}), polygon({{10, 19}, {20, 19}, {20, 30}, {10.1, 30}})}));
  ASSERT_TRUE(all_valid(row));
  const model::Ring& wall = row.buildings[0].polygons[0].outer;
  ASSERT_EQ(wall.size(), 6u);
  for (const Point2 p : wall.points)
    if (p.x > kOrigin.x + 5) {
      double nearest = 1e9;
      const Point2 low = *std::min_element(wall.points.begin(), wall.points.end(), [](Point2 a, Point2 b) {
        return std::pair(a.x < kOrigin.x + 5, a.y) < std::pair(b.x < kOrigin.x + 5, b.y);
      });
      const Point2 high = *std::max_element(wall.points.begin(), wall.points.end(), [](Point2 a, Point2 b) {
        return std::pair(a.x > kOrigin.x + 5, a.y) < std::pair(b.x > kOrigin.x + 5, b.y);
      });
      nearest = geometry::distance_to_segment(p, low, high);
      EXPECT_LE(nearest, 1.5 / model::kGridStepsPerMetre);
    }
}

TEST(SharedWalls, ThreeHousesMeetInOneCorner) {
  const TerraceRow row = repaired(row_of_polygons({polygon({{0, 0}, {10, 0}, {10.1, 10}, {0, 10}}),
                                                   polygon({{10.2, 0}, {20, 0}, {20, 10}, {10.2, 9.9}}),
                                                   polygon({{0, 10.2}, {10, 10.15}, {20, 10.2}, {20, 20}, {0, 20}})}));
  ASSERT_TRUE(all_valid(row));
  Point2 meeting{};
  int common = 0;
  for (const Point2 p : row.buildings[0].polygons[0].outer.points)
    if (has_point(row.buildings[1], p) && has_point(row.buildings[2], p)) {
      meeting = p;
      ++common;
    }
  ASSERT_EQ(common, 1);
  EXPECT_THAT(meeting.x, DoubleNear(kOrigin.x + 10.1, 0.06));
  EXPECT_THAT(meeting.y, DoubleNear(kOrigin.y + 10.02, 0.06));
}

TEST(SharedWalls, AlleyOf80CentimetresStaysOpen) {
  model::Report report;
  const TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(10.8, 0, 20, 8))});
  const TerraceRow row = repaired(before, report);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(same_points(row.buildings[i], before.buildings[i]));
  EXPECT_THAT(report.rows, ElementsAre());
}

TEST(SharedWalls, MouthOfAnAlleyStaysOpenWhereAThirdHouseHasACornerThere) {
  // The corner of the house behind is nearer to both than snap_reach.
  const TerraceRow row = repaired(row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(10.8, 0, 20, 8)),
                                                   polygon({{0, 8.1}, {10.4, 8.1}, {20, 8.1}, {20, 16}, {0, 16}})}));
  ASSERT_TRUE(all_valid(row));
  for (const Point2 p : row.buildings[0].polygons[0].outer.points) EXPECT_FALSE(has_point(row.buildings[1], p));
  EXPECT_GT(shared_length(row.buildings[0], row.buildings[2]), 9.0);
  EXPECT_GT(shared_length(row.buildings[1], row.buildings[2]), 8.0);
}

TEST(SharedWalls, WedgeBetweenTwoHousesIsNotClosed) {
  // They meet in a corner and go apart by 15 degrees.
  const TerraceRow before =
      row_of_polygons({polygon(box(0, 0, 10, 8)), polygon({{10, 0}, {20, 0}, {20, 8}, {12.14, 8}})});
  const TerraceRow row = repaired(before);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(same_points(row.buildings[i], before.buildings[i]));
}

TEST(SharedWalls, WallUnderACanopyIsUntouched) {
  TerraceRow before =
      row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(10.2, 0, 20, 8)), polygon(box(-3, -3, 10.1, 9))});
  before.buildings[1].level.canopy = true;
  before.buildings[2].level.layer = 1;
  const TerraceRow row = repaired(before);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(same_points(row.buildings[i], before.buildings[i]));
}

TEST(SharedWalls, BridgeAboveSharesNothing) {
  TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(10.2, 0, 20, 8))});
  before.buildings[0].level.high = 6;
  before.buildings[1].level.low = 6;
  const TerraceRow row = repaired(before);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(same_points(row.buildings[i], before.buildings[i]));
}

TEST(SharedWalls, HouseInACourtyardTouchesItsWalls) {
  // A hole of 10 x 10 m, nearly filled.
  const TerraceRow row = repaired(row_of_polygons({polygon(box(0, 0, 30, 30), {box(10, 10, 20, 20)}),
                                                   polygon({{10.2, 10.1}, {19.8, 10.2}, {19.9, 19.9}, {10.1, 19.8}})}));
  ASSERT_TRUE(all_valid(row));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(40, 0.8));
  EXPECT_EQ(row.buildings[1].record.shared_walls, 1u);
}

TEST(SharedWalls, HouseWithinAnUFillsIt) {
  const TerraceRow row =
      repaired(row_of_polygons({polygon({{0, 0}, {30, 0}, {30, 20}, {20, 20}, {20, 10}, {10, 10}, {10, 20}, {0, 20}}),
                                polygon({{10.2, 10.2}, {19.8, 10.1}, {19.9, 20}, {10.1, 20}})}));
  ASSERT_TRUE(all_valid(row));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(30, 0.6));
}

TEST(SharedWalls, CourtyardsOfNeighboursThatTouchStayApart) {
  // Two L-shaped halves around a court: what is shared are the walls where they meet.
  const TerraceRow row =
      repaired(row_of_polygons({polygon({{0, 0}, {20, 0}, {20, 6}, {6, 6}, {6, 20}, {0, 20}}),
                                polygon({{20.2, 6.2}, {20.1, 20}, {6.2, 20.2}, {6.1, 14}, {14, 14}, {14, 6.1}})}));
  ASSERT_TRUE(all_valid(row));
  EXPECT_THAT(shared_length(row.buildings[0], row.buildings[1]), DoubleNear(12, 0.5));
}

TEST(SharedWalls, CornersNearTheCutStayWhereTheyAre) {
  TerraceRow before = row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(10.2, 0, 20, 8))});
  before.beyond_cut = {polygon(box(0, 8.3, 10.05, 16))};
  const TerraceRow row = repaired(before);
  ASSERT_TRUE(all_valid(row));
  // The rear corners of both lie near the house beyond; they differ, so they stay apart. The front corners are joined.
  for (const Point2 p : {at(10, 8), at(0, 8)}) EXPECT_TRUE(has_point(row.buildings[0], p));
  EXPECT_TRUE(has_point(row.buildings[1], at(10.2, 8)));
  EXPECT_FALSE(has_point(row.buildings[0], at(10, 0)));
}

TEST(SharedWalls, SwitchedOffEveryCornerIsItsOwn) {
  RepairOptions options = without_squaring();
  options.share_walls = false;
  const TerraceGraph graph =
      build_terrace_graph(row_of_polygons({polygon(box(0, 0, 10, 8)), polygon(box(10, 0, 20, 8))}), options);
  EXPECT_EQ(graph.corners.size(), 8u);
  for (const Corner& c : graph.corners) EXPECT_EQ(c.said.size(), 1u);
}

TEST(TerraceGraph, CornersKnowWhatWasSaidAndRingsTheirWalls) {
  TerraceRow row = row_of_polygons({polygon(box(0, 0, 10, 12)), polygon(box(10.2, 0, 20, 9))});
  row.buildings[0].polygons[0].outer.nodes = {5, 6, 7, 8};
  row.buildings[1].polygons[0].outer.nodes = {4, 3, 2, 1};
  const TerraceGraph graph = build_terrace_graph(row, without_squaring());
  ASSERT_EQ(graph.rings.size(), 2u);
  EXPECT_EQ(graph.corners.size(), 7u);
  EXPECT_THAT(graph.rings[0].wall, ElementsAre(0u, 1u, 1u, 2u, 3u));
  EXPECT_THAT(graph.rings[1].wall, ElementsAre(0u, 1u, 2u, 3u));
  const Corner& common = graph.corners[graph.rings[0].corners[1]];
  EXPECT_THAT(common.said, testing::UnorderedElementsAre(at(10, 0), at(10.2, 0)));
  EXPECT_EQ(common.node, 4);
  const Corner& foot = graph.corners[graph.rings[0].corners[2]];
  EXPECT_THAT(foot.said, ElementsAre(at(10.2, 9)));
  EXPECT_EQ(graph.rings[1].corners[3], graph.rings[0].corners[2]);
}

}  // namespace
}  // namespace blockrand::repair::test
