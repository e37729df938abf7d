#include "pipeline/outputs/report/pictures.h"

#include <gtest/gtest.h>

#include "pipeline/georef/crs.h"
#include "tests/unit/outputs/facade_region.h"
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

footprints::RepairedExtract without_outlines(std::span<const footprints::Shard> shards) {
  footprints::RepairedExtract repaired;
  std::uint32_t buildings = 0;
  for (const footprints::Shard& s : shards) {
    repaired.first.push_back(buildings);
    buildings += static_cast<std::uint32_t>(s.seeds.size());
  }
  repaired.footprints = footprints::FootprintStore(buildings);
  return repaired;
}

PicturePlan all_of(std::size_t shards) {
  PicturePlan plan;
  plan.chosen.assign(shards, true);
  plan.near_spot.assign(shards, false);
  plan.origin = {391000, 5819000, 0};
  return plan;
}

TEST(PicturePlan, SmallBuildsArePicturedWhole) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 10), shard(1, 0, 20), shard(4, 3, 5)};
  const PicturePlan plan = plan_pictures(shards, without_outlines(shards), projection(), 100);
  EXPECT_TRUE(plan.whole);
  EXPECT_EQ(plan.buildings, 35u);
  EXPECT_EQ(plan.chosen, (std::vector<bool>{true, true, true}));
}

TEST(PicturePlan, LargeOnesShowTheDensestTileAndItsNeighbours) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 30), shard(1, 0, 30), shard(2, 0, 50), shard(3, 0, 20),
                                              shard(9, 9, 1)};
  const PicturePlan plan = plan_pictures(shards, without_outlines(shards), projection(), 100);
  EXPECT_FALSE(plan.whole);
  // 50, then its two neighbours at the same distance; the far tile of one building would fit but stands apart.
  EXPECT_EQ(plan.chosen, (std::vector<bool>{false, true, true, true, false}));
  EXPECT_EQ(plan.buildings, 100u);
}

TEST(PicturePlan, ScatteredVillagesAreNotPicturedAsSpecks) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 10), shard(1, 0, 20), shard(40, 0, 5)};
  const PicturePlan plan = plan_pictures(shards, without_outlines(shards), projection(), 100);
  EXPECT_EQ(plan.chosen, (std::vector<bool>{true, true, false}));
  EXPECT_FALSE(plan.whole);
}

TEST(PicturePlan, TheDensestTileIsShownWhateverTheBudget) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 3), shard(1, 0, 500)};
  const PicturePlan plan = plan_pictures(shards, without_outlines(shards), projection(), 100);
  EXPECT_EQ(plan.chosen, (std::vector<bool>{false, true}));
}

TEST(PicturePlan, DetailIsWhereHousesStandDensest) {
  const std::vector<footprints::Shard> shards{shard(0, 0, 2), shard(1, 0, 12)};
  footprints::RepairedExtract repaired = without_outlines(shards);
  const auto house = [&](std::uint32_t number, double x, double y, double size) {
    model::Polygon p;
    p.outer.points = {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
    p.outer.nodes.assign(4, 0);
    repaired.footprints.set(number, {}, std::array{p});
  };
  house(0, 391000, 5819000, 12);
  house(1, 391020, 5819000, 12);
  for (std::uint32_t i = 0; i < 8; ++i) house(2 + i, 391400, 5819000 + 4 * i, 3);       // sheds are no houses
  for (std::uint32_t i = 0; i < 4; ++i) house(10 + i, 391700 + 15.0 * i, 5819000, 12);  // the densest
  const PicturePlan plan = plan_pictures(shards, repaired, projection(), 100);
  EXPECT_NEAR(plan.spot.x, 391725, 50);
  EXPECT_NEAR(plan.spot.y, 5819000, 50);
  EXPECT_EQ(plan.near_spot, (std::vector<bool>{false, true}));
}

TEST(PicturePlan, NoTileIsNoError) {
  const PicturePlan plan = plan_pictures({}, footprints::RepairedExtract(), projection());
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
    pictures.add(pack_picture(picture_tile(town.region(), plan, 0), false));
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

TEST(Pictures, AreFoundAgainByTheHashesOfTheirTiles) {
  const SampleRegion town = SampleRegion::settlement(60, false), other = SampleRegion::settlement(61, false);
  const PicturePlan plan = all_of(1);
  std::map<std::string, std::string> kept;
  int found = 0;
  base::Memo memo;
  memo.find = [&](std::string_view, const std::string& key) -> std::optional<std::string> {
    const auto entry = kept.find(key);
    if (entry == kept.end()) return std::nullopt;
    ++found;
    return entry->second;
  };
  memo.keep = [&](std::string_view, const std::string& key, std::string_view bytes) { kept[key] = std::string(bytes); };
  const auto taken = [&](const SampleRegion& region) {
    Pictures pictures(plan);
    pictures.add(pack_picture(picture_tile(region.region(), plan, 0), true));
    return pictures.take(2, &memo).front().png;
  };
  const std::string first = taken(town);
  EXPECT_EQ(taken(town), first);
  EXPECT_EQ(found, 1);
  EXPECT_NE(taken(other), first);
  EXPECT_EQ(found, 1);
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

TEST(Pictures, ShowWindowsAndNearTheSpotEveryElement) {
  const SampleRegion town = test::facade_region();
  PicturePlan plan = all_of(1);
  plan.spot = {391020, 5819020};
  PictureTile afar = picture_tile(town.region(), plan, 0);
  EXPECT_EQ(afar.detail.triangle_count(), 0u);
  plan.near_spot[0] = true;
  const PictureTile tile = picture_tile(town.region(), plan, 0);
  ASSERT_EQ(tile.buildings.size(), 4u);
  EXPECT_TRUE(tile.buildings[0].detailed);
  EXPECT_FALSE(tile.buildings[3].detailed) << "it has no LoD3";
  // A pane with five corners lies flat on its wall; near by its frame, its sill and its reveal are there as well.
  const auto pane = [](const picture::Scene& scene) {
    std::size_t panes = 0;
    for (const picture::Scene::Triangle& t : scene.triangles()) {
      const picture::Scene::Face& face = scene.faces()[t.face];
      if (face.colour.b == 90 && face.colour.g == 30 && face.closed) ++panes;
    }
    return panes;
  };
  std::size_t windows = 0;
  for (const model::Building& b : town.region().buildings)
    for (const model::BuildingPart& part : b.parts)
      for (const model::Opening& o : part.lod3.openings) windows += o.kind == model::OpeningKind::window;
  EXPECT_GT(windows, 100u);
  EXPECT_EQ(pane(tile.flat), 3 * windows);
  EXPECT_GE(pane(tile.detail), 3 * windows);
  EXPECT_GT(tile.detail.triangle_count(), 2 * tile.flat.triangle_count());

  Pictures with(plan);
  with.add(pack_picture(picture_tile(town.region(), plan, 0), false));
  Pictures without(plan);
  without.add(pack_picture(std::move(afar), false));
  const auto near = with.take(2), far = without.take(2);
  ASSERT_EQ(near.size(), 3u);
  EXPECT_EQ(near[0].png, far[0].png);
  EXPECT_NE(near[2].png, far[2].png);
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
  pictures.add(pack_picture(picture_tile(hill.region(), plan, 0), false));
  EXPECT_EQ(pictures.take(2).size(), 3u);
}

}  // namespace
}  // namespace blockrand::outputs
