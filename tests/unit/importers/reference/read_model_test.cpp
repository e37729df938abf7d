// The door to all formats: told by content, files of a folder found.
#include "importers/reference/read_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/unit/importers/reference/gltf_support.h"
#include "tests/unit/importers/reference/support.h"

namespace blockrand::importers::reference::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
namespace fs = std::filesystem;

const std::string kHouse = document(building(
    "b", surface("GroundSurface", polygon("390000 5820000 30 390000 5820008 30 390010 5820008 30 390010 5820000 30"))));
const std::string kJson =
    R"({"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],"translate":[0,0,0]},"metadata":{"referenceSystem":"EPSG:25833"},"CityObjects":{},"vertices":[]})";

std::string cube() {
  GltfMaker maker;
  maker.node({{"mesh", maker.cube(10)}});
  maker.place(13.4, 52.5);
  return maker.glb();
}

std::string refused(const std::string& path) {
  try {
    read_model(path);
    return "read";
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(ReadModel, TellsTheFormatByItsContent) {
  const TempFolder folder;
  EXPECT_EQ(read_model(folder.write("a", kHouse)).format, "CityGML 2.0");
  EXPECT_EQ(read_model(folder.write_gzipped("b.json", kHouse)).format, "CityGML 2.0");
  EXPECT_EQ(read_model(folder.write("c.gml", kJson)).format, "CityJSON 1.1");
  EXPECT_EQ(read_model(folder.write("d.gml", "\xEF\xBB\xBF \n" + kJson)).format, "CityJSON 1.1");
  EXPECT_EQ(read_model(folder.write("e.json", cube())).format, "glTF 2.0");
  EXPECT_EQ(read_model(folder.write_gzipped("f", cube())).format, "glTF 2.0");
  EXPECT_EQ(
      read_model(
          folder.write(
              "g.json",
              R"({"asset":{"version":"1.0"},"geometricError":1,"root":{"boundingVolume":{},"geometricError":0}})"))
          .format,
      "3D Tiles 1.0");
  // The member that tells stands behind a megabyte of others.
  const std::string late =
      R"({"extensions":{"x":")" + std::string(2'000'000, 'x') +
      R"("},"version":"1.1","metadata":{"referenceSystem":"EPSG:25833"},"type":"CityJSON","CityObjects":{},"vertices":[]})";
  EXPECT_EQ(read_model(folder.write("h.json", late)).format, "CityJSON 1.1");
  EXPECT_EQ(read_model(folder.write("i.gml", kHouse)).bytes, kHouse.size());
}

TEST(ReadModel, RefusesDeepNestingBeforeAllIsUnpacked) {
  const TempFolder folder;
  const std::string bomb = folder.write_gzipped("bomb.json", R"({"a":)" + std::string(3'000'000, '['));
  try {
    read_model(bomb);
    ADD_FAILURE() << "read";
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("bomb.json"), testing::HasSubstr("deeper than 512 levels")));
  }
}

TEST(ReadModel, RefusesWhatIsNoModel) {
  const TempFolder folder;
  for (const char* bytes : {"hello", "{\"a\":1}", "[1]", "\x1f\x8b\x08", "{", "PK\x03\x04"})
    EXPECT_THAT(refused(folder.write("x.bin", bytes)), AllOf(HasSubstr("x.bin"), HasSubstr("CityJSON"))) << bytes;
  EXPECT_THAT(refused(folder.write("b3", "b3dm\x01")), HasSubstr("b3dm"));
  EXPECT_THAT(refused(folder.write("empty", "")), HasSubstr("empty"));
  EXPECT_THAT(refused(folder.path()), HasSubstr("directory"));
  EXPECT_THAT(refused(folder.path() + "/nothing"), HasSubstr("no such file"));
}

class ModelFiles : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& bytes = "x") {
    fs::create_directories(fs::path(folder_.path() + "/" + name).parent_path());
    folder_.write(name, bytes);
  }
  /// Names within the folder.
  std::vector<std::string> found(const std::string& of = "") {
    std::vector<std::string> out;
    for (const std::string& path : model_files(folder_.path() + of))
      out.push_back(fs::relative(path, folder_.path()).string());
    return out;
  }
  TempFolder folder_;
};

TEST_F(ModelFiles, OfAFolderInTheOrderOfNames) {
  put("b/2.gml"), put("b/1.xml.gz", kHouse), put("a.city.jsonl"), put("c.GLB"), put("z.json", kJson);
  put("readme.xml", "<html/>"), put("list.json", "{\"a\":1}"), put("README.md"), put("b/appearance/wall.jpg");
  put("schema.xsd"), put("b/x.city.jsonl.gz");
  EXPECT_THAT(found(), ElementsAre("a.city.jsonl", "b/1.xml.gz", "b/2.gml", "b/x.city.jsonl.gz", "c.GLB", "z.json"));
  EXPECT_THAT(found("/b/2.gml"), ElementsAre("b/2.gml"));
}

TEST_F(ModelFiles, OfABuildItsBestFormat) {
  put("build.json", "{}"), put("report.json", "{}"), put("tileset.json", "{}"), put("tiles/15/1/2.glb"),
      put("model.glb");
  EXPECT_THAT(found(), ElementsAre("tileset.json"));
  put("model.city.json", "{}");
  EXPECT_THAT(found(), ElementsAre("model.city.json"));
  put("cityjson/15_1_2.city.jsonl.gz"), put("cityjson/15_1_1.city.jsonl.gz");
  EXPECT_THAT(found(), ElementsAre("cityjson/15_1_1.city.jsonl.gz", "cityjson/15_1_2.city.jsonl.gz"));
  put("citygml/15_1_2.gml.gz");
  EXPECT_THAT(found(), ElementsAre("citygml/15_1_2.gml.gz"));
}

TEST_F(ModelFiles, OfATilesetTheTilesetAlone) {
  put("t/tileset.json", R"({"asset":{"version":"1.1"},"root":{}})"), put("t/tiles/a.glb", cube()), put("t/tiles/b.gml");
  put("t/inner.json", R"({"asset":{"version":"1.1"},"root":{}})");
  EXPECT_THAT(found(), ElementsAre("t/tileset.json", "t/tiles/b.gml"));
}

TEST_F(ModelFiles, NoneIsAnError) {
  put("README.md");
  const auto message = [](const std::string& path) {
    try {
      model_files(path);
      return std::string("found");
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(message(folder_.path()), AllOf(HasSubstr(folder_.path()), HasSubstr(".gml")));
  EXPECT_THAT(message(folder_.path() + "/none"), HasSubstr("no such file"));
}

TEST(Names, OfEveryNoteAndHeightReference) {
  for (int i = 0; i <= static_cast<int>(NoteKind::bad_hierarchy); ++i)
    EXPECT_FALSE(name_of(static_cast<NoteKind>(i)).empty()) << i;
  for (int i = 0; i <= static_cast<int>(HeightReference::above_local_ground); ++i)
    EXPECT_FALSE(name_of(static_cast<HeightReference>(i)).empty()) << i;
}

}  // namespace
}  // namespace blockrand::importers::reference::test
