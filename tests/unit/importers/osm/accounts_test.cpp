// Every state in which a building object can end (ARCHITECTURE.md, law 1), each from a file of a few lines.
#include <gtest/gtest.h>

#include "tests/unit/importers/osm/support.h"

namespace blockrand::importers::osm::test {
namespace {

using model::IssueCode;
const TagList kHouse = {{"building", "yes"}};

/// Counted objects are the entries, and only a pending one has rings.
void expect_books_balance(const model::Extract& e) {
  EXPECT_EQ(e.counts.buildings() + e.counts.parts(), e.buildings.size());
  for (const auto& b : e.buildings) {
    EXPECT_EQ(b.state == model::ObjectState::pending, b.rings.count > 0) << b.id.text();
    if (b.state != model::ObjectState::reported) continue;
    EXPECT_EQ(info(b.code).issue_class, model::IssueClass::reported) << b.id.text();
    EXPECT_EQ(std::count_if(e.report.rows.begin(), e.report.rows.end(),
                            [&](const auto& row) { return row.object == b.id && row.code == b.code; }),
              1)
        << b.id.text();
  }
}

TEST(Accounts, AClosedWayIsPendingWithItsRing) {
  const auto e = OsmText().square(1, 10, 0, 0, 1, {{"building", "house"}, {"name", "Zum Löwen"}}).read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "w1"), "pending");
  const auto* b = building(e, "w1");
  EXPECT_EQ(b->geometry_from, b->id);
  ASSERT_EQ(ring_sizes(e, b->rings), (std::vector<int>{4}));
  const auto nodes = e.nodes_of(e.rings_of(b->rings)[0]);
  EXPECT_EQ(std::vector<std::int64_t>(nodes.begin(), nodes.end()), (std::vector<std::int64_t>{10, 11, 12, 13}));
  EXPECT_EQ(e.vertices_of(e.rings_of(b->rings)[0])[2], (model::Location{130001000, 520001000}));
  EXPECT_EQ(e.tag(b->tags, "name"), "Zum Löwen");
  EXPECT_EQ(e.strings.view(b->attributes.use), "house");
  EXPECT_EQ(e.counts.building_ways, 1u);
  EXPECT_EQ(e.counts.nodes, 4u);
  EXPECT_EQ(e.data_time, "2020-01-01T00:00:00Z");
}

TEST(Accounts, NoIsNoBuilding) {
  const auto e = OsmText().square(1, 10, 0, 0, 1, {{"building", "no"}}).node(1, 13, 52, {{"building", "no"}}).read();
  EXPECT_EQ(e.buildings.size(), 0u);
  EXPECT_EQ(e.counts.buildings(), 0u);
}

TEST(Accounts, BuildingAndPartAtOnceCountOnce) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 1, {{"building", "yes"}, {"building:part", "yes"}})
                     .square(2, 20, 5, 0, 1, {{"building", "no"}, {"building:part", "tower"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(building(e, "w1")->kind, model::ObjectKind::building);
  EXPECT_EQ(building(e, "w2")->kind, model::ObjectKind::building_part);
  EXPECT_EQ(e.strings.view(building(e, "w2")->attributes.use), "tower");
  EXPECT_EQ(e.counts.building_ways, 1u);
  EXPECT_EQ(e.counts.part_ways, 1u);
}

TEST(Accounts, ANodeIsNodeOnlyAndStaysAnEntrance) {
  const auto e =
      OsmText().node(1, 13, 52, {{"building", "entrance"}}).node(2, 13, 52, kHouse).node(3, 13, 95, kHouse).read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "n1"), "NODE_ONLY");
  ASSERT_NE(feature(e, "n1"), nullptr);
  EXPECT_TRUE(feature(e, "n1")->is(model::FeatureKind::entrance));
  EXPECT_EQ(feature(e, "n2"), nullptr);
  EXPECT_EQ(state(e, "n3"), "INVALID_LOCATION");
}

