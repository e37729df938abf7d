#include "pipeline/outputs/tileset/tileset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

namespace blockrand::outputs {
namespace {

using nlohmann::json;

TileEntry tile(std::uint32_t x, std::uint32_t y) {
  constexpr double kSize = 180.0 / 32768;
  TileEntry t;
  t.id = {15, x, y};
  t.uri = "tiles/15/" + std::to_string(x) + "/" + std::to_string(y) + ".glb";
  t.enu_to_ecef = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1e6, 2e6, 3e6, 1};
  t.min = {-200, -150, 0};
  t.max = {210, 160, 25.5};
  t.west = x * kSize - 180;
  t.east = t.west + kSize;
  t.south = y * kSize - 90;
  t.north = t.south + kSize;
  t.min_height = 0;
  t.max_height = 25.5;
  return t;
}

struct Walk {
  std::set<std::string> uris;
  int inner = 0;
  void visit(const json& node, const json* parent) {
    if (parent) {
      EXPECT_LE(node["geometricError"].get<double>(), (*parent)["geometricError"].get<double>());
    }
    if (node.contains("content")) {
      EXPECT_FALSE(node.contains("children"));
      EXPECT_EQ(node["geometricError"], 0);
      EXPECT_TRUE(node["boundingVolume"].contains("box"));
      EXPECT_EQ(node["transform"].size(), 16u);
      EXPECT_TRUE(uris.insert(node["content"]["uri"]).second);
      return;
    }
    ++inner;
    if (parent) {
      EXPECT_GE(node["children"].size(), 2u) << "a chain that should have been collapsed";
      for (int i : {0, 1}) {
        EXPECT_GE(node["boundingVolume"]["region"][i], (*parent)["boundingVolume"]["region"][i]);
        EXPECT_LE(node["boundingVolume"]["region"][i + 2], (*parent)["boundingVolume"]["region"][i + 2]);
      }
    }
    for (const json& child : node["children"]) visit(child, &node);
  }
};

TEST(Tileset, CoarserLevelsAreReplacedByFinerOnes) {
  TileEntry t = tile(17604, 12942);
  t.coarser = {{"tiles/15/17604/12942_lod1.glb", 3 * kRoofError}, {"tiles/15/17604/12942_lod2.glb", kRoofError}};
  const json document = json::parse(write_tileset(std::vector{t, tile(17605, 12942)}, {}));
  const json* level = nullptr;
  for (const json& child : document["root"]["children"])
    if (child.contains("children")) level = &child;
  ASSERT_NE(level, nullptr);
  const json volume = (*level)["boundingVolume"];
  EXPECT_TRUE(level->contains("transform"));
  std::vector<std::string> uris;
  double error = document["root"]["geometricError"];
  for (;;) {
    uris.push_back((*level)["content"]["uri"]);
    EXPECT_LT((*level)["geometricError"].get<double>(), error);
    error = (*level)["geometricError"];
    EXPECT_EQ((*level)["boundingVolume"], volume) << "of all levels";
    if (!level->contains("children")) break;
    EXPECT_EQ((*level)["refine"], "REPLACE");
    ASSERT_EQ((*level)["children"].size(), 1u);
    level = &(*level)["children"][0];
    EXPECT_FALSE(level->contains("transform"));
  }
  EXPECT_EQ(error, 0);
  EXPECT_EQ(uris, (std::vector<std::string>{t.coarser[0].uri, t.coarser[1].uri, t.uri}));
}

/// Each in its own box, all in the frame of the tile.
TEST(Tileset, PiecesAreChildrenOfTheirTile) {
  for (const bool coarser : {false, true}) {
    SCOPED_TRACE(coarser);
    TileEntry t = tile(17604, 12942);
    t.uri.clear();
    t.pieces = {{"a_q0.glb", {-200, -150, 0}, {0, 0, 20}}, {"a_q31.glb", {0, 0, 0}, {210, 160, 25.5}}};
    if (coarser) t.coarser = {{"a_lod1.glb", 3 * kRoofError}, {"a_lod2.glb", kRoofError}};
    const json document = json::parse(write_tileset(std::vector{t}, {}));
    const json* node = &document["root"]["children"][0];
    EXPECT_TRUE(node->contains("transform"));
    EXPECT_EQ(node->contains("content"), coarser);
    EXPECT_EQ(node->contains("refine"), coarser);
    EXPECT_EQ((*node)["geometricError"], coarser ? 3 * kRoofError : 100) << "without content: refined as its parent is";
    if (coarser) node = &(*node)["children"][0];
    ASSERT_EQ((*node)["children"].size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const json& piece = (*node)["children"][i];
      EXPECT_EQ(piece["content"]["uri"], t.pieces[i].uri);
      EXPECT_EQ(piece["geometricError"], 0);
      EXPECT_FALSE(piece.contains("transform"));
      EXPECT_EQ(piece["boundingVolume"]["box"][0], (t.pieces[i].min.x + t.pieces[i].max.x) / 2);
    }
  }
}

TEST(Tileset, QuadtreeWithCollapsedChains) {
  std::vector<TileEntry> tiles;
  for (std::uint32_t x = 17600; x < 17610; ++x)
    for (std::uint32_t y = 12940; y < 12947; ++y) tiles.push_back(tile(x, y));
  tiles.push_back(tile(100, 100));  // the other side of the world
  const json t = json::parse(write_tileset(tiles, {}));
  EXPECT_EQ(t["asset"]["version"], "1.1");
  EXPECT_GE(t["geometricError"], t["root"]["geometricError"]);
  EXPECT_EQ(t["root"]["refine"], "ADD");
  Walk walk;
  walk.visit(t["root"], nullptr);
  EXPECT_EQ(walk.uris.size(), tiles.size());
  EXPECT_LT(walk.inner, 45);
}

TEST(Tileset, DoesNotDependOnTheOrderOfTiles) {
  std::vector<TileEntry> tiles{tile(5, 9), tile(6, 9), tile(5, 10), tile(700, 3)};
  const std::string a = write_tileset(tiles, {});
  std::reverse(tiles.begin(), tiles.end());
  EXPECT_EQ(a, write_tileset(tiles, {}));
}

TEST(Tileset, OneTileHasARootAbove) {
  const std::vector<TileEntry> tiles{tile(17604, 12942)};
  const json t = json::parse(write_tileset(tiles, {}));
  EXPECT_EQ(t["root"]["geometricError"], 100);
  EXPECT_EQ(t["geometricError"], 200);
  ASSERT_EQ(t["root"]["children"].size(), 1u);
  const json& region = t["root"]["boundingVolume"]["region"];
  EXPECT_LT(region[0].get<double>(), tiles[0].west * std::numbers::pi / 180);
  EXPECT_GT(region[0].get<double>(), (tiles[0].west - 1e-5) * std::numbers::pi / 180);
  EXPECT_GT(region[5], 25.5);
}

TEST(Tileset, CrossesTheAntimeridianWithTheWholeCircle) {
  TileEntry t = tile(65535, 16384);
  t.west = 179.999;
  t.east = -179.999;
  const json j = json::parse(write_tileset(std::vector{t}, {}));
  EXPECT_EQ(j["root"]["boundingVolume"]["region"][0], -std::numbers::pi);
  EXPECT_EQ(j["root"]["boundingVolume"]["region"][2], std::numbers::pi);
}

/// 56 m from a pole corners of the box lie on all meridians, and farther from the pole than what is in it.
TEST(Tileset, HoldsBoxesAtThePoles) {
  for (const bool north : {true, false}) {
    TileEntry t = tile(18659, north ? 32767 : 0);
    t.min = {-30, -30, 0};
    t.max = {30, 30, 25.5};
    (north ? t.south : t.north) = north ? 89.9995 : -89.9995;
    (north ? t.north : t.south) = north ? 89.99951 : -89.99951;
    const json region = json::parse(write_tileset(std::vector{t}, {}))["root"]["boundingVolume"]["region"];
    constexpr double kDegree = std::numbers::pi / 180;
    EXPECT_EQ(region[0], -std::numbers::pi);
    EXPECT_EQ(region[2], std::numbers::pi);
    const double equatorwards = north ? region[1].get<double>() : -region[3].get<double>();
    EXPECT_LT(equatorwards, (89.9995 - 0.0004) * kDegree) << "42 m more are 0.0004 degrees";
    EXPECT_LE(std::fabs(region[north ? 3 : 1].get<double>()), 90 * kDegree);
  }
}

TEST(Tileset, WithoutTilesIsStillValid) {
  const json t = json::parse(write_tileset({}, {}));
  EXPECT_EQ(t["root"]["boundingVolume"]["box"].size(), 12u);
  EXPECT_EQ(t["root"]["geometricError"], 0);
  EXPECT_FALSE(t["root"].contains("children"));
}

}  // namespace
}  // namespace blockrand::outputs
