#include "pipeline/context/situation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/context/small_town.h"

namespace blockrand::context {
namespace {

using model::BuildingPosition;
using model::WallSegmentKind;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(Situation, HouseInTheMiddleOfARow) {
  SmallTown t = perimeter_block();
  t.label();
  const model::BuildingSituation& s = t[12].situation;
  EXPECT_EQ(s.position, BuildingPosition::mid_row);
  ASSERT_THAT(s.fronts, SizeIs(1));
  EXPECT_EQ(t[12].edges[s.fronts[0]].kind, WallSegmentKind::street);
  EXPECT_NEAR(s.orientation.value(), 180, 0.01);
  EXPECT_NEAR(s.depth.value(), 12, 0.01);
  EXPECT_NEAR(s.width.value(), 12, 0.01);
  EXPECT_NEAR(s.setback.value(), 0, 0.01);
  EXPECT_NEAR(s.party_wall_length, 24, 0.01);
  ASSERT_EQ(t.blocks.size(), 1u);
  EXPECT_EQ(s.block, t.blocks[0].id);
  ASSERT_THAT(t.figures[0].courtyards, SizeIs(1));
  EXPECT_THAT(s.courtyards, ElementsAre(t.figures[0].courtyards[0].id));
  EXPECT_TRUE(t.figures[0].courtyards[0].id.starts_with("w1.y"));
}

TEST(Situation, CornerHousesFaceTwoStreetsThatMeet) {
  SmallTown t = perimeter_block();
  t.label();
  for (const int id : {1, 2, 3, 4}) {
    EXPECT_EQ(t[id].situation.position, BuildingPosition::corner_house) << id;
    EXPECT_THAT(t[id].situation.fronts, SizeIs(2)) << id;
  }
}

TEST(Situation, AddressDecidesWhichFrontOfACornerHouseIsTheMainOne) {
  for (const auto& [address, degrees] : {std::pair("South Street", 180.0), std::pair("West Street", 270.0)}) {
    SmallTown t = perimeter_block();
    t.label(address);
    EXPECT_NEAR(t[1].situation.orientation.value(), degrees, 0.01) << address;
    EXPECT_EQ(t[1].edges[t[1].situation.fronts[0]].street_name, address);
  }
  // Without one on the building, address nodes in it tell.
  SmallTown t = perimeter_block();
  t.point(701, SitePointKind::address, 15, 15, "West Street");
  t.point(702, SitePointKind::address, 18, 15, "West Street");
  t.point(703, SitePointKind::entrance, 18, 10, "South Street");
  t.label();
  EXPECT_NEAR(t[1].situation.orientation.value(), 270, 0.01);
}

TEST(Situation, EndOfARowAndFreeStanding) {
  SmallTown t;
  t.street(901, {{-120, 0}, {200, 0}}, "Street");
  t.box(1, 0, 10, 12, 22);
  t.box(2, 12, 10, 24, 22);
  t.box(3, 24, 10, 36, 22);
  t.box(4, 60, 10, 72, 22);
  t.box(5, 72, 14, 75.5, 20);  // its garage
  t.label();
  EXPECT_EQ(t[1].situation.position, BuildingPosition::end_of_row);
  EXPECT_EQ(t[2].situation.position, BuildingPosition::mid_row);
  EXPECT_EQ(t[3].situation.position, BuildingPosition::end_of_row);
  EXPECT_EQ(t[4].situation.position, BuildingPosition::free_standing) << "a garage makes no row";
  EXPECT_NEAR(t[4].situation.party_wall_length, 6, 0.01);
}

TEST(Situation, RearBuildingAndSideWing) {
  SmallTown t = perimeter_block();
  t.box(51, 38, 40, 62, 52);  // Hinterhaus
  t.box(52, 26, 22, 33, 44);  // Seitenfluegel behind the front house 11
  t.label();
  EXPECT_EQ(t[51].situation.position, BuildingPosition::rear_building);
  EXPECT_THAT(t[51].situation.fronts, IsEmpty());
  EXPECT_FALSE(t[51].situation.orientation.has_value());
  EXPECT_FALSE(t[51].situation.setback.has_value());
  EXPECT_NEAR(t[51].situation.width.value(), 24, 0.01);
  EXPECT_NEAR(t[51].situation.depth.value(), 12, 0.01);
  EXPECT_EQ(t[52].situation.position, BuildingPosition::side_wing);
  EXPECT_EQ(t[11].situation.position, BuildingPosition::mid_row);
}

TEST(Situation, SetbackIsMeasuredFromTheBuildingLineOfTheStreet) {
  SmallTown t;
  t.street(901, {{-120, 0}, {200, 0}}, "Street");
  for (int i = 0; i < 7; ++i) {
    const double back = i == 3 ? 5 : 0;
    t.box(1 + i, 14 * i, 10 + back, 14 * i + 12, 22 + back);
  }
  t.label();
  EXPECT_NEAR(t[4].situation.setback.value(), 5, 0.01);
  EXPECT_NEAR(t[3].situation.setback.value(), 0, 0.01);
}

TEST(Situation, LongestFrontIsTheMainOneWithoutAnAddress) {
  SmallTown t;
  t.street(901, {{-60, 0}, {0, 0}, {120, 0}}, "Long");
  t.street(902, {{0, 0}, {0, 120}}, "Short");
  t.box(1, 8, 8, 40, 20);
  t.label();
  const model::Building& b = t[1];
  EXPECT_EQ(b.situation.position, BuildingPosition::corner_house);
  EXPECT_EQ(b.edges[b.situation.fronts[0]].street_name, "Long");
  EXPECT_EQ(b.edges[b.situation.fronts[1]].street_name, "Short");
}

TEST(Situation, RoundedCornerIsAStreetCorner) {
  SmallTown t;
  t.street(901, {{-60, 0}, {0, 0}, {120, 0}}, "Long");
  t.street(902, {{0, 0}, {0, 120}}, "Short");
  t.house(1, {{12, 8}, {40, 8}, {40, 20}, {20, 20}, {20, 40}, {8, 40}, {8, 12}, {8.6, 10}, {10, 8.6}});
  t.label();
  EXPECT_EQ(t[1].situation.position, BuildingPosition::corner_house);
  int corners = 0;
  for (const model::WallSegment& f : t[1].edges) corners += f.corner_start + f.corner_end;
  EXPECT_GE(corners, 2);
}

TEST(Situation, ShedInAGardenStandsFree) {
  SmallTown t;
  t.street(901, {{-120, 0}, {200, 0}}, "Street");
  t.box(1, 0, 10, 12, 22);
  t.box(2, 4, 50, 8, 54);
  t.label();
  EXPECT_EQ(t[2].situation.position, BuildingPosition::free_standing);
  EXPECT_EQ(t[2].situation.block, "");
}

TEST(Situation, ABuildingOfTwoPolygonsIsInOneBlockAsTheBlockSays) {
  for (const double depth : {4.0, 12.0}) {
    SmallTown t = perimeter_block();
    t.box(51, 40, 40, 60, 50);  // 200 m2 in the block
    SmallTown beyond;
    beyond.box(51, 110, 40, 130, 40 + depth);  // 80 or 240 m2 over the street
    t.buildings.back().outline.push_back(beyond.footprints[0].polygon);
    t.footprints.push_back(beyond.footprints[0]);
    t.label();
    ASSERT_EQ(t.blocks.size(), 1u);
    EXPECT_EQ(t[51].situation.block, depth < 10 ? t.blocks[0].id : "");
    std::size_t polygons = 0;
    for (const std::uint32_t i : t.figures[0].buildings) polygons += t.footprints[i].id.number == 51;
    EXPECT_EQ(polygons, depth < 10 ? 2u : 0u);
  }
}

}  // namespace
}  // namespace blockrand::context
