// Which areas a store is cut into.
#include "pipeline/run/area_survey.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "pipeline/georef/tiles.h"
#include "pipeline/run/tile_choice.h"

namespace blockrand::run {
namespace {

TEST(AreasOf, DenseOnesAreCutInFourUntilTheyAreSmall) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "area_survey_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::string text = "<osm version=\"0.6\">\n";
  int id = 0;
  const auto house = [&](double lon, double lat) {
    for (int k = 0; k < 4; ++k)
      text += "<node id=\"" + std::to_string(10 * id + k + 1) + "\" version=\"1\" lon=\"" +
              std::to_string(lon + 1e-4 * (k % 2)) + "\" lat=\"" + std::to_string(lat + 1e-4 * (k / 2)) + "\"/>\n";
    ++id;
  };
  std::vector<std::pair<double, double>> houses;
  for (int i = 0; i < 200; ++i) houses.emplace_back(13.40 + 1e-4 * (i % 20), 52.50 + 1e-4 * (i / 20));  // a town
  for (int i = 0; i < 9; ++i) houses.emplace_back(13.0 + 0.1 * i, 52.1);
  for (const auto& [lon, lat] : houses) house(lon, lat);
  for (int w = 0; w < id; ++w) {
    text += "<way id=\"" + std::to_string(w + 1) + "\" version=\"1\">";
    for (const int k : {1, 2, 4, 3, 1}) text += "<nd ref=\"" + std::to_string(10 * w + k) + "\"/>";
    text += "<tag k=\"building\" v=\"yes\"/></way>\n";
  }
  std::ofstream(folder / "town.osm") << text << "</osm>\n";
  ASSERT_TRUE(importers::osm::write_store((folder / "town.osm").string(), (folder / "store").string()));
  const importers::osm::ExtractStore store((folder / "store").string());
  const auto whole = areas_of(store, 10);
  EXPECT_EQ(whole.size(), store.areas(10).size());
  constexpr std::uint64_t kMost = 5000;
  std::set<int> levels;
  const auto parts = areas_of(store, 10, kMost);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    levels.insert(parts[i].tile.level);
    const georef::GeoBox w = georef::with_halo(parts[i].tile, kHalo);
    EXPECT_TRUE(parts[i].tile.level == kFinestAreas || store.part({w.west, w.south, w.east, w.north}).bytes <= kMost);
    EXPECT_TRUE(i == 0 || parts[i - 1].tile < parts[i].tile);
  }
  EXPECT_TRUE(levels.contains(10));
  EXPECT_TRUE(levels.contains(kFinestAreas)) << "what is around a town is no less in a quarter";
  // Each house lies in one of them, and in no two.
  for (const auto& [lon, lat] : houses) {
    const model::TileId tile = georef::tile_of(
        model::Location{static_cast<std::int32_t>(lon * 1e7), static_cast<std::int32_t>(lat * 1e7)}, 15);
    EXPECT_EQ(std::ranges::count_if(parts, [&](const auto& area) { return georef::contains(area.tile, tile); }), 1);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace blockrand::run