TEST(Accounts, OpenWaysAndWaysWithTooFewPoints) {
  const auto e = OsmText()
                     .corners(10, 0, 0, 1)
                     .way(1, {10, 11, 12, 13}, kHouse)
                     .way(2, {10, 11, 10}, kHouse)
                     .way(3, {10}, kHouse)
                     .way(4, {}, kHouse)
                     .way(5, {10, 11, 11, 10, 10}, kHouse)
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "w1"), "OPEN_WAY");
  for (const char* id : {"w2", "w3", "w4", "w5"}) EXPECT_EQ(state(e, id), "TOO_FEW_POINTS") << id;
}

TEST(Accounts, AWayClosedByPositionIsClosed) {
  const auto e = OsmText().corners(10, 0, 0, 1).node(14, 13, 52).way(1, {10, 11, 12, 13, 14}, kHouse).read();
  EXPECT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(ring_sizes(e, building(e, "w1")->rings), (std::vector<int>{4}));
}

TEST(Accounts, MissingNodesLeaveWhatIsThere) {
  const auto e = OsmText()
                     .corners(10, 0, 0, 1)
                     .way(1, {10, 11, 12, 13, 99, 10}, kHouse)  // one lost
                     .way(2, {99, 10, 11, 12, 99}, kHouse)      // the closing one lost
                     .way(3, {10, 11, 98, 99, 10}, kHouse)      // too many lost
                     .node(20, 13, 91)
                     .way(4, {10, 11, 20, 10}, kHouse)  // invalid latitude
                     .way(5, {10, 11, 12, 99}, kHouse)  // not closed anyway
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(rows(e, "w1", IssueCode::members_missing), "1 of 5 nodes are not known");
  EXPECT_EQ(ring_sizes(e, building(e, "w2")->rings), (std::vector<int>{3}));
  EXPECT_EQ(state(e, "w3"), "OUTLINE_INCOMPLETE");
  EXPECT_EQ(state(e, "w4"), "INVALID_LOCATION");
  EXPECT_EQ(state(e, "w5"), "OPEN_WAY");
  EXPECT_EQ(e.counts.missing_nodes, 2u);
}

TEST(Accounts, AMultipolygonAndItsOuterWayAreOne) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, {{"building", "yes"}, {"building:levels", "4"}, {"height", "9"}})
                     .square(2, 20, 2, 2, 3)
                     .square(3, 30, 6, 6, 2, {{"building", "shed"}})
                     .relation(1, {"w1 outer", "w2 inner", "w3 inner"},
                               {{"type", "multipolygon"}, {"building", "palace"}, {"height", "12"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "pending");
  EXPECT_EQ(state(e, "w1"), "duplicate of r1");
  EXPECT_EQ(state(e, "w3"), "pending");
  EXPECT_EQ(state(e, "w2"), "absent");
  EXPECT_EQ(ring_sizes(e, building(e, "r1")->rings), (std::vector<int>{4, -4, -4}));
  EXPECT_EQ(building(e, "r1")->attributes.storeys, 4.0f);
  EXPECT_EQ(building(e, "r1")->attributes.height, 12.0f);
  EXPECT_EQ(rows(e, "r1", IssueCode::values_conflict), "height=12, w1 says 9");
  EXPECT_EQ(e.tag(building(e, "r1")->tags, "building:levels"), "4");
  EXPECT_EQ(e.counts.areas_with_holes, 1u);
  EXPECT_EQ(e.counts.building_ways, 2u);
  EXPECT_EQ(e.counts.building_relations, 1u);
}

TEST(Accounts, AnOuterWayThatIsAPartIsNoDuplicate) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, {{"building:part", "yes"}})
                     .relation(1, {"w1 outer"}, {{"type", "multipolygon"}, {"building", "yes"}})
                     .read();
  EXPECT_EQ(state(e, "r1"), "pending");
  EXPECT_EQ(state(e, "w1"), "pending");
}

