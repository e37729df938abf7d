// A tree of tilesets: every one is reached, no file grows with their number.
#include "pipeline/outputs/tileset/nested_tileset.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

namespace blockrand::outputs {
namespace {

using Json = nlohmann::ordered_json;

NestedTileset nested(std::uint32_t x, std::uint32_t y, int level = 11) {
  const double size = 0.0015;
  return {{level, x, y},
          "areas/" + std::to_string(x) + "/" + std::to_string(y) + "/tileset.json",
          {x * size, y * size, (x + 1) * size, (y + 1) * size, -0.5 * x, 10 + 0.25 * y},
          100.0 + x % 3};
}

struct Reached {
  std::set<std::string> uris;
  std::size_t most_named = 0;
};

/// Follows all files; the rules of 3D Tiles hold on the way.
Reached follow(const std::map<std::string, std::string>& files) {
  Reached out;
  std::size_t named = 0;
  const std::function<void(const std::string&, const Json&, const Json*)> visit = [&](const std::string& file,
                                                                                      const Json& tile,
                                                                                      const Json* above) {
    if (above) {
      EXPECT_LE(tile["geometricError"].get<double>(), (*above)["geometricError"].get<double>());
      for (const std::size_t low : {0u, 1u, 4u}) {
        const std::size_t high = low == 4 ? 5 : low + 2;
        EXPECT_GE(tile["boundingVolume"]["region"][low], (*above)["boundingVolume"]["region"][low]);
        EXPECT_LE(tile["boundingVolume"]["region"][high], (*above)["boundingVolume"]["region"][high]);
      }
    }
    EXPECT_NE(tile.contains("content"), tile.contains("children")) << "a tile of a tileset has no children";
    if (tile.contains("content")) {
      ++named;
      const std::string uri =
          (std::filesystem::path(file).parent_path() / tile["content"]["uri"].get<std::string>()).lexically_normal();
      EXPECT_TRUE(out.uris.insert(uri).second) << uri;
    }
    if (tile.contains("children"))
      for (const Json& child : tile["children"]) visit(file, child, &tile);
  };
  for (const auto& [path, text] : files) {
    const Json j = Json::parse(text);
    EXPECT_EQ(j["asset"]["version"], "1.1");
    EXPECT_EQ(j["root"]["refine"], "ADD");
    EXPECT_GE(j["geometricError"], j["root"]["geometricError"]);
    named = 0;
    visit(path, j["root"], nullptr);
    out.most_named = std::max(out.most_named, named);
  }
  return out;
}

TEST(NestedTilesets, EachIsReachedOnceAndNoFileGrows) {
  const Json asset = {{"version", "1.1"}};
  std::mt19937 random(2);
  for (const std::uint32_t side : {1u, 2u, 5u, 20u, 90u}) {
    SCOPED_TRACE(side);
    std::vector<NestedTileset> all;
    for (std::uint32_t x = 0; x < side; ++x)
      for (std::uint32_t y = 0; y < side; ++y)
        if (side > 2 && random() % 10 == 0)  // cut in four
          for (std::uint32_t k = 0; k < 4; ++k)
            all.push_back(nested(2 * (1080 + x) + k % 2, 2 * (800 + y) + k / 2, 12));
        else if (side < 3 || random() % 4)
          all.push_back(nested(1080 + x, 800 + y));
    all.push_back(nested(7, 3));  // alone, far away
    const auto files = nested_tilesets(all, asset);
    const Reached reached = follow(files);
    for (const NestedTileset& t : all) EXPECT_TRUE(reached.uris.contains(t.uri)) << t.uri;
    EXPECT_EQ(reached.uris.size(), all.size() + files.size() - 1) << "the other files, too, once each";
    EXPECT_LE(reached.most_named, 4u * 64);
    EXPECT_EQ(files.size() > 1, all.size() > 256);
    std::reverse(all.begin(), all.end());
    EXPECT_EQ(files, nested_tilesets(all, asset));
  }
}

TEST(NestedTilesets, BothSidesOfTheMeridianAndNone) {
  const Json asset = {{"version", "1.1"}};
  const Reached reached = follow(nested_tilesets({nested(2047, 5), nested(2048, 5)}, asset));
  EXPECT_EQ(reached.uris.size(), 2u);
  const auto none = nested_tilesets({}, asset);
  ASSERT_EQ(none.size(), 1u);
  EXPECT_TRUE(Json::parse(none.at("tileset.json"))["root"]["boundingVolume"].contains("box"));
}

}  // namespace
}  // namespace blockrand::outputs
