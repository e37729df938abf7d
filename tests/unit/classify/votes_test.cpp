#include "styles/classify/votes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/error.h"

namespace blockrand::classify {
namespace {

using testing::HasSubstr;

VoteKernel plain() {
  VoteKernel k;
  k.reach = 100;
  k.distance = 50;
  k.area = 0.5;
  k.other_standing = 0.25;
  k.touching = 3;
  k.same_block = 1.5;
  k.same_street = 2;
  k.other_use = 0.125;
  k.prior = 0.5;
  return k;
}

/// Two voters at the same place of whom nothing is known.
struct Pair {
  Voter asker, asked;
  double weight(bool touches = false) const { return plain().weight(asker, asked, touches); }
};

TEST(Votes, ANeighbourOfWhomNothingIsKnownCountsOne) { EXPECT_DOUBLE_EQ(Pair().weight(), 1); }

TEST(Votes, FallWithDistanceUpToTheReach) {
  Pair p;
  p.asked.place = {30, 40};
  EXPECT_NEAR(p.weight(), std::exp(-1.0), 1e-12);
  p.asked.place = {60, 80};
  EXPECT_NEAR(p.weight(), std::exp(-2.0), 1e-12) << "the reach itself is within reach";
  p.asked.place = {60, 80.001};
  EXPECT_EQ(p.weight(), 0);
}

TEST(Votes, FallWithTheRatioOfFootprintsBothWays) {
  Pair p;
  p.asker.area = 100;
  p.asked.area = 400;
  EXPECT_NEAR(p.weight(), 0.5, 1e-12);
  std::swap(p.asker.area, p.asked.area);
  EXPECT_NEAR(p.weight(), 0.5, 1e-12);
  p.asker.area = 0;
  EXPECT_DOUBLE_EQ(p.weight(), 1) << "not known";
}

TEST(Votes, FrontAndBehindSpeakLessOfEachOther) {
  Pair p;
  p.asker.siting = Siting::front;
  EXPECT_DOUBLE_EQ(p.weight(), 1) << "not known";
  p.asked.siting = Siting::front;
  EXPECT_DOUBLE_EQ(p.weight(), 1);
  p.asked.siting = Siting::behind;
  EXPECT_DOUBLE_EQ(p.weight(), 0.25);
  using model::BuildingPosition;
  EXPECT_EQ(siting_of(BuildingPosition::unknown), Siting::unknown);
  for (const auto front : {BuildingPosition::free_standing, BuildingPosition::end_of_row, BuildingPosition::mid_row,
                           BuildingPosition::corner_house})
    EXPECT_EQ(siting_of(front), Siting::front);
  for (const auto behind : {BuildingPosition::rear_building, BuildingPosition::side_wing})
    EXPECT_EQ(siting_of(behind), Siting::behind);
}

TEST(Votes, ACommonWallTheBlockAndTheStreetCountMore) {
  Pair p;
  EXPECT_DOUBLE_EQ(p.weight(true), 3);
  p.asker.block = 7;
  EXPECT_DOUBLE_EQ(p.weight(), 1);
  p.asked.block = 7;
  EXPECT_DOUBLE_EQ(p.weight(), 1.5);
  p.asker.street = 5;
  EXPECT_DOUBLE_EQ(p.weight(), 1.5);
  p.asked.street = 5;
  EXPECT_DOUBLE_EQ(p.weight(), 3);
  EXPECT_DOUBLE_EQ(p.weight(true), 9) << "factors multiply";
  Pair nowhere;  // both on no street, in no block
  EXPECT_DOUBLE_EQ(nowhere.weight(), 1);
}

TEST(Votes, AnotherUseCountsLessWhereBothAreTold) {
  Pair p;
  p.asker.use = 1;
  EXPECT_DOUBLE_EQ(p.weight(), 1);
  p.asked.use = 9;
  EXPECT_DOUBLE_EQ(p.weight(), 0.125);
  p.asked.use = 1;
  EXPECT_DOUBLE_EQ(p.weight(), 1);
}

TEST(Votes, ThePosteriorIsADirichletMean) {
  const VoteKernel k = plain();
  const PerAnswer p = posterior({1.5, 0, 0.5}, {0.2, 0.7, 0.1}, k, 3);
  EXPECT_NEAR(p[0], (1.5 + 0.5 * 0.2) / 2.5, 1.0 / 65536);
  EXPECT_NEAR(p[1], 0.5 * 0.7 / 2.5, 1.0 / 65536);
  EXPECT_NEAR(p[2], (0.5 + 0.5 * 0.1) / 2.5, 1.0 / 65536);
  EXPECT_EQ(p[3], 0);
  const PerAnswer alone = posterior({}, {0.25, 0.75}, k, 2);
  EXPECT_DOUBLE_EQ(alone[0], 0.25) << "nobody votes: own evidence stands";
  EXPECT_DOUBLE_EQ(alone[1], 0.75);
}

TEST(Votes, AreReadFromATableAndRefuseWhatTheyDoNotKnow) {
  auto table = base::TomlTable::parse("reach = 80\nprior = 2.5\n", "neighbours.toml");
  const VoteKernel k = VoteKernel::read(table);
  EXPECT_EQ(k.reach, 80);
  EXPECT_EQ(k.prior, 2.5);
  EXPECT_EQ(k.touching, VoteKernel().touching) << "the default";
  const auto complaint = [](const char* text) -> std::string {
    auto wrong = base::TomlTable::parse(text, "neighbours.toml");
    try {
      VoteKernel::read(wrong);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "no complaint";
  };
  EXPECT_THAT(complaint("reach = 80\ntuoching = 3"),
              testing::AllOf(HasSubstr("neighbours.toml:2:"), HasSubstr("touching")));
  EXPECT_THAT(complaint("reach = 251"), HasSubstr("neighbours.toml:1:"));
  EXPECT_THAT(complaint("prior = 0"), HasSubstr("prior"));
}

}  // namespace
}  // namespace blockrand::classify
