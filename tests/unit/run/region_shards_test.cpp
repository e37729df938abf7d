#include "pipeline/run/region_shards.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/base/error.h"

namespace blockrand::run {
namespace {

TEST(Shard, IsReadAsNumberAndCount) {
  EXPECT_EQ(parse_shard("2/8").number, 2);
  EXPECT_EQ(parse_shard("2/8").of, 8);
  EXPECT_EQ(parse_shard("1/1").of, 1);
  for (const char* bad : {"", "/", "1", "1/", "/2", "0/2", "3/2", "-1/2", "1/2/3", "a/b", " 1/2", "1/20000"})
    EXPECT_THROW(parse_shard(bad), base::UsageError) << bad;
}

std::vector<double> sums_of(const std::vector<PlannedArea>& areas, int shards) {
  std::vector<double> sums(static_cast<std::size_t>(shards));
  for (const PlannedArea& area : areas) {
    EXPECT_GE(area.shard, 1);
    EXPECT_LE(area.shard, shards);
    sums.at(static_cast<std::size_t>(area.shard) - 1) += area.cpu_seconds;
  }
  return sums;
}

TEST(Balance, NoShardHasMuchMoreThanAnother) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    std::vector<PlannedArea> areas(40);
    for (std::size_t i = 0; i < areas.size(); ++i)
      areas[i].cpu_seconds = 1 + static_cast<double>((seed * 7919 + i * i * 104729) % 1000) / 10;
    const int shards = 2 + static_cast<int>(seed % 7);
    balance(areas, shards);
    const std::vector<double> sums = sums_of(areas, shards);
    // Graham 1969, of any order: shards end within one area of each other.
    const double longest = std::ranges::max(areas, {}, &PlannedArea::cpu_seconds).cpu_seconds;
    EXPECT_LE(std::ranges::max(sums) - std::ranges::min(sums), longest);
  }
}

TEST(Balance, TheLongestComeFirst) {
  std::vector<PlannedArea> areas(5);
  for (PlannedArea& area : areas) area.cpu_seconds = 1;
  areas.back().cpu_seconds = 4;  // in the order in which they come shards would have 6 and 2
  balance(areas, 2);
  EXPECT_EQ(sums_of(areas, 2), (std::vector<double>{4, 4}));
}

TEST(Balance, FewerAreasThanShardsLeaveShardsEmpty) {
  std::vector<PlannedArea> areas(2);
  areas[0].cpu_seconds = 1, areas[1].cpu_seconds = 2;
  balance(areas, 5);
  EXPECT_NE(areas[0].shard, areas[1].shard);
  EXPECT_EQ(areas[1].shard, 1);
  std::vector<PlannedArea> none;
  balance(none, 3);
}

}  // namespace
}  // namespace blockrand::run
