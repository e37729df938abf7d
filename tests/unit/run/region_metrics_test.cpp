// The text that Prometheus reads, and figures from the records of a region.
#include "pipeline/run/region_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "pipeline/run/build.h"
#include "pipeline/run/metrics_text.h"
#include "pipeline/run/region_end.h"

namespace blockrand::run {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(MetricsText, FamiliesHaveHelpAndTypeOnce) {
  MetricsText out(MetricsText::Labels{{"region", "leipzig"}});
  out.gauge("blockrand_x_bytes", "One line.");
  out.sample(1.5), out.sample(-2, {{"folder", "cache"}});
  out.counter("blockrand_runs_total", "Runs.");
  out.gauge("blockrand_y", "Never sampled.");
  EXPECT_EQ(out.text(),
            "# HELP blockrand_x_bytes One line.\n# TYPE blockrand_x_bytes gauge\n"
            "blockrand_x_bytes{region=\"leipzig\"} 1.5\nblockrand_x_bytes{region=\"leipzig\",folder=\"cache\"} -2\n");
}

TEST(MetricsText, LabelsMayBeAnyText) {
  MetricsText out(MetricsText::Labels{});
  out.gauge("a", "back\\slash, \"quotes\"\nand a line");
  out.sample(1, {{"l", "q\" b\\ n\nend\xff"}});
  EXPECT_EQ(
      out.text(),
      "# HELP a back\\\\slash, \"quotes\"\\nand a line\n# TYPE a gauge\na{l=\"q\\\" b\\\\ n\\nend\xEF\xBF\xBD\"} 1\n");
}

TEST(MetricsText, NumbersAreWrittenAsPrometheusReadsThem) {
  MetricsText out(MetricsText::Labels{});
  out.gauge("a", "x");
  for (const double value : {0.1, 1795947989.0, 1e22, std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    out.sample(value);
  EXPECT_THAT(out.text(), HasSubstr("a 0.1\na 1795947989\na 1e+22\na +Inf\na -Inf\na NaN\n"));
}

TEST(SlowTiles, TheTenSlowestStay) {
  std::vector<TileTime> slowest;
  for (std::uint64_t i = 0; i < 30; ++i) note_slow_tile(slowest, {"t" + std::to_string(i), (i * 7) % 30, 1});
  ASSERT_EQ(slowest.size(), kSlowestTiles);
  for (std::size_t i = 0; i < slowest.size(); ++i) EXPECT_EQ(slowest[i].microseconds, 29 - i);
  std::vector<TileTime> equal;
  for (const char* name : {"b", "c", "a"}) note_slow_tile(equal, {name, 5, 1});
  EXPECT_EQ(equal[0].tile + equal[1].tile + equal[2].tile, "abc");
}

TEST(RegionTimes, AreSecondsSince1970) {
  EXPECT_EQ(seconds_of("1970-01-02T00:00:01Z"), 86401);
  for (const char* text : {"", "yesterday", "2026-11-26", "2026-11-26T03:00:00Z and more"})
    EXPECT_TRUE(std::isnan(seconds_of(text))) << text;
}

/// A folder as a region has it, with a build of these records.
class Records : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "metrics-" + testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    for (const char* part : {"/builds/000003", "/store", "/log", "/cache"})
      std::filesystem::create_directories(folder_ + part);
    write("/region.toml", "[region]\n");
    write("/store/000003.json", R"({"data_sha256": "x"})");
    write("/builds/000003/build.json",
          R"({"data_time": "2026-11-26T00:00:00Z", "configuration": {"lod": 2}, "program": {"version": "9"},
              "counts": {"buildings_in": 10, "parts_in": 2, "reported": 1, "models_lod1": 3, "models_lod2": 8},
              "issues": {"ROOF_FAILED": 3, "SQUARED": 7, "NEW_ONE": 1}})");
    std::filesystem::create_directory_symlink("builds/000003", folder_ + "/current");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& path, const std::string& text) const { std::ofstream(folder_ + path) << text; }
  std::string metrics(const nlohmann::ordered_json& last, double max_age = 0) const {
    RegionOptions options;
    options.max_age_hours = max_age;
    return region_metrics(RegionFolder(folder_), options, "9", last);
  }
  std::string folder_;
};

