#include "pipeline/validate/surroundings_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "pipeline/outputs/citygml/surroundings_gml.h"
#include "pipeline/outputs/cityjson/surroundings_cityjson.h"
#include "tests/unit/outputs/surroundings_sample.h"

namespace blockrand::validate {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr model::TileId kTile{15, 17600, 12900};

std::string sound(Format format) {
  const model::Surroundings given = outputs::test::sample_surroundings();
  const model::SurroundingCatalogue catalogue = outputs::test::sample_catalogue();
  if (format == Format::citygml) {
    outputs::CityGmlOptions options;
    options.srs_name = "urn:ogc:def:crs:EPSG::25833";
    return outputs::write_surroundings_gml(given, catalogue, kTile, options);
  }
  outputs::CityJsonOptions options;
  options.crs_code = "EPSG:25833";
  return outputs::write_surroundings_cityjson(given, catalogue, kTile, options);
}

std::vector<std::string> findings(Format format, const std::string& text) {
  std::vector<std::string> out;
  for (const Finding& f : read_surroundings(format, text, "a").findings) {
    EXPECT_EQ(f.file, "a");
    out.push_back(std::string(info(f.check).text) + " " + f.object + ": " + f.detail);
  }
  return out;
}

/// A sound file with one text instead of another.
std::vector<std::string> damaged(Format format, const std::string& from, const std::string& to) {
  std::string text = sound(format);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return findings(format, text.replace(at, from.size(), to));
}

TEST(SurroundingsFiles, SoundFilesHaveTheSameObjects) {
  const SurroundingsFile gml = read_surroundings(Format::citygml, sound(Format::citygml), "a"),
                         json = read_surroundings(Format::cityjson, sound(Format::cityjson), "a");
  EXPECT_THAT(findings(Format::citygml, sound(Format::citygml)), IsEmpty());
  EXPECT_THAT(findings(Format::cityjson, sound(Format::cityjson)), IsEmpty());
  EXPECT_EQ(gml.ids.size(), 17u);
  EXPECT_EQ(gml.ids, json.ids);
}

TEST(SurroundingsFiles, DamagedCityGml) {
  constexpr Format kGml = Format::citygml;
  EXPECT_THAT(findings(kGml, ""), Contains(HasSubstr("FILE_UNREADABLE")));
  EXPECT_THAT(findings(kGml, sound(kGml).substr(0, 5000)), Contains(HasSubstr("FILE_UNREADABLE")));
  EXPECT_THAT(damaged(kGml, "gml:id=\"r20_", "gml:id=\"w10_"),
              Contains(HasSubstr("CITYGML_RULE w10_cwrsph_1: gml:id twice")));
  EXPECT_THAT(damaged(kGml, "gml:id=\"r20_cwrsph_1_m1", "gml:id=\"x"),
              Contains(HasSubstr("names what is not in the file")));
  EXPECT_THAT(damaged(kGml, "xlink:href=\"#s", "xlink:href=\"#t"),
              Contains(HasSubstr("names what is not in the file")));
  EXPECT_THAT(
      damaged(kGml, "<luse:LandUse gml:id=\"r20_cwrsph_1\">", "<luse:Building/><luse:LandUse gml:id=\"r20_cwrsph_1\">"),
      Contains(HasSubstr("unexpected city object Building")));
}

TEST(SurroundingsFiles, DamagedCityJson) {
  constexpr Format kJson = Format::cityjson;
  EXPECT_THAT(findings(kJson, ""), Contains(HasSubstr("has no end")));
  EXPECT_THAT(findings(kJson, sound(kJson) + "{\n"), Contains(HasSubstr("FILE_UNREADABLE")));
  EXPECT_THAT(findings(kJson, sound(kJson) + "\"[[[[\n"), Contains(HasSubstr("FILE_UNREADABLE")));
  EXPECT_THAT(damaged(kJson, "\"version\":\"2.0\"", "\"version\":\"1.0\""),
              Contains(HasSubstr("no CityJSON of version 2.0")));
  EXPECT_THAT(damaged(kJson, "\"type\":\"Road\"", "\"type\":\"Building\""),
              Contains(HasSubstr("unexpected type Building")));
  EXPECT_THAT(damaged(kJson, "\"boundaries\":[[[0,1,2,3]]", "\"boundaries\":[[[0,1,2,99]]"),
              Contains(HasSubstr("vertices")));
  EXPECT_THAT(damaged(kJson, "\"template\":1", "\"template\":2"), Contains(HasSubstr("template")));
  EXPECT_THAT(damaged(kJson, "\"value\":0", "\"value\":1"), Contains(HasSubstr("material")));
  EXPECT_THAT(damaged(kJson, "\"id\":\"r20_", "\"id\":\"r21_"), Contains(HasSubstr("no CityJSONFeature")));
  std::string twice = sound(kJson);
  const std::size_t last = twice.rfind('\n', twice.size() - 2);
  EXPECT_THAT(findings(kJson, twice + twice.substr(last + 1)), Contains(HasSubstr("stands twice")));
}

TEST(SurroundingsFiles, OfABuild) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "blockrand_surroundings_files";
  fs::remove_all(folder);
  fs::create_directories(folder / "citygml");
  BuildRecord record;
  const auto write = [&](const std::string& path) {
    std::ofstream(folder / path, std::ios::binary) << sound(Format::citygml);
    record.files[path] = {};
  };
  record.files["citygml/15_1_3_surroundings.gml"] = {};  // is not there
  record.files["citygml/15_1_2.gml"] = {};
  write("citygml/15_1_2_surroundings.gml");
  base::Progress progress;
  FindingLog log;
  const auto check = [&] { return check_surroundings(folder, record, 1, nullptr, nullptr, 2, progress, log); };
  EXPECT_EQ(check().objects, 17u);
  EXPECT_EQ(log.count(), 0u);
  write("citygml/15_1_4_surroundings.gml");
  EXPECT_EQ(check().files, 3u);
  EXPECT_EQ(log.count(Check::object_doubled), 17u) << "the same tile twice";
  fs::remove_all(folder);
}

}  // namespace
}  // namespace blockrand::validate