TEST(Accounts, AnOpenWayThatIsPartOfAMultipolygonIsCarriedByIt) {
  const auto e = OsmText()
                     .corners(10, 0, 0, 10)
                     .way(1, {10, 11, 12}, kHouse)
                     .way(2, {12, 13, 10})
                     .relation(1, {"w1 outer", "w2 outer"}, {{"type", "multipolygon"}, {"building", "yes"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "pending");
  EXPECT_EQ(state(e, "w1"), "duplicate of r1");
}

TEST(Accounts, OfTwoRelationsTheLowerIdHasTheSharedOuterWay) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, kHouse)
                     .square(2, 20, 20, 0, 10)
                     .relation(7, {"w1 outer", "w2 outer"}, {{"type", "multipolygon"}, {"building", "school"}})
                     .relation(8, {"w1 outer"}, {{"type", "multipolygon"}, {"building", "hall"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "w1"), "duplicate of r7");
  EXPECT_EQ(state(e, "r7"), "pending");
  EXPECT_EQ(state(e, "r8"), "pending");
}

TEST(Accounts, BrokenAndIncompleteRelations) {
  const auto e = OsmText()
                     .corners(10, 0, 0, 10)
                     .way(1, {10, 11, 12})
                     .square(2, 20, 20, 0, 10)
                     .square(3, 30, 22, 2, 2)
                     .relation(1, {"w1 outer"}, {{"type", "multipolygon"}, {"building", "yes"}})
                     .relation(2, {"w2 outer", "w99 inner"}, {{"type", "multipolygon"}, {"building", "yes"}})
                     .relation(3, {"w99 outer", "w3 inner"}, {{"type", "multipolygon"}, {"building", "yes"}})
                     .relation(4, {}, {{"type", "multipolygon"}, {"building", "yes"}})
                     .relation(5, {"w2 outer", "w1 outer"}, {{"type", "multipolygon"}, {"building", "house"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "RING_BROKEN");
  EXPECT_EQ(state(e, "r2"), "pending");
  EXPECT_EQ(rows(e, "r2", IssueCode::members_missing), "not in the file: w99");
  EXPECT_EQ(state(e, "r4"), "RING_BROKEN");
  EXPECT_EQ(e.counts.missing_ways, 1u);
  // The same ring again: r2 and r5 are one building, and both have two tags.
  EXPECT_EQ(state(e, "r5"), "duplicate of r2");
}

TEST(Accounts, AnInnerRingWithoutItsOuterOneIsNoBuilding) {
  const auto e =
      OsmText()
          .square(3, 30, 22, 2, 2)
          .corners(10, 0, 0, 10)
          .way(1, {10, 11, 12})
          .relation(3, {"w99 outer", "w1 outer", "w3 inner"}, {{"type", "multipolygon"}, {"building", "yes"}})
          .read();
  EXPECT_EQ(state(e, "r3"), "OUTLINE_INCOMPLETE");
}

TEST(Accounts, CrossingRingsAreKeptAsMapped) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10)
                     .square(2, 20, 5, 5, 10)
                     .relation(1, {"w1 outer", "w2 outer"}, {{"type", "multipolygon"}, {"building", "yes"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "pending");
  EXPECT_EQ(rows(e, "r1", IssueCode::relation_repaired), "rings cross or overlap");
  EXPECT_EQ(ring_sizes(e, building(e, "r1")->rings), (std::vector<int>{4, 4}));
}

TEST(Accounts, RelationsOfOtherTypes) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10)
                     .square(2, 20, 20, 0, 10)
                     .relation(1, {"w1"}, {{"type", "site"}, {"building", "yes"}})
                     .relation(2, {"w1 outer"}, {{"type", "buillding"}, {"building", "yes"}})
                     .relation(3, {"w2"}, {{"building", "yes"}})
                     .relation(4, {"w2 outer"}, {{"type", "boundary"}, {"building", "fort"}, {"note", "x"}})
                     .relation(5, {"n10"}, {{"type", "route"}, {"building", "yes"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "RELATION_TYPE");
  EXPECT_EQ(rows(e, "r1", IssueCode::relation_type), "type=site");
  EXPECT_EQ(state(e, "r2"), "pending");
  EXPECT_EQ(state(e, "r3"), "duplicate of r4");  // the same ring, fewer tags
  EXPECT_EQ(state(e, "r4"), "pending");
  EXPECT_EQ(state(e, "r5"), "RELATION_TYPE");
}

TEST(Accounts, LifecycleAndUnderground) {
  OsmText text;
  const std::pair<TagList, const char*> cases[] = {
      {{{"building", "construction"}}, "LIFECYCLE"},
      {{{"building", "proposed"}}, "LIFECYCLE"},
      {{{"building", "demolished"}}, "LIFECYCLE"},
      {{{"building:part", "planned"}}, "LIFECYCLE"},
      {{{"building", "ruins"}}, "pending"},
      {{{"building", "yes"}, {"location", "underground"}}, "UNDERGROUND"},
      {{{"building", "yes"}, {"layer", "-1"}}, "pending"},
      {{{"building", "yes"}, {"layer", "-1"}, {"tunnel", "yes"}}, "UNDERGROUND"},
      {{{"building", "train_station"}, {"layer", "-2"}}, "UNDERGROUND"},
      {{{"building", "yes"}, {"layer", "-2"}, {"building:levels", "3"}}, "pending"},
      {{{"building", "roof"}, {"layer", "-2"}}, "pending"},
      {{{"building", "yes"}, {"layer", "1"}}, "pending"}};
  int n = 0;
  for (const auto& [tags, expected] : cases) {
    ++n;
    text.square(n, n * 100, n * 10, 0, 5, tags);
  }
  const auto e = text.read();
  expect_books_balance(e);
  n = 0;
  for (const auto& [tags, expected] : cases) {
    ++n;
    EXPECT_EQ(state(e, "w" + std::to_string(n)), expected);
  }
}

TEST(Accounts, ExactDuplicates) {
  const auto e =
      OsmText()
          .square(1, 10, 0, 0, 10, kHouse)
          .way(2, {12, 11, 10, 13, 12}, {{"building", "yes"}, {"name", "more"}})  // other start and direction
          .square(3, 20, 0, 0, 10, kHouse)                                        // other nodes, same places
          .way(4, {10, 11, 12, 13, 10}, {{"building:part", "yes"}})               // a part is no duplicate
          .way(5, {10, 12, 11, 13, 10}, kHouse)                                   // same nodes, other ring
          .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "w2"), "pending");
  EXPECT_EQ(state(e, "w1"), "duplicate of w2");
  EXPECT_EQ(state(e, "w3"), "duplicate of w2");
  EXPECT_EQ(state(e, "w4"), "pending");
  EXPECT_EQ(state(e, "w5"), "pending");
}

TEST(Accounts, OfEqualDuplicatesTheLowestIdStays) {
  const auto e = OsmText().square(7, 10, 0, 0, 10, kHouse).square(5, 20, 0, 0, 10, kHouse).read();
  EXPECT_EQ(state(e, "w5"), "pending");
  EXPECT_EQ(state(e, "w7"), "duplicate of w5");
}

TEST(Accounts, ABuildingRelationIsRepresentedByItsOutline) {
  const auto e =
      OsmText()
          .square(1, 10, 0, 0, 10, kHouse)
          .square(2, 20, 0, 0, 5, {{"building:part", "yes"}})
          .relation(1, {"w1 outline", "w2 part", "n10 entrance"}, {{"type", "building"}, {"building", "yes"}})
          .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "represented by w1");
  ASSERT_EQ(e.building_relations.size(), 1u);
  EXPECT_EQ(e.building_relations[0].outline.text(), "w1");
  ASSERT_EQ(e.building_relations[0].parts.size(), 1u);
  EXPECT_EQ(e.building_relations[0].parts[0].text(), "w2");
}

