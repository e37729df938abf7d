#include "pipeline/outputs/report/embedded_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "pipeline/outputs/gzip.h"

namespace blockrand::outputs {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The file of a page, unpacked as a browser does.
std::string content_of(const std::string& page, const std::string& path) {
  const std::string key = '"' + path + "\":\"";
  const std::size_t at = page.find(key) + key.size();
  const std::string text = page.substr(at, page.find('"', at) - at);
  std::string bytes;
  unsigned bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    bits = bits << 6 | static_cast<unsigned>(letters.find(c));
    if ((held += 6) >= 8) bytes += static_cast<char>(bits >> (held -= 8) & 0xFF);
  }
  return gunzip(bytes);
}

class EmbeddedView : public testing::Test {
 protected:
  std::optional<std::string> page(std::uint64_t most = kMostEmbedded) {
    std::vector<base::PublishedFile> files;
    for (const auto& [path, content] : contents_) files.push_back({path, content.size(), ""});
    ViewRecord view;
    view.name = "A < B & \"C\"";
    view.lod = 3;
    view.buildings = 12;
    view.attribution = "© OSM";
    return embedded_view(
        files,
        [&](const std::string& path) {
          ++read_;
          return contents_.at(path);
        },
        view, most);
  }
  std::map<std::string, std::string> contents_ = {
      {"tileset.json", R"({"root":{"boundingVolume":{"region":[0.23,0.91,0.24,0.92,34.5,80]}}})"},
      {"tiles/15/1/2.glb", "glTF \x01\xFF binary"},
      {"tiles/15/1/2_lod1.glb", "glTF coarse"},
      {"citygml/15_1_2.gml", "<CityModel/>"}};
  int read_ = 0;
};

TEST_F(EmbeddedView, HoldsTilesetTilesAndTheirPlace) {
  const auto text = page();
  ASSERT_TRUE(text);
  EXPECT_EQ(content_of(*text, "model/tileset.json"), contents_["tileset.json"]);
  EXPECT_EQ(content_of(*text, "model/tiles/15/1/2.glb"), contents_["tiles/15/1/2.glb"]);
  const std::string view = content_of(*text, "view.json");
  EXPECT_THAT(view, HasSubstr(R"("name": "A < B & \"C\"")"));
  EXPECT_THAT(view, HasSubstr("\"height\": 34.5"));
  EXPECT_THAT(view, HasSubstr("\"lon\": 13.4645"));
  EXPECT_THAT(view, HasSubstr("\"explained\": null"));
  EXPECT_THAT(*text, Not(HasSubstr("gml")));
  EXPECT_EQ(text->find_first_of("<&"), std::string::npos) << "it stands in a page that is XML";
}

TEST_F(EmbeddedView, TooMuchIsLeftOut) {
  EXPECT_FALSE(page(100));
  std::minstd_rand random(1);
  std::string noise(100'000, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  contents_["tiles/15/1/3.glb"] = noise;
  EXPECT_TRUE(page(200'000));
  EXPECT_FALSE(page(120'000));
  read_ = 0;
  EXPECT_FALSE(page(10'000));
  EXPECT_EQ(read_, 0) << "seen by the sizes";
}

TEST_F(EmbeddedView, NothingIsShownOfABuildWithoutTiles) {
  contents_.erase("tiles/15/1/2.glb");
  contents_.erase("tiles/15/1/2_lod1.glb");
  EXPECT_FALSE(page());
  contents_["tiles/15/1/2.glb"] = "glTF";
  contents_["tileset.json"] = "{\"root\":";
  EXPECT_FALSE(page());
  contents_.erase("tileset.json");
  EXPECT_FALSE(page());
}

}  // namespace
}  // namespace blockrand::outputs
