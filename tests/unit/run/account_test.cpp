// The account closes: every object ends in a state, and what no stage decided on is named.
#include "pipeline/run/account.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  account.close({}, summary);
  EXPECT_THAT(summary.unaccounted, ElementsAre("w2"));
  EXPECT_EQ(summary.reported, 1u);
  EXPECT_EQ(summary.issues.at("UNACCOUNTED"), 1u);
  EXPECT_EQ(extract.buildings[1].code, IssueCode::unaccounted);
  EXPECT_EQ(summary.buildings_in, summary.models + summary.duplicates + summary.represented + summary.reported);
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
