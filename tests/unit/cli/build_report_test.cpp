#include "pipeline/cli/build_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace blockrand::cli {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

run::BuildSummary summary() {
  run::BuildSummary s;
  s.buildings_in = 12345;
  s.parts_in = 678;
  s.models = 12800;
  s.represented = 120;
  s.duplicates = 3;
  s.reported = 100;
  s.models_by_lod = {2, 8, 12790};
  s.issues = {{"ROOF_SHAPE_ADAPTED", 7}, {"NODE_ONLY", 10}, {"OPEN_WAY", 90}, {"VALUE_UNREADABLE", 1234}};
  s.files = 45;
  s.bytes = 123'456'789;
  s.seconds = 2;
  s.peak_rss_bytes = 512'300'000;
  return s;
}

run::BuildOptions options() {
  run::BuildOptions o;
  o.output = "out/leipzig";
  return o;
}

TEST(BuildReport, NamesObjectsThatNoStageDecidedOn) {
  run::BuildSummary lost = summary();
  lost.folder = options().output;
  lost.unaccounted = {"w7"};
  EXPECT_THAT(unaccounted_text(options(), lost),
              HasSubstr("an object of the extract: w7 (UNACCOUNTED in report.json). The build lies in out/leipzig."));
  lost.unaccounted.assign(25, "w8");
  lost.folder = "/data/out/leipzig.unaccounted";
  EXPECT_THAT(unaccounted_text(options(), lost),
              ContainsRegex("25 objects of .* and 5 more .*earlier build stays .*leipzig.unaccounted"));
}

TEST(BuildReport, SaysWhatBecameOfTheObjects) {
  const std::string text = build_report(options(), summary());
  EXPECT_THAT(text, ContainsRegex("in +13,023  12,345 buildings, 678 parts\n"));
  EXPECT_THAT(text, ContainsRegex("modelled +12,800\n"));
  EXPECT_THAT(text, ContainsRegex("represented +120 "));
  EXPECT_THAT(text, ContainsRegex("duplicate +3 "));
  EXPECT_THAT(text, ContainsRegex("reported +100 "));
  EXPECT_THAT(text, ContainsRegex("LoD 2 +12,790\n  LoD 1 +8\n  LoD 0 +2\n"));
  EXPECT_THAT(text, HasSubstr("\n2.0 s, peak memory 512.3 MB\n"));
  EXPECT_THAT(text, HasSubstr("123.5 MB in 45 files"));
}

TEST(BuildReport, GaugesForDevelopersAreAskedFor) {
  run::BuildSummary s = summary();
  s.store_bytes = 77'000'000;
  s.tiles_in_flight = 6;
  s.roofscape.mid_row = 10;
  const std::string plain = build_report(options(), s), verbose = build_report(options(), s, true);
  for (const char* gauge :
       {"6,511 buildings and parts/s", "77.0 MB store, the rest 6 tiles in flight", "Sloped roofs in rows"}) {
    EXPECT_THAT(plain, Not(HasSubstr(gauge)));
    EXPECT_THAT(verbose, HasSubstr(gauge));
  }
}

TEST(BuildReport, EndsWithHowToLookAtIt) {
  EXPECT_TRUE(build_report(options(), summary()).ends_with("to look at it: blockrand view out/leipzig\n"));
  run::BuildOptions o = options();
  o.output = "my town's";
  EXPECT_TRUE(build_report(o, summary()).ends_with("to look at it: blockrand view 'my town'\\''s'\n"));
}

TEST(BuildReport, GroupsCodesByWhatTheyMean) {
  const std::string text = build_report(options(), summary());
  EXPECT_THAT(text, ContainsRegex("Not modelled, because\n  OPEN_WAY +90  The way is not closed.*\n  NODE_ONLY +10 "))
      << "most frequent first";
  EXPECT_THAT(text, ContainsRegex("Simpler than asked\n  ROOF_SHAPE_ADAPTED +7 "));
  EXPECT_THAT(text, ContainsRegex("Notices\n  VALUE_UNREADABLE +1,234 "));
  run::BuildSummary clean = summary();
  clean.issues.clear();
  EXPECT_THAT(build_report(options(), clean), Not(HasSubstr("because\n")));
}

TEST(BuildReport, NamesTheFilesThatWereAskedFor) {
  run::BuildOptions o = options();
  o.outputs.formats = {"gltf", "cityjson", "gpkg"};
  o.outputs.single_glb = true;
  const std::string text = build_report(o, summary());
  EXPECT_THAT(text, HasSubstr("out/leipzig/tileset.json"));
  EXPECT_THAT(text, HasSubstr("out/leipzig/model.glb"));
  EXPECT_THAT(text, Not(HasSubstr("citygml")));
}

TEST(BuildReport, SaysHowLargeTheOneFileIs) {
  run::BuildOptions o = options();
  o.outputs.single_glb = true;
  run::BuildSummary s = summary();
  s.figures["model.glb"] = "386 houses in 427 parts, 5,173,349 triangles, 130.2 MB";
  EXPECT_THAT(build_report(o, s),
              ContainsRegex("model\\.glb .*editors: 386 houses in 427 parts, 5,173,349 triangles, "));
}

TEST(BuildReport, ALowerLevelHidesTheRowsAboveIt) {
  run::BuildOptions o = options();
  o.lod = 1;
  run::BuildSummary s = summary();
  s.models_by_lod = {2, 12798, 0};
  EXPECT_THAT(build_report(o, s), Not(HasSubstr("LoD 2")));
}

TEST(BuildReport, JsonIsOneLineWithTheSameNumbers) {
  const std::string text = build_report_json(options(), summary());
  EXPECT_EQ(text.find('\n'), text.size() - 1);
  const auto j = nlohmann::json::parse(text);
  EXPECT_EQ(j["buildings_in"], 12345);
  EXPECT_EQ(j["models_by_lod"][2], 12790);
  EXPECT_EQ(j["issues"]["OPEN_WAY"], 90);
  EXPECT_EQ(j["output"], "out/leipzig");
}

}  // namespace
}  // namespace blockrand::cli
