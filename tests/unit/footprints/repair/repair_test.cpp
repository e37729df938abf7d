#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/footprints/repair/clean_ring.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"
#include "tests/unit/footprints/repair/repair_alone.h"
#include "tests/unit/geometry/shapes.h"

namespace blockrand::repair {
namespace {

using model::IssueCode;
using model::Point2;
using testing_shapes::ring;

model::Building building(std::int64_t number, std::vector<Point2> outline) {
  model::Building b;
  b.osm = {model::OsmType::way, number};
  b.mapped_index = static_cast<std::uint32_t>(number);
  b.rings.rings = {ring(std::move(outline))};
  b.rings.inner = {false};
  return b;
}

void add_part(model::Building& b, std::int64_t number, std::vector<Point2> outline) {
  model::BuildingPart p;
  p.osm = {model::OsmType::way, number};
  p.mapped_index = static_cast<std::uint32_t>(number);
  p.id = b.id() + "." + p.osm.text();
  p.rings.rings = {ring(std::move(outline))};
  p.rings.inner = {false};
  b.parts.push_back(std::move(p));
  b.has_mapped_parts = true;
}

model::Region region_of(std::vector<model::Building> buildings) {
  model::Region r;
  r.buildings = std::move(buildings);
  test::repair_alone(r);
  return r;
}

int count(const model::Region& r, IssueCode code) {
  return static_cast<int>(
      std::count_if(r.report.rows.begin(), r.report.rows.end(), [&](const auto& row) { return row.code == code; }));
}

std::vector<std::string> ids(const model::Building& b) {
  std::vector<std::string> out;
  for (const auto& p : b.parts) out.push_back(p.id);
  return out;
}

TEST(CleanRing, RepeatedPointsAndSpikesGo) {
  auto r = ring({{0, 0}, {0, 0.001}, {10, 0}, {10, 8}, {4, 8}, {4, 20}, {4.01, 8}, {0, 8}});
  const RingCleaning done = clean_ring(r, {}, {});
  EXPECT_EQ(done.duplicates, 1);
  EXPECT_GE(done.spikes, 1);
  EXPECT_NEAR(geometry::signed_area(r.points), 80, 0.1);
}

TEST(CleanRing, AThinButRealStripStays) {
  auto r = ring({{0, 0}, {20, 0}, {20, 0.3}, {0, 0.3}});
  EXPECT_EQ(clean_ring(r, {}, {}).spikes, 0);
  EXPECT_EQ(r.size(), 4u);
}

TEST(CleanRing, ALineVanishes) {
  auto r = ring({{0, 0}, {5, 0}, {10, 0}, {5, 0}});
  clean_ring(r, {}, {});
  EXPECT_LT(r.size(), 3u);
}

TEST(CleanRing, EveryPointAtOnePlace) {
  auto r = ring({{3, 3}, {3, 3}, {3, 3}, {3, 3}});
  clean_ring(r, {}, {});
  EXPECT_LT(r.size(), 3u);
}

TEST(Repair, WrongOrientationIsTurnedWithoutARow) {
  const auto r = region_of({building(1, {{0, 0}, {0, 8}, {10, 8}, {10, 0}})});
  ASSERT_EQ(r.buildings[0].outline.size(), 1u);
  EXPECT_GT(geometry::signed_area(r.buildings[0].outline[0].outer.points), 0);
  EXPECT_TRUE(r.report.rows.empty());
  EXPECT_EQ(ids(r.buildings[0]), std::vector<std::string>{"w1"});
}

TEST(Repair, BowTieIsTwoPiecesOfOneBuilding) {
  const auto r = region_of({building(1, {{0, 0}, {10, 8}, {10, 0}, {0, 8}})});
  EXPECT_EQ(ids(r.buildings[0]), (std::vector<std::string>{"w1.1", "w1.2"}));
  EXPECT_EQ(count(r, IssueCode::ring_repaired), 1);
  EXPECT_EQ(count(r, IssueCode::split_outline), 1);
}

TEST(Repair, NothingToBuildIsAReasonNotACrash) {
  auto r = region_of(
      {building(1, {{0, 0}, {5, 0}, {5, 0.0005}}), building(2, {}), building(3, {{0, 0}, {9, 0}, {3, 0}, {6, 0}})});
  for (const auto& b : r.buildings) {
    EXPECT_TRUE(b.parts.empty());
    EXPECT_NE(b.failure, IssueCode::none);
  }
}

TEST(Repair, HoleWithoutAnOuterRingIsNoBuilding) {
  auto b = building(1, {{0, 0}, {5, 0}});
  b.rings.rings.push_back(ring({{0, 0}, {0, 4}, {4, 4}}));
  b.rings.inner.push_back(true);
  const auto r = region_of({b});
  EXPECT_TRUE(r.buildings[0].outline.empty());
}

TEST(OutlineAndParts, PartsThatCoverTheOutlineReplaceIt) {
  auto b = building(1, {{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  add_part(b, 2, {{0, 0}, {8, 0}, {8, 10}, {0, 10}});
  add_part(b, 3, {{8, 0}, {20, 0}, {20, 10}, {8, 10}});
  const auto r = region_of({b});
  EXPECT_EQ(ids(r.buildings[0]), (std::vector<std::string>{"w1.w2", "w1.w3"}));
  EXPECT_EQ(count(r, IssueCode::parts_incomplete), 0);
}

TEST(OutlineAndParts, ATowerAloneDoesNotSwallowTheChurch) {
  // OSM2World issue 244: with one part mapped, only the tower was drawn.
  auto b = building(1, {{0, 0}, {30, 0}, {30, 12}, {0, 12}});
  add_part(b, 2, {{0, 3}, {6, 3}, {6, 9}, {0, 9}});
  const auto r = region_of({b});
  ASSERT_EQ(ids(r.buildings[0]), (std::vector<std::string>{"w1.w2", "w1.rest"}));
  EXPECT_NEAR(geometry::area(r.buildings[0].parts[1].plan), 360 - 36, 0.01);
  EXPECT_TRUE(r.buildings[0].parts[1].rest);
  EXPECT_EQ(r.buildings[0].parts[1].mapped_index, 1u);
  EXPECT_EQ(count(r, IssueCode::parts_incomplete), 1);
}

TEST(OutlineAndParts, ASlitBetweenPartsIsDrawingTolerance) {
  auto b = building(1, {{0, 0}, {20, 0}, {20, 40}, {0, 40}});
  add_part(b, 2, {{0, 0}, {9.8, 0}, {9.8, 40}, {0, 40}});
  add_part(b, 3, {{10.2, 0}, {20, 0}, {20, 40}, {10.2, 40}});
  const auto r = region_of({b});
  EXPECT_EQ(r.buildings[0].parts.size(), 2u) << "16 m2 of 0.4 m are no building";
}

TEST(OutlineAndParts, BrokenPartsFallBackToTheOutline) {
  auto b = building(1, {{0, 0}, {20, 0}, {20, 10}, {0, 10}});
  add_part(b, 2, {{0, 0}, {8, 0}});
  const auto r = region_of({b});
  EXPECT_EQ(ids(r.buildings[0]), std::vector<std::string>{"w1"});
  ASSERT_EQ(r.part_failures.size(), 1u);
  EXPECT_EQ(r.part_failures[0].mapped_index, 2u);
}

TEST(Repair, AreaIsKeptWhereTheRingWasSound) {
  testing_shapes::Random random(3);
  for (int round = 0; round < 100; ++round) {
    const double w = 5 + 20 * random.unit(), d = 5 + 20 * random.unit();
    const auto plan = testing_shapes::turned(
        testing_shapes::polygon({{0, 0}, {w, 0}, {w, d}, {w / 2, d}, {w / 2, d / 2}, {0, d / 2}}));
    const double before = geometry::area(plan);
    const auto r = region_of({building(1, plan.outer.points)});
    EXPECT_DOUBLE_EQ(geometry::area(r.buildings[0].outline[0]), before);
  }
}

}  // namespace
}  // namespace blockrand::repair
