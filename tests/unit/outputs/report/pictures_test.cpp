#include "pipeline/outputs/report/pictures.h"

#include <gtest/gtest.h>

#include "pipeline/georef/crs.h"
#include "tests/unit/outputs/sample_region.h"

namespace blockrand::outputs {
namespace {

using outputs::test::SampleRegion;

const georef::GeoBox kBox{13.3, 52.4, 13.5, 52.6};

georef::Projection projection() { return {georef::open_crs("EPSG:25833", kBox), kBox}; }

footprints::Shard shard(std::uint32_t x, std::uint32_t y, std::size_t seeds) {
  footprints::Shard s;
  s.tile = {15, 35200 + x, 25950 + y};
  s.seeds.resize(seeds);
  return s;
}

PicturePlan all_of(std::size_t shards) {
  PicturePlan plan;
  plan.chosen.assign(shards, true);
  plan.origin = {391000, 5819000, 0};
  return plan;
}

TEST(PicturePlan, SmallBuildsArePicturedWhole) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 10), shard(1, 0, 20), shard(4, 3, 5)};
  const PicturePlan plan = plan_pictures(shards, projection(), 100);
  EXPECT_TRUE(plan.whole);
  EXPECT_EQ(plan.buildings, 35u);
  EXPECT_EQ(plan.chosen, (std::vector<bool>{true, true, true}));
}

TEST(PicturePlan, LargeOnesShowTheDensestTileAndItsNeighbours) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 30), shard(1, 0, 30), shard(2, 0, 50), shard(3, 0, 20),
                                              shard(9, 9, 1)};
  const PicturePlan plan = plan_pictures(shards, projection(), 100);
  EXPECT_FALSE(plan.whole);
  // 50, then its two neighbours at the same distance; the far tile of one building would fit but stands apart.
  EXPECT_EQ(plan.chosen, (std::vector<bool>{false, true, true, true, false}));
  EXPECT_EQ(plan.buildings, 100u);
}

TEST(PicturePlan, ScatteredVillagesAreNotPicturedAsSpecks) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 10), shard(1, 0, 20), shard(40, 0, 5)};
  const PicturePlan plan = plan_pictures(shards, projection(), 100);
  EXPECT_EQ(plan.chosen, (std::vector<bool>{true, true, false}));
  EXPECT_FALSE(plan.whole);
}

TEST(PicturePlan, TheDensestTileIsShownWhateverTheBudget) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 3), shard(1, 0, 500)};
  const PicturePlan plan = plan_pictures(shards, projection(), 100);
  EXPECT_EQ(plan.chosen, (std::vector<bool>{false, true}));
}

TEST(PicturePlan, NoTileIsNoError) {
  const PicturePlan plan = plan_pictures({}, projection());
  Pictures pictures(plan);
  EXPECT_TRUE(pictures.take(2).empty());
  EXPECT_EQ(pictures.note(), "");
}

TEST(Pictures, AreThreeAndTheSameForAnyNumberOfThreads) {
  const SampleRegion town = SampleRegion::settlement(120, false);
  std::vector<outputs::ReportPicture> first;
  for (const int workers : {1, 3}) {
    const PicturePlan plan = all_of(1);
    Pictures pictures(plan);
    pictures.add(picture_tile(town.region(), plan, 0));
    const auto taken = pictures.take(workers);
    ASSERT_EQ(taken.size(), 3u);
    for (const outputs::ReportPicture& p : taken) {
      EXPECT_EQ(p.png.substr(1, 3), "PNG");
      EXPECT_GT(p.png.size(), 20'000u) << p.caption;  // an empty picture takes 5 kB
    }
    if (first.empty()) {
      first = taken;
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(taken[i].png, first[i].png) << i;
    EXPECT_TRUE(pictures.take(1).empty()) << "taken pictures are gone";
  }
}

TEST(Pictures, TilesThatAreNotChosenGiveNothing) {
  PicturePlan plan = all_of(2);
  plan.chosen[1] = plan.whole = false;
  plan.buildings = 1234;
  const SampleRegion zoo = SampleRegion::zoo();
  EXPECT_EQ(picture_tile(zoo.region(), plan, 1).scene.triangle_count(), 0u);
  const PictureTile tile = picture_tile(zoo.region(), plan, 0);
  EXPECT_GT(tile.scene.triangle_count(), 50u);
  EXPECT_EQ(tile.buildings.size(), 5u) << "not the one without solid, not the halo";
  EXPECT_NE(Pictures(plan).note().find("1,234"), std::string::npos);
}

TEST(Pictures, HillsHaveGroundUnderTheirHouses) {
  SampleRegion hill;
  for (int i = 0; i < 30; ++i) {
    model::Building& b = hill.add_building(100 + i, {});
    b.attributes.ground_height = {i * 3.0, model::Source::terrain, 1, 0};
    hill.add_box(b, b.id(), 391000 + i * 25.0, 5819000, 12, 10, i * 3.0, 8);
  }
  const PicturePlan plan = all_of(1);
  Pictures pictures(plan);
  pictures.add(picture_tile(hill.region(), plan, 0));
  EXPECT_EQ(pictures.take(2).size(), 3u);
}

}  // namespace
}  // namespace blockrand::outputs
