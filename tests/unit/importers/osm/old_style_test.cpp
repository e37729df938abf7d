// Multipolygons whose tags stand on the outer ways, as was the custom until 2017.
#include <gtest/gtest.h>

#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm::test {
namespace {

using model::IssueCode;
const TagList kHouse = {{"building", "yes"}};
const TagList kMultipolygon = {{"type", "multipolygon"}};

TEST(OldStyle, TheWayIsTheObjectAndTheRelationGivesTheRings) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, {{"building", "yes"}, {"building:levels", "5"}})
                     .square(2, 20, 2, 2, 3)
                     .relation(1, {"w1 outer", "w2 inner"}, kMultipolygon)
                     .read();
  EXPECT_EQ(e.buildings.size(), 1u);
  EXPECT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(building(e, "w1")->geometry_from.text(), "r1");
  EXPECT_EQ(ring_sizes(e, building(e, "w1")->rings), (std::vector<int>{4, -4}));
  EXPECT_EQ(building(e, "w1")->attributes.storeys, 5.0f);
  EXPECT_EQ(rows(e, "w1", IssueCode::old_style_multipolygon), "r1");
  EXPECT_EQ(e.counts.old_style_multipolygons, 1u);
  EXPECT_EQ(e.counts.areas_with_holes, 1u);
  EXPECT_EQ(e.counts.building_relations, 0u);
}

TEST(OldStyle, ANameOrAddressOnTheRelationDoesNotMatter) {
  const auto e =
      OsmText()
          .square(1, 10, 0, 0, 10, kHouse)
          .square(2, 20, 2, 2, 3)
          .relation(1, {"w1 outer", "w2 inner"}, {{"type", "multipolygon"}, {"name", "x"}, {"addr:street", "y"}})
          .read();
  EXPECT_EQ(building(e, "w1")->geometry_from.text(), "r1");
}

TEST(OldStyle, OuterWaysWithTheSameTagsAreOneObject) {
  const auto e = OsmText()
                     .square(2, 10, 0, 0, 10, kHouse)
                     .square(1, 20, 20, 0, 10, {{"building", "yes"}, {"source", "Bing"}})
                     .square(3, 30, 2, 2, 3)
                     .square(4, 40, 40, 0, 10)  // outer without tags: goes to the first
                     .relation(1, {"w2 outer", "w1 outer", "w3 inner", "w4 outer"}, kMultipolygon)
                     .read();
  EXPECT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(state(e, "w2"), "duplicate of w1");
  auto sizes = ring_sizes(e, building(e, "w1")->rings);
  std::sort(sizes.begin(), sizes.end());
  EXPECT_EQ(sizes, (std::vector<int>{-4, 4, 4, 4}));
}

TEST(OldStyle, OuterWaysWithDifferentTagsAreTheirOwnObjects) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, kHouse)
                     .square(2, 20, 20, 0, 10, {{"building", "garage"}})
                     .square(3, 30, 2, 2, 3)
                     .square(4, 40, 22, 2, 3)
                     .relation(1, {"w1 outer", "w2 outer", "w3 inner", "w4 inner"}, kMultipolygon)
                     .read();
  EXPECT_EQ(ring_sizes(e, building(e, "w1")->rings), (std::vector<int>{4, -4}));
  EXPECT_EQ(ring_sizes(e, building(e, "w2")->rings), (std::vector<int>{4, -4}));
  EXPECT_EQ(e.counts.areas_with_holes, 2u);
  EXPECT_EQ(e.counts.old_style_multipolygons, 1u);
}

TEST(OldStyle, WaysOfOneRingAreOneObject) {
  const auto e = OsmText()
                     .corners(10, 0, 0, 10)
                     .way(1, {12, 13, 10}, {{"building", "house"}})
                     .way(2, {10, 11, 12}, kHouse)
                     .relation(1, {"w2 outer", "w1 outer"}, kMultipolygon)
                     .read();
  EXPECT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(state(e, "w2"), "duplicate of w1");
  EXPECT_EQ(ring_sizes(e, building(e, "w1")->rings), (std::vector<int>{4}));
}

TEST(OldStyle, AnInnerWayWithABuildingIsABuildingOfItsOwn) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, kHouse)
                     .square(2, 20, 2, 2, 3, kHouse)
                     .relation(1, {"w1 outer", "w2 inner"}, kMultipolygon)
                     .read();
  EXPECT_EQ(ring_sizes(e, building(e, "w1")->rings), (std::vector<int>{4, -4}));
  EXPECT_EQ(state(e, "w2"), "pending");
  EXPECT_EQ(building(e, "w2")->geometry_from.text(), "w2");
}

TEST(OldStyle, WrongRolesAreSeenThrough) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, kHouse)
                     .square(2, 20, 2, 2, 3)
                     .relation(1, {"w1 inner", "w2 inner"}, kMultipolygon)
                     .read();
  EXPECT_EQ(ring_sizes(e, building(e, "w1")->rings), (std::vector<int>{4, -4}));
}

TEST(OldStyle, OfTwoRelationsTheLowerIdGivesTheRings) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, kHouse)
                     .square(2, 20, 2, 2, 3)
                     .square(3, 30, 6, 6, 3)
                     .relation(5, {"w1 outer", "w2 inner"}, kMultipolygon)
                     .relation(4, {"w1 outer", "w3 inner", "w2 inner"}, kMultipolygon)
                     .read();
  EXPECT_EQ(building(e, "w1")->geometry_from.text(), "r4");
  EXPECT_EQ(e.counts.old_style_multipolygons, 1u);
}

TEST(OldStyle, ABrokenRelationLeavesTheClosedWayAlone) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, kHouse)
                     .relation(1, {"w1 outer", "w99 inner"}, kMultipolygon)
                     .corners(20, 20, 0, 10)
                     .way(2, {20, 21, 22}, kHouse)
                     .relation(2, {"w2 outer", "w98 outer"}, kMultipolygon)
                     .read();
  EXPECT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(rows(e, "w1", IssueCode::members_missing), "not in the file: w99");
  EXPECT_EQ(state(e, "w2"), "OUTLINE_INCOMPLETE");
  EXPECT_EQ(rows(e, "w2", IssueCode::outline_incomplete), "r2: not in the file: w98");
}

TEST(OldStyle, LandUseIsTreatedAlike) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, {{"landuse", "residential"}})
                     .square(2, 20, 2, 2, 3, {{"landuse", "residential"}})  // only marks the hole
                     .square(3, 30, 6, 6, 3, {{"leisure", "park"}})
                     .relation(1, {"w1 outer", "w2 inner", "w3 inner"}, kMultipolygon)
                     .read();
  ASSERT_NE(feature(e, "w1"), nullptr);
  EXPECT_TRUE(feature(e, "w1")->area);
  EXPECT_EQ(ring_sizes(e, feature(e, "w1")->rings), (std::vector<int>{4, -4, -4}));
  EXPECT_EQ(feature(e, "w2"), nullptr);
  EXPECT_NE(feature(e, "w3"), nullptr);
}

}  // namespace
}  // namespace blockrand::importers::osm::test
