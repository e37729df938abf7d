#include "pipeline/validate/formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/outputs/options.h"

namespace blockrand::validate {
namespace {

TEST(Formats, KnowsEachFormatThatABuildWrites) {
  for (const std::string& name : outputs::format_names()) EXPECT_TRUE(is_format(name)) << name;
  EXPECT_FALSE(is_format("obj"));
  EXPECT_FALSE(is_format(""));
}

struct PathCase {
  std::string path, tile;
  Format format = Format::gltf;
  std::optional<int> coarser{};
  bool piece = false;
};

TEST(Formats, FilesOfATile) {
  const PathCase cases[] = {{"tiles/15/17600/12900.glb", "15_17600_12900"},
                            {"tiles/15/17600/12900_lod1.glb", "15_17600_12900", Format::gltf, 1},
                            {"tiles/15/17600/12900_lod0.glb", "15_17600_12900", Format::gltf, 0},
                            {"tiles/15/17600/12900_lod3.glb", "15_17600_12900_lod3"},  // no coarser level
                            {"tiles/15/17600/12900_q0.glb", "15_17600_12900", Format::gltf, {}, true},
                            {"tiles/15/17600/12900_q213.glb", "15_17600_12900", Format::gltf, {}, true},
                            {"tiles/15/17600/12900_q.glb", "15_17600_12900_q"},
                            {"tiles/15/17600/12900_q4.glb", "15_17600_12900_q4"},
                            {"citygml/15_1_2.gml", "15_1_2", Format::citygml},
                            {"citygml/15_1_2.gml.gz", "15_1_2", Format::citygml},
                            {"cityjson/15_1_2.city.jsonl", "15_1_2", Format::cityjson},
                            {"cityjson/15_1_2.city.jsonl.gz", "15_1_2", Format::cityjson}};
  for (const PathCase& c : cases) {
    SCOPED_TRACE(c.path);
    const auto path = tile_path(c.path);
    ASSERT_TRUE(path);
    EXPECT_EQ(path->tile, c.tile);
    EXPECT_EQ(path->format, c.format);
    EXPECT_EQ(path->coarser, c.coarser);
    EXPECT_EQ(path->piece, c.piece);
  }
}

TEST(Formats, FilesOfSurroundingsAreTheirOwn) {
  const PathCase cases[] = {{"citygml/15_1_2_surroundings.gml", "15_1_2", Format::citygml},
                            {"citygml/15_1_2_surroundings.gml.gz", "15_1_2", Format::citygml},
                            {"cityjson/15_1_2_surroundings.city.jsonl", "15_1_2", Format::cityjson},
                            {"tiles/15/1/2_surroundings.glb", "15_1_2", Format::gltf}};
  for (const PathCase& c : cases) {
    SCOPED_TRACE(c.path);
    EXPECT_FALSE(tile_path(c.path));
    const auto path = surroundings_path(c.path);
    ASSERT_TRUE(path);
    EXPECT_EQ(path->tile, c.tile);
    EXPECT_EQ(path->format, c.format);
  }
  for (const char* path : {"citygml/15_1_2.gml", "tiles/15/1/2.glb", "surroundings.gml", ""})
    EXPECT_FALSE(surroundings_path(path)) << path;
}

TEST(Formats, FilesOfTheWholeBuildBelongToNoTile) {
  for (const char* path : {"tileset.json", "model.glb", "model.city.json", "buildings.gpkg", "citygml/.gml",
                           "tiles/15/17600/12900.glb.gz", "explain/15_1_2.jsonl.gz", ""})
    EXPECT_FALSE(tile_path(path)) << path;
}

TEST(Formats, ExplanationsOfATile) {
  EXPECT_EQ(explained_tile("explain/15_1_2.jsonl.gz"), "15_1_2");
  EXPECT_EQ(explained_tile("explain/index.txt"), "");
  EXPECT_EQ(explained_tile("explain/.jsonl.gz"), "");
}

}  // namespace
}  // namespace blockrand::validate
