#include "pipeline/run/estimate.h"

#include <gtest/gtest.h>

#include <array>

#include "pipeline/footprints/shard.h"

namespace blockrand::run {
namespace {

constexpr std::int32_t kLat = 520'000'000, kLon = 130'000'000;
constexpr double kAcross = 0.0111319 * 0.6156615, kUp = 0.0111319;  // m of 1e-7 degrees there

/// Houses on a rectangle of metres east and north of a place.
struct Town {
  model::Extract extract;

  model::MappedBuilding& house(double west, double south, double east, double north, float storeys = 0) {
    model::MappedBuilding b;
    b.id = {model::OsmType::way, static_cast<std::int64_t>(extract.buildings.size()) + 1};
    b.rings = {static_cast<std::uint32_t>(extract.rings.size()), 1};
    if (storeys > 0) b.attributes.storeys = storeys;
    extract.rings.push_back({{static_cast<std::uint32_t>(extract.vertices.size()), 4}, false});
    for (const auto& [x, y] : {std::pair{west, south}, {east, south}, {east, north}, {west, north}}) {
      extract.vertices.push_back(
          {kLon + static_cast<std::int32_t>(x / kAcross), kLat + static_cast<std::int32_t>(y / kUp)});
      extract.vertex_nodes.push_back(static_cast<std::int64_t>(extract.vertices.size()));
    }
    extract.buildings.push_back(b);
    return extract.buildings.back();
  }
  TownSize size() const {
    model::Report unused;
    return town_size(extract, footprints::make_shards(extract, unused));
  }
};

TEST(TownSize, WallsAreAsHighAsTheTaggedStoreys) {
  Town town;
  town.house(0, 0, 20, 10, 4);
  EXPECT_NEAR(town.size().all.walls, 60 * 4 * 3, 2);
  EXPECT_EQ(town.size().all.buildings, 1u);
  EXPECT_EQ(town.size().tiles, 1u);
}

TEST(TownSize, NothingIsSeenOfAWallAtANeighbour) {
  Town town;
  town.house(0, 0, 20, 10, 4);
  town.house(20.2, 0, 40, 10, 3);  // its own nodes: the wall is mapped twice, a hand apart
  EXPECT_NEAR(town.size().all.walls, (50 * 4 + 10 * 1) * 3 + (2 * 19.8 + 10) * 3 * 3, 5)
      << "of the higher house the uppermost storey looks over the lower one";
}

TEST(TownSize, OutbuildingsHaveNoWindows) {
  Town town;
  town.house(0, 0, 5, 5);
  EXPECT_EQ(town.size().all.walls, 0);
  EXPECT_EQ(town.size().all.buildings, 1u);
}

TEST(TownSize, UntaggedHousesAreAsHighAsMostTaggedOnes) {
  Town town;
  for (int i = 0; i < 30; ++i) town.house(100.0 * i, 0, 100.0 * i + 20, 10, 6);
  const double tagged = town.size().all.walls;
  town.house(0, 500, 20, 510);
  EXPECT_NEAR(town.size().all.walls - tagged, 60 * 6 * 3, 2);
}

TEST(Estimate, GrowsWithWhatIsAskedFor) {
  TownSize town;
  town.all = {10'000, 2'000'000};
  town.tile = {200, 60'000};
  town.tiles = 50;
  BuildOptions two, three;
  two.lod = 2;
  two.jobs = three.jobs = 2;
  const BuildEstimate roofs = estimate(town, two, 1, 100'000'000), facades = estimate(town, three, 1, 100'000'000);
  EXPECT_GT(facades.disk_bytes, 2 * roofs.disk_bytes);
  EXPECT_GT(facades.memory_bytes, roofs.memory_bytes);
  EXPECT_GT(facades.seconds, roofs.seconds);
  EXPECT_GT(roofs.memory_bytes, 100'000'000u);

  BuildOptions more = three;
  more.jobs = 8;
  EXPECT_GT(estimate(town, more, 1, 100'000'000).memory_bytes, facades.memory_bytes) << "tiles in flight";
  EXPECT_LT(estimate(town, more, 1, 100'000'000).seconds, facades.seconds);

  BuildOptions plain = two;
  plain.outputs.report = false;
  EXPECT_LT(estimate(town, plain, 1, 100'000'000).memory_bytes + 10'000'000, roofs.memory_bytes) << "its pictures";
  plain.outputs.formats = {"gltf"};
  EXPECT_LT(2 * disk_bytes(town.all, plain), roofs.disk_bytes);
}

TEST(Estimate, TakesWhatWasMeasuredOfFacades) {
  BuildOptions options;
  EXPECT_EQ(disk_bytes({0, 1000}, options, 500.0) - disk_bytes({0, 0}, options), 500'000u);
  options.lod = 2;
  EXPECT_EQ(disk_bytes({100, 1000}, options), disk_bytes({100, 0}, options)) << "without facades walls take nothing";
}

}  // namespace
}  // namespace blockrand::run