TEST(Accounts, ABuildingRelationWithoutOutlineIsRepresentedByItsParts) {
  const auto e = OsmText()
                     .square(2, 20, 0, 0, 5, {{"building:part", "yes"}})
                     .relation(1, {"w2 part"}, {{"type", "building"}, {"building", "yes"}})
                     .relation(2, {"w99 outline"}, {{"type", "building"}, {"building", "yes"}})
                     .relation(3, {}, {{"type", "building"}, {"building", "yes"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "represented by w2");
  EXPECT_EQ(state(e, "r2"), "OUTLINE_INCOMPLETE");
  EXPECT_EQ(state(e, "r3"), "RELATION_TYPE");
}

TEST(Accounts, ABuildingRelationWithoutRolesIsRepresentedByItsBuildings) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, kHouse)
                     .square(2, 20, 20, 0, 10, kHouse)
                     .relation(1, {"w2", "w1"}, {{"type", "building"}, {"building", "yes"}})
                     .relation(2, {"r1"}, {{"type", "building"}, {"building", "yes"}})
                     .relation(3, {"w2"}, {{"type", "building"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "represented by w1");
  EXPECT_EQ(state(e, "r2"), "represented by w1");
  ASSERT_EQ(e.building_relations.size(), 2u);
  EXPECT_EQ(e.building_relations.back().id.text(), "r3");
  EXPECT_EQ(e.building_relations.back().outline.text(), "w2");
}

TEST(Accounts, ABuildingRelationWhoseOutlineHasNoTagsIsTheBuilding) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10)
                     .square(2, 20, 0, 0, 5, {{"building:part", "yes"}})
                     .relation(1, {"w1 outline", "w2 part"}, {{"type", "building"}, {"building", "church"}})
                     .read();
  expect_books_balance(e);
  EXPECT_EQ(state(e, "r1"), "pending");
  EXPECT_EQ(building(e, "r1")->geometry_from.text(), "w1");
  EXPECT_EQ(e.building_relations.at(0).outline.text(), "r1");
}

