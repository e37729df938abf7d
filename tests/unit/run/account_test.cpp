// The account closes: every object ends in a state, and what no stage decided on is named.
#include "pipeline/run/account.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/georef/tiles.h"

namespace blockrand::run {
namespace {

using model::IssueCode;
using model::ObjectState;
using testing::ElementsAre;

model::Extract three_houses() {
  model::Extract extract;
  for (const std::int64_t number : {1, 2, 3}) {
    model::MappedBuilding b;
    b.id = {model::OsmType::way, number};
    extract.buildings.push_back(b);
  }
  return extract;
}

TEST(Account, WhatNoStageDecidedOnIsReportedByName) {
  model::Extract extract = three_houses();
  Account account(extract, {});
  BuildSummary summary;
  Outcomes outcomes;
  outcomes.list.push_back({0, ObjectState::modelled, IssueCode::none, {}, 2});
  outcomes.list.push_back({2, ObjectState::duplicate, IssueCode::none, extract.buildings[0].id, -1});
  account.take(outcomes, {}, summary);
  account.close({}, {}, {}, summary);
  EXPECT_THAT(summary.unaccounted, ElementsAre("w2"));
  EXPECT_EQ(summary.reported, 1u);
  EXPECT_EQ(summary.issues.at("UNACCOUNTED"), 1u);
  EXPECT_EQ(extract.buildings[1].code, IssueCode::unaccounted);
  EXPECT_EQ(summary.buildings_in, summary.models + summary.duplicates + summary.represented + summary.reported);
}

/// Of a tile that is built alone: each object is told in one tile, whoever stands for it and wherever it lies.
TEST(Account, ObjectsOfATileThatIsBuiltAlone) {
  const model::Location here{134'000'000, 525'000'000}, elsewhere{135'000'000, 525'000'000};
  model::Extract extract;
  const auto add = [&](std::int64_t id, model::Location place, ObjectState state = ObjectState::pending,
                       std::int64_t related = 0) {
    model::MappedBuilding b;
    b.id = {model::OsmType::way, id};
    b.state = state;
    b.related = {model::OsmType::way, related};
    b.place = place;
    extract.buildings.push_back(b);
  };
  add(1, here);                               // built here,
  add(2, elsewhere);                          // with a part that lies elsewhere
  add(3, here);                               // with a house of the next tile
  add(4, here, ObjectState::represented, 3);  // by a building of the next tile: found before the tiles
  add(5, here, ObjectState::reported);        // found before the tiles
  add(6, here);                               // nobody's
  add(7, elsewhere, ObjectState::reported);
  add(8, here);       // covered by one of the next tile: found with its own tile
  add(9, elsewhere);  // nobody's there
  const std::vector<footprints::Shard> shards = {{georef::tile_of(here, 15), {{0, {1}}, {7, {}}}},
                                                 {georef::tile_of(elsewhere, 15), {{model::kNoIndex, {2}}}}};
  std::vector<model::ReportRow> rows;
  for (const std::int64_t id : {4, 7}) rows.push_back({{model::OsmType::way, id}, IssueCode::squared, ""});
  Account account(extract, rows);
  BuildSummary summary;
  Outcomes outcomes;
  outcomes.list = {{0, ObjectState::modelled, IssueCode::none, {}, 2},
                   {1, ObjectState::modelled, IssueCode::none, {}, 2},
                   {7, ObjectState::represented, IssueCode::none, extract.buildings[2].id, -1}};
  account.take(outcomes, {}, summary);
  TileChoice tile;
  tile.id = shards[0].tile;
  const std::vector<std::size_t> todo = {0};
  account.close(tile, shards, todo, summary);
  std::vector<std::int64_t> told;
  for (const model::MappedBuilding& b : extract.buildings) told.push_back(b.id.number);
  EXPECT_THAT(told, ElementsAre(1, 2, 4, 5, 6, 8));
  EXPECT_THAT(summary.unaccounted, ElementsAre("w6"));
  ASSERT_EQ(account.rows().size(), 1u);
  EXPECT_EQ(account.rows()[0].object.number, 4);
}

TEST(Account, PartsOfASettledHeadGoItsWay) {
  model::Region region;
  region.settled_parts.push_back({4, ObjectState::duplicate, {model::OsmType::way, 9}});
  const Outcomes outcomes = decide_outcomes(region, 2);
  ASSERT_EQ(outcomes.list.size(), 1u);
  EXPECT_EQ(outcomes.list[0].index, 4u);
  EXPECT_EQ(outcomes.list[0].state, ObjectState::duplicate);
  EXPECT_EQ(outcomes.list[0].related, (model::OsmId{model::OsmType::way, 9}));
  EXPECT_FALSE(outcomes.below_quality);
}

}  // namespace
}  // namespace blockrand::run
