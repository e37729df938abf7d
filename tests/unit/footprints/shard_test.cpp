#include "pipeline/footprints/shard.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace blockrand::footprints {
namespace {

using model::Extract;
using model::IssueCode;
using model::Location;
using model::ObjectKind;
using model::OsmId;
using model::OsmType;

/// Units of 1e-7 degrees around a place in the middle of a tile.
constexpr std::int32_t kX = 110'300'000, kY = 514'700'000;

std::uint32_t add(Extract& e, std::int64_t number, ObjectKind kind, std::vector<Location> outline) {
  model::MappedBuilding b;
  b.id = {OsmType::way, number};
  b.kind = kind;
  b.rings = {static_cast<std::uint32_t>(e.rings.size()), 1};
  e.rings.push_back(
      {{static_cast<std::uint32_t>(e.vertices.size()), static_cast<std::uint32_t>(outline.size())}, false});
  for (const Location v : outline) {
    e.vertices.push_back(v);
    e.vertex_nodes.push_back(static_cast<std::int64_t>(e.vertex_nodes.size()) + 1);
  }
  e.buildings.push_back(b);
  return static_cast<std::uint32_t>(e.buildings.size() - 1);
}

std::vector<Location> square(std::int32_t x, std::int32_t y, std::int32_t side) {
  return {{kX + x, kY + y}, {kX + x + side, kY + y}, {kX + x + side, kY + y + side}, {kX + x, kY + y + side}};
}

const Seed* seed_of(const std::vector<Shard>& shards, std::uint32_t lead) {
  for (const Shard& s : shards)
    for (const Seed& seed : s.seeds)
      if (seed.lead() == lead) return &seed;
  return nullptr;
}

TEST(Shards, PartsGoToTheSmallestOutlineThatHoldsThem) {
  Extract e;
  const auto big = add(e, 1, ObjectKind::building, square(0, 0, 10000));
  const auto small = add(e, 2, ObjectKind::building, square(1000, 1000, 3000));
  const auto part = add(e, 3, ObjectKind::building_part, square(1500, 1500, 500));
  const auto other = add(e, 4, ObjectKind::building_part, square(6000, 6000, 500));
  model::Report report;
  const auto shards = make_shards(e, report);
  EXPECT_EQ(seed_of(shards, small)->parts, std::vector<std::uint32_t>{part});
  EXPECT_EQ(seed_of(shards, big)->parts, std::vector<std::uint32_t>{other});
  EXPECT_TRUE(report.rows.empty());
}

TEST(Shards, APartOnTheOutlinesEdgeAndAlittleBeyondBelongsToIt) {
  Extract e;
  const auto outline = add(e, 1, ObjectKind::building, square(0, 0, 1000));
  const auto part =
      add(e, 2, ObjectKind::building_part, {{kX, kY}, {kX + 1003, kY - 2}, {kX + 1000, kY + 1000}, {kX, kY + 1000}});
  model::Report report;
  EXPECT_EQ(seed_of(make_shards(e, report), outline)->parts, std::vector<std::uint32_t>{part});
}

TEST(Shards, ARelationsWordBeatsGeometry) {
  Extract e;
  const auto named = add(e, 1, ObjectKind::building, square(0, 0, 1000));
  add(e, 2, ObjectKind::building, square(400, 0, 600));
  const auto part = add(e, 3, ObjectKind::building_part, square(500, 200, 300));
  const auto bridge = add(e, 4, ObjectKind::building_part, square(5000, 200, 300));
  e.building_relations.push_back({{OsmType::relation, 9}, {OsmType::way, 1}, {{OsmType::way, 3}, {OsmType::way, 4}}});
  model::Report report;
  EXPECT_EQ(seed_of(make_shards(e, report), named)->parts, (std::vector<std::uint32_t>{part, bridge}));
  EXPECT_TRUE(report.rows.empty());
}

TEST(Shards, RelationsThatMixUpNeighboursAreNotBelieved) {
  Extract e;
  const auto left = add(e, 1, ObjectKind::building, square(0, 0, 1000));
  const auto right = add(e, 2, ObjectKind::building, square(1000, 0, 1000));
  const auto in_left = add(e, 3, ObjectKind::building_part, square(500, 0, 500));
  const auto in_right = add(e, 4, ObjectKind::building_part, square(1000, 0, 500));
  e.building_relations.push_back({{OsmType::relation, 8}, {OsmType::way, 1}, {{OsmType::way, 4}}});
  e.building_relations.push_back({{OsmType::relation, 9}, {OsmType::way, 2}, {{OsmType::way, 3}}});
  // A part shares two of its four corners with the other outline: move them off it.
  for (const auto part : {in_left, in_right})
    for (std::uint32_t i = 0; i < 4; ++i) {
      auto& v = e.vertices[e.rings[e.buildings[part].rings.first].vertices.first + i];
      if (v.lon == kX + 1000) v.lon += part == in_left ? -1 : 1;
    }
  model::Report report;
  const auto shards = make_shards(e, report);
  EXPECT_EQ(seed_of(shards, left)->parts, std::vector<std::uint32_t>{in_left});
  EXPECT_EQ(seed_of(shards, right)->parts, std::vector<std::uint32_t>{in_right});
  ASSERT_EQ(report.rows.size(), 2u);
  EXPECT_EQ(report.rows[0].code, IssueCode::parts_outside);
  EXPECT_EQ(report.rows[0].detail, "in w1, not in w2 as its relation says");
}

TEST(Shards, APartInNoOutlineStandsAloneAndIsReported) {
  Extract e;
  const auto part = add(e, 3, ObjectKind::building_part, square(0, 0, 300));
  model::Report report;
  const auto shards = make_shards(e, report);
  ASSERT_NE(seed_of(shards, part), nullptr);
  EXPECT_EQ(seed_of(shards, part)->outline, model::kNoIndex);
  ASSERT_EQ(report.rows.size(), 1u);
  EXPECT_EQ(report.rows[0].code, IssueCode::part_without_outline);
}

TEST(Shards, PartsWithoutOutlineThatShareEdgesAreOneBuilding) {
  Extract e;
  const auto first = add(e, 3, ObjectKind::building_part, square(0, 0, 300));
  const auto far = add(e, 4, ObjectKind::building_part, square(5000, 0, 300));
  const auto second = add(e, 5, ObjectKind::building_part, square(300, 0, 300));
  const auto third = add(e, 6, ObjectKind::building_part, square(600, 0, 300));
  const auto at_corner = add(e, 7, ObjectKind::building_part, square(900, 300, 300));
  // Squares run from their lower left corner counter-clockwise: what is right of one is left of the next.
  const auto join = [&](std::uint32_t left, std::uint32_t right) {
    const auto l = e.rings[e.buildings[left].rings.first].vertices.first,
               r = e.rings[e.buildings[right].rings.first].vertices.first;
    e.vertex_nodes[r] = e.vertex_nodes[l + 1];
    e.vertex_nodes[r + 3] = e.vertex_nodes[l + 2];
  };
  join(first, second);
  join(second, third);
  const auto c = e.rings[e.buildings[at_corner].rings.first].vertices.first,
             t = e.rings[e.buildings[third].rings.first].vertices.first;
  e.vertex_nodes[c] = e.vertex_nodes[t + 2];  // one common node is no common wall
  model::Report report;
  const auto shards = make_shards(e, report);
  ASSERT_NE(seed_of(shards, first), nullptr);
  EXPECT_EQ(seed_of(shards, first)->outline, model::kNoIndex);
  EXPECT_EQ(seed_of(shards, first)->parts, (std::vector<std::uint32_t>{first, second, third}));
  EXPECT_EQ(seed_of(shards, far)->parts, std::vector<std::uint32_t>{far});
  EXPECT_EQ(seed_of(shards, at_corner)->parts, std::vector<std::uint32_t>{at_corner});
  EXPECT_EQ(seed_of(shards, second), nullptr);
  ASSERT_EQ(report.rows.size(), 5u);
  std::sort(report.rows.begin(), report.rows.end());
  EXPECT_EQ(report.rows[0].detail, "built together with 2 other parts");
  EXPECT_EQ(report.rows[1].detail, "");
  EXPECT_EQ(report.rows[2].detail, "built together with w3");
}

TEST(Shards, TheTileIsThatOfTheBoxCentreAndEveryBuildingHasOne) {
  Extract e;
  // A long building whose first corner lies two tiles west of its centre.
  add(e, 1, ObjectKind::building,
      {{kX - 100'000, kY}, {kX + 110'000, kY}, {kX + 110'000, kY + 500}, {kX - 100'000, kY + 500}});
  add(e, 2, ObjectKind::building, square(5'000, 0, 300));
  model::Report report;
  const auto shards = make_shards(e, report);
  ASSERT_EQ(shards.size(), 1u);
  EXPECT_EQ(shards[0].seeds.size(), 2u);
}

TEST(Shards, AcrossTheAntimeridianTheCentreLiesThere) {
  Extract e;
  constexpr std::int32_t kEdge = 1'799'990'000;
  const auto b = add(e, 1, ObjectKind::building, {{kEdge, 0}, {-kEdge, 0}, {-kEdge, 5000}, {kEdge, 5000}});
  const Location c = box_centre(e, e.buildings[b]);
  EXPECT_EQ(std::abs(c.lon), 1'800'000'000);
  model::Report report;
  EXPECT_EQ(make_shards(e, report).size(), 1u);
}

TEST(Shards, ObjectsThatAreNotPendingAreLeftOut) {
  Extract e;
  const auto b = add(e, 1, ObjectKind::building, square(0, 0, 1000));
  e.buildings[b].state = model::ObjectState::duplicate;
  const auto r = add(e, 2, ObjectKind::building, square(0, 0, 1000));
  e.buildings[r].state = model::ObjectState::reported;
  model::Report report;
  EXPECT_TRUE(make_shards(e, report).empty());
}

}  // namespace
}  // namespace blockrand::footprints