TEST(Accounts, ABuildingRelationKnowsDuplicatesUnderTheirLivingName) {
  const auto e = OsmText()
                     .square(1, 10, 0, 0, 10, kHouse)
                     .square(2, 20, 2, 2, 5)
                     .relation(1, {"w1 outer", "w2 inner"}, {{"type", "multipolygon"}, {"building", "yes"}})
                     .relation(2, {"w1 outline"}, {{"type", "building"}})
                     .read();
  EXPECT_EQ(e.building_relations.at(0).outline.text(), "r1");
}

TEST(Accounts, TheClipBoxKeepsWhatIsCentredInside) {
  OsmText text;
  text.square(1, 10, 0, 0, 10, kHouse)                 // centre (5, 5)
      .square(2, 20, 8, 0, 10, kHouse)                 // centre (13, 5)
      .square(3, 30, 0, 0, 10, {{"building", "yes"}})  // duplicate of w1
      .node(1, 13.0005, 52.0005, kHouse)
      .way(4, {10, 11, 12, 99}, kHouse)                // reported, centre inside
      .way(5, {98, 99, 98}, kHouse)                    // nowhere
      .way(6, {10, 21}, {{"highway", "residential"}})  // touches
      .way(7, {21, 22}, {{"highway", "residential"}})  // does not
      .square(8, 40, 0, 3, 3, {{"building", "yes"}})   // inside, but for its multipolygon
      .square(9, 50, 60, 3, 3, {{"building", "yes"}})
      .relation(1, {"w8 outer", "w9 outer"}, {{"type", "multipolygon"}, {"building", "yes"}});
  ReadOptions options;
  options.bbox = {{13.0, 52.0, 13.0011, 52.0011}};
  const auto e = text.read(options);
  expect_books_balance(e);
  EXPECT_EQ(state(e, "w1"), "pending");
  EXPECT_EQ(state(e, "w2"), "absent");
  EXPECT_EQ(state(e, "w3"), "duplicate of w1");
  EXPECT_EQ(state(e, "n1"), "NODE_ONLY");
  EXPECT_EQ(state(e, "w4"), "OPEN_WAY");
  EXPECT_EQ(state(e, "w5"), "absent");
  EXPECT_NE(feature(e, "w6"), nullptr);
  EXPECT_EQ(feature(e, "w7"), nullptr);
  EXPECT_EQ(state(e, "r1"), "absent");
  EXPECT_EQ(state(e, "w8"), "duplicate of r1");
  EXPECT_EQ(state(e, "w9"), "absent");
  EXPECT_EQ(e.counts.buildings(), 5u);

  options.touching = true;
  const auto more = text.read(options);
  expect_books_balance(more);
  EXPECT_EQ(state(more, "w2"), "pending") << "two metres of it lie inside";
  EXPECT_EQ(state(more, "r1"), "pending") << "its middle lies outside";
  EXPECT_EQ(state(more, "w5"), "absent");
  EXPECT_EQ(more.counts.buildings(), 8u);
}

}  // namespace
}  // namespace blockrand::importers::osm::test
