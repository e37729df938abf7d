// compare.json, compare.csv, compare.gpkg and the tables for a terminal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipeline/base/error.h"
#include "tests/unit/compare/report_sample.h"

namespace blockrand::compare {
namespace {

using nlohmann::json;
using test::sample;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(ComparisonJson, HoldsEveryMeasureOfEveryMatch) {
  const json j = json::parse(comparison_json(sample(), {{"--align", "none"}}));
  EXPECT_EQ(j["format"], "blockrand-compare");
  EXPECT_EQ(j["options"]["--align"], "none");
  ASSERT_EQ(j["matches"].size(), 3u);
  EXPECT_EQ(j["summary"].size(), kMeasureCount);
  for (const json& match : j["matches"]) EXPECT_EQ(match["measures"].size(), kMeasureCount);
  EXPECT_EQ(j["matches"][0]["id"], test::kNastyId);
  EXPECT_EQ(j["matches"][0]["reference"]["buildings"][0], test::kNastyId);
  EXPECT_DOUBLE_EQ(j["matches"][2]["measures"]["distance_rms"]["counted"], 2.5);
  EXPECT_DOUBLE_EQ(j["matches"][2]["measures"]["distance_rms"]["left_out"], 0.2);
  EXPECT_DOUBLE_EQ(j["matches"][0]["measures"]["volume_ratio"]["counted"], 1.055556) << "six decimals";
  EXPECT_TRUE(j["matches"][1]["measures"]["volume_ratio"]["counted"].is_null());
  EXPECT_TRUE(j["matches"][1]["reference"]["volume"].is_null());
  EXPECT_EQ(j["summary"]["volume_ratio"]["counted"]["count"], 2);
  EXPECT_TRUE(j["summary"]["axes_error"]["counted"]["pooled"].is_null());
  EXPECT_EQ(j["matches"][0]["facades"]["pairs"][0]["matched_openings"], 1);
  EXPECT_TRUE(j["matches"][0]["facades"]["pairs"][1]["model"].is_null());
  EXPECT_EQ(j["roof_confusion"]["flat"]["flat"], 3);
  EXPECT_EQ(j["reference"]["files"][0]["notes"][0]["examples"][0], "line 7: <\"1\">");
}

TEST(ComparisonJson, SaysWhereTheUnmatchedStand) {
  const json j = json::parse(comparison_json(sample(), {}));
  ASSERT_EQ(j["missing"].size(), 1u);
  EXPECT_EQ(j["missing"][0]["id"], "r_missing");
  EXPECT_DOUBLE_EQ(j["missing"][0]["place"][0], 500000 - 75);
  EXPECT_DOUBLE_EQ(j["missing"][0]["place"][1], 5400004);
  EXPECT_EQ(j["extra"][0]["id"], "w_extra");
}

TEST(ComparisonJson, KeysStandInTheSameOrder) {
  std::vector<std::string> keys;
  const auto j = nlohmann::ordered_json::parse(comparison_json(sample(), {}));
  for (const auto& [key, value] : j.items()) keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("format", "format_version", "program", "program_version", "options", "crs", "heights",
                                "model", "reference", "registration", "counts", "summary", "distances",
                                "roof_confusion", "totals", "missing", "extra", "matches"));
  EXPECT_EQ(comparison_json(sample(), {}), comparison_json(sample(), {}));
}

TEST(ComparisonJson, NoNumberIsNotANumber) {
  Comparison c = sample();
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  test::set(c.matches[0], Measure::eaves_error, nan);
  c.matches[0].values[0].weight = inf;
  c.matches[0].reference.volume = -inf;
  c.matches[1].facades.model.emplace_back().area = nan;
  c.summaries[0].counted.pooled = nan;
  c.distances.to_model[0] = nan;
  c.reference.buildings.back().footprint_area = inf;
  const std::string text = comparison_json(c, {});
  const json j = json::parse(text);
  EXPECT_TRUE(j["matches"][0]["measures"]["eaves_error"]["counted"].is_null());
  EXPECT_TRUE(j["matches"][0]["reference"]["volume"].is_null());
  EXPECT_TRUE(j["distances"]["reference_to_model"][0].is_null());
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  EXPECT_THAT(text, Not(HasSubstr("inf,")));
  EXPECT_THAT(comparison_csv(c), Not(HasSubstr("nan")));
  EXPECT_THAT(comparison_text(c), Not(HasSubstr("nan")));
}

TEST(ComparisonJson, SaysWhatIsLeftOutAndHowMuchOfTheUnmatchedIsCovered) {
  const json j = json::parse(comparison_json(sample(), {}));
  const json& pairs = j["matches"][0]["facades"]["pairs"];
  EXPECT_EQ(pairs[0]["left_out"], false);
  EXPECT_EQ(pairs[1]["left_out"], true);
  EXPECT_EQ(j["missing"][0]["covered"], 0.25);
  EXPECT_EQ(j["extra"][0]["covered"], 0);
}

TEST(ComparisonCsv, HoldsNoFormulas) {
  for (const std::string id : {"=1+2", "+1", "-1", "@SUM(A1)", "\t=1"}) {
    Comparison c = sample(1);
    c.matches[0].id = id;
    EXPECT_THAT(comparison_csv(c), HasSubstr("\n'" + id.substr(0, 1))) << id;
  }
  Comparison c = sample(1);
  c.matches[0].id = "a=1";
  EXPECT_THAT(comparison_csv(c), HasSubstr("\na=1,"));
}

TEST(ComparisonJson, BrokenUtf8IsReplaced) {
  Comparison c = sample(1);
  c.matches[0].id =
      "a\xff"
      "b";
  EXPECT_EQ(json::parse(comparison_json(c, {}))["matches"][0]["id"],
            "a\xEF\xBF\xBD"
            "b");
}

/// RFC 4180 as a reader sees it.
std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (quoted) {
      if (c == '"' && i + 1 < csv.size() && csv[i + 1] == '"') {
        rows.back().back() += '"';
        ++i;
      } else if (c == '"') {
        quoted = false;
      } else {
        rows.back().back() += c;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      rows.back().emplace_back();
    } else if (c == '\n') {
      rows.push_back({""});
    } else if (c != '\r') {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

TEST(ComparisonCsv, HasARowPerMatchAndTwoColumnsPerMeasure) {
  const auto rows = rows_of(comparison_csv(sample()));
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows) EXPECT_EQ(row.size(), 5 + 2 * kMeasureCount);
  EXPECT_EQ(rows[0][5], "footprint_iou");
  EXPECT_EQ(rows[0][6], "footprint_iou_all");
  EXPECT_EQ(rows[1][0], test::kNastyId);
  EXPECT_EQ(rows[1][3], "500005");
  EXPECT_EQ(rows[1][5], "1");
  EXPECT_EQ(rows_of(comparison_csv(sample(0))).size(), 1u);
}

class GeoPackage : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() / ("blockrand-compare-" + std::to_string(::getpid()) + "-" +
                                                       testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string write(const Comparison& c, const std::string& name) const {
    const std::string path = (folder / name).string();
    write_geopackage(c, path);
    return path;
  }
  static std::string query(const std::string& path, const std::string& sql) {
    sqlite3* db = nullptr;
    std::string out;
    EXPECT_EQ(sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    char* error = nullptr;
    sqlite3_exec(
        db, sql.c_str(),
        [](void* to, int n, char** values, char**) {
          for (int i = 0; i < n; ++i)
            *static_cast<std::string*>(to) += std::string(values[i] ? values[i] : "NULL") + (i + 1 < n ? "|" : "\n");
          return 0;
        },
        &out, &error);
    EXPECT_EQ(error, nullptr) << error;
    sqlite3_close(db);
    return out;
  }
  static std::string bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::filesystem::path folder;
};

TEST_F(GeoPackage, HasThreeLayersInTheCrs) {
  const std::string path = write(sample(), "a.gpkg");
  EXPECT_EQ(query(path, "SELECT table_name, srs_id FROM gpkg_contents ORDER BY table_name"),
            "matches|25832\nmodel|25832\nreference|25832\n");
  EXPECT_EQ(query(path, "SELECT count(*), min(distance_rms), max(distance_rms) FROM matches"), "3|0.5|2.5\n");
  EXPECT_EQ(query(path, "SELECT state, count(*) FROM reference GROUP BY state"), "matched|3\nmissing|1\n");
  EXPECT_EQ(query(path, "SELECT state, count(*) FROM model GROUP BY state"), "extra|1\nmatched|3\n");
  EXPECT_EQ(query(path, "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'matches'"),
            "500000.0|5400000.0|500070.0|5400008.0\n");
  EXPECT_EQ(query(path, "SELECT id FROM matches WHERE fid = 1"), test::kNastyId + "\n");
  EXPECT_EQ(query(path, "SELECT volume_ratio FROM matches WHERE fid = 2"), "NULL\n");
  EXPECT_EQ(query(path, "SELECT count(*) FROM gpkg_data_columns WHERE table_name = 'matches'"),
            std::to_string(6 + 2 * kMeasureCount) + "\n");
  EXPECT_EQ(query(path, "PRAGMA integrity_check"), "ok\n");
}

TEST_F(GeoPackage, IsTheSameEveryTime) {
  EXPECT_EQ(bytes(write(sample(), "a.gpkg")), bytes(write(sample(), "b.gpkg")));
}

TEST_F(GeoPackage, IsWrittenWithoutMatchesAndFootprints) {
  Comparison c = sample(0);
  c.model.buildings[0].footprint.clear();
  EXPECT_EQ(query(write(c, "a.gpkg"),
                  "SELECT (SELECT count(*) FROM matches), (SELECT count(*) FROM model WHERE geom IS NULL)"),
            "0|1\n");
}

TEST_F(GeoPackage, SaysWhyItCannotBeWritten) {
  const std::string path = write(sample(0), "a.gpkg");
  EXPECT_THROW(write_geopackage(sample(0), path), base::OutputError) << "a file stands there already";
  EXPECT_THROW(write_geopackage(sample(0), (folder / "none" / "a.gpkg").string()), base::OutputError);
}

TEST(ComparisonText, FitsATerminalAndTellsWhatIsLeftOut) {
  const std::string text = comparison_text(sample());
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto width =
        std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
    EXPECT_LE(width, 115) << line;
  }
  EXPECT_THAT(text, HasSubstr("matched   3; missing from the model: 1; only in the model: 1"));
  EXPECT_THAT(text, HasSubstr("surface distance, RMS                 3      1.71      1.71    20.0 %"));
  EXPECT_THAT(text, HasSubstr("eaves height error                    3     +0.50     +0.50"));
  EXPECT_THAT(text, Not(HasSubstr("axes error"))) << "a measure without any value is no line";
  EXPECT_THAT(comparison_text(sample(0)), HasSubstr("no matches"));
}

}  // namespace
}  // namespace blockrand::compare
