// What a build consists of, and what must be there before it.
#include "pipeline/outward/build_files.h"

#include "pipeline/base/error.h"
#include "tests/unit/outward/build_folder.h"

namespace blockrand::outward {
namespace {

class BuildFiles : public TestFolder {};

TEST_F(BuildFiles, StepsByName) {
  EXPECT_EQ(step_of("textures/brick.png"), Step::contents);
  EXPECT_EQ(step_of("citygml/15_1_2.gml"), Step::contents);
  EXPECT_EQ(step_of("areas/11/1/2/buildings.gpkg"), Step::contents);
  EXPECT_EQ(step_of("areas/11/1/2/tiles/15/1/2_q0.glb"), Step::tiles);
  EXPECT_EQ(step_of("areas/11/1/2/tileset.json"), Step::tilesets);
  EXPECT_EQ(step_of("tilesets/8/1/2.json"), Step::tilesets);
  EXPECT_EQ(step_of("report.html"), Step::documents);
  EXPECT_EQ(step_of("tileset.json.gz"), Step::tilesets) << "servers hand it out as tileset.json";
  EXPECT_EQ(step_of("tiles/15/1/2.glb.gz"), Step::tiles);
  EXPECT_EQ(step_of("explain/15_1_2.jsonl.gz"), Step::contents);
  EXPECT_EQ(step_of("areas/11/1/2/build.json"), Step::record);
}

TEST_F(BuildFiles, TilesetsStandBehindThoseThatTheyLeadTo) {
  const std::string area =
      build("b/areas/11/1/2", {{"tileset.json", tileset({"tiles/a.glb"})}, {"tiles/a.glb", "glb"}});
  const std::string folder = build("b",
                                   {{"tileset.json", tileset({"tilesets/8/0/0.json"})},
                                    {"tilesets/8/0/0.json", tileset({"../../../areas/11/1/2/tileset.json"})}},
                                   {{"11/1/2", {{"files", 2}}}});
  const auto files = files_of_build(folder);
  EXPECT_EQ(files.size(), 6U) << "two records, three tilesets, a tile";
  EXPECT_EQ(files.at("areas/11/1/2/tileset.json").level, 0);
  EXPECT_EQ(files.at("tilesets/8/0/0.json").level, 1);
  EXPECT_EQ(files.at("tileset.json").level, 2);
  EXPECT_LT(files.at("areas/11/1/2/build.json").level, files.at("build.json").level);
  EXPECT_EQ(files.at("build.json").sha256, base::sha256_file(folder + "/build.json"));
}

TEST_F(BuildFiles, PackedTilesetsComeWithTheirPlainOnes) {
  const std::string folder = build("b", {{"tileset.json", tileset({"tilesets/a.json"})},
                                         {"tileset.json.gz", "packed"},
                                         {"tilesets/a.json", tileset({})}});
  const auto files = files_of_build(folder);
  EXPECT_EQ(files.at("tileset.json.gz").step, Step::tilesets);
  EXPECT_EQ(files.at("tileset.json.gz").level, 1);
}

TEST_F(BuildFiles, ATilesetThatLeadsToNoFileOfTheBuildIsRefused) {
  const std::string folder = build("b", {{"tileset.json", tileset({"tiles/a.glb"})}});
  EXPECT_THROW(
      {
        try {
          files_of_build(folder);
        } catch (const base::InputError& error) {
          EXPECT_NE(std::string(error.what()).find("leads to tiles/a.glb"), std::string::npos) << error.what();
          throw;
        }
      },
      base::InputError);
}

TEST_F(BuildFiles, TilesetsInACircleAreRefused) {
  const std::string folder =
      build("b", {{"tileset.json", tileset({"tilesets/a.json"})}, {"tilesets/a.json", tileset({"../tileset.json"})}});
  EXPECT_THROW(files_of_build(folder), base::InputError);
}

TEST_F(BuildFiles, PathsThatLeadOutOfTheBuildAreRefused) {
  for (const std::string bad : {"../a", "/etc/passwd", "a/../../b", "a\nb"}) {
    write(path("b/build.json"), nlohmann::json{{"files", {{bad, {{"bytes", 1}, {"sha256", "0"}}}}}}.dump());
    EXPECT_THROW(files_of_build(path("b")), base::InputError) << bad;
  }
  write(path("b/build.json"), "{");
  EXPECT_THROW(files_of_build(path("b")), base::InputError);
}

TEST_F(BuildFiles, CompanionsOfGlbAreRelativeToTheBuild) {
  const std::string json =
      R"({"images":[{"uri":"../textures/a.png"},{"uri":"data:image/png;base64,AA"}],"buffers":[{"byteLength":3}]})";
  std::string glb = "glTF";
  for (const std::uint32_t n :
       {2U, static_cast<std::uint32_t>(20 + json.size()), static_cast<std::uint32_t>(json.size()), 0x4E4F534AU})
    glb.append(reinterpret_cast<const char*>(&n), 4);
  write(path("b/tiles/a.glb"), glb + json);
  EXPECT_EQ(companions_of_glb(path("b"), "tiles/a.glb"), (std::vector<std::string>{"textures/a.png"}));
  write(path("b/tiles/b.glb"), glb.substr(0, 12) + std::string("\xff\xff\xff\x7fJSON", 8));
  EXPECT_THROW(companions_of_glb(path("b"), "tiles/b.glb"), base::InputError) << "a length that the file does not have";
}

}  // namespace
}  // namespace blockrand::outward