TEST_F(Records, OfAFailedRunLeaveTheSuccessBefore) {
  write("/log/runs.jsonl",
        "{\"state\":\"published\",\"ended\":\"1970-01-01T00:01:00Z\"}\nhalf a li\n"
        "{\"state\":\"failed\",\"ended\":\"1970-01-01T00:02:00Z\"}\n");
  const std::string text = metrics({{"state", "failed"}, {"ended", "1970-01-01T00:02:00Z"}, {"seconds", 2.5}}, 2);
  const std::string name = "{region=\"" + RegionFolder(folder_).name() + "\"";
  EXPECT_THAT(text, HasSubstr("blockrand_last_run_state" + name + ",state=\"failed\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("blockrand_last_run_state" + name + ",state=\"published\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("blockrand_last_success_timestamp_seconds" + name + "} 60\n"));
  EXPECT_THAT(text, HasSubstr("blockrand_last_run_timestamp_seconds" + name + "} 120\n"));
  EXPECT_THAT(text, HasSubstr("blockrand_last_run_duration_seconds" + name + "} 2.5\n"));
  EXPECT_THAT(text, HasSubstr("blockrand_runs_total" + name + ",state=\"failed\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("blockrand_data_max_age_seconds" + name + "} 7200\n"));
  EXPECT_THAT(text, HasSubstr("blockrand_models_simpler" + name + "} 3\n"));
  EXPECT_THAT(text, HasSubstr("blockrand_buildings" + name + "} 12\n"));
  EXPECT_THAT(text, HasSubstr(",class=\"fallback\",code=\"ROOF_FAILED\"} 3\n"));
  EXPECT_THAT(text, HasSubstr(",class=\"\",code=\"NEW_ONE\"} 1\n"));
}

TEST_F(Records, WithoutALogTheMarkOfTheBuildTellsTheSuccess) {
  const std::string text = metrics({{"state", "failed"}, {"ended", "1970-01-01T00:02:00Z"}});
  EXPECT_THAT(text, HasSubstr("blockrand_last_success_timestamp_seconds"));
  EXPECT_THAT(text, Not(HasSubstr("blockrand_data_max_age_seconds")));
}

TEST_F(Records, FilesWithTwoNamesCountOnce) {
  write("/builds/000003/big", std::string(1 << 20, 'x'));
  std::filesystem::create_hard_link(folder_ + "/builds/000003/big", folder_ + "/cache/big");
  const std::string text = metrics({});
  const auto bytes = [&](const std::string& folder) {
    const std::size_t at = text.find("folder=\"" + folder + "\"} ");
    return std::stod(text.substr(at + folder.size() + 11));
  };
  EXPECT_GE(bytes("builds"), 1 << 20);
  EXPECT_LT(bytes("cache"), 1 << 20);
}

TEST_F(Records, DataAreTooOldByTheirNewestTime) {
  const RegionFolder region(folder_);
  RegionOptions options;
  const double now = seconds_of("2026-11-27T06:00:00Z");
  EXPECT_EQ(too_old(region, options, now), "");
  options.max_age_hours = 31;
  EXPECT_EQ(too_old(region, options, now), "");
  options.max_age_hours = 26;
  EXPECT_EQ(too_old(region, options, now),
            "the data of build 3 are 30.0 hours old (2026-11-26T00:00:00Z); max_age_hours is 26");
  // A change file that brought nothing makes them newer all the same.
  write("/store/000003.json", R"({"data_sha256": "x", "data_time": "2026-11-27T05:00:00Z"})");
  EXPECT_EQ(too_old(region, options, now), "");
  write("/store/000003.json", R"({"data_sha256": "x"})");
  write("/builds/000003/build.json", R"({"data_time": ""})");
  EXPECT_THAT(too_old(region, options, now), HasSubstr("nobody knows"));
}

TEST_F(Records, OfARunBecomeAReport) {
  const nlohmann::ordered_json run = {{"run", 3},
                                      {"state", "published"},
                                      {"seconds", 4.5},
                                      {"stages", {{"read", 1.25}, {"tiles", 3.0}}},
                                      {"tiles", {{"built", 2}, {"kept", 1}}},
                                      {"slowest_tiles", slowest_tiles_json({{"15_1_2", 2'000'000, 40}})}};
  const std::string text = run_report(RegionFolder(folder_), folder_ + "/builds/000003", run);
  EXPECT_THAT(text, HasSubstr("run 3: published, 4.5 s"));
  EXPECT_THAT(text, HasSubstr("      1.25 s  read\n      3.00 s  tiles\n"));
  EXPECT_THAT(text, HasSubstr("      2.00 s  15_1_2  40 buildings\n"));
  EXPECT_THAT(text, HasSubstr("           3  ROOF_FAILED\n"));
  EXPECT_LT(text.find("ROOF_FAILED"), text.find("SQUARED"));
}

TEST(Refusals, AreOneLine) {
  EXPECT_EQ(refusal({{"max_lost", "buildings that are gone", 1, 2}}), "");
  EXPECT_EQ(refusal({{"max_lost", "buildings that are gone", 12, 2}, {"reference", "worse:\nx", 1, 0}}),
            "buildings that are gone: 12.00 %, max_lost is 2; worse: x (reference)");
}

}  // namespace
}  // namespace blockrand::run
