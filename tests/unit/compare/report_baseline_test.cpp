#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/compare/report_numbers.h"
#include "tests/unit/compare/report_sample.h"

namespace blockrand::compare {
namespace {

using test::sample;
using test::set;
using test::sum_up;
using testing::ElementsAre;
using testing::HasSubstr;

/// Every judged measure has a value away from its ideal.
Comparison measured(double degraded_by = 0, std::optional<Measure> degraded = {}) {
  Comparison c = sample();
  for (MatchResult& match : c.matches)
    for (std::size_t m = 0; m < kMeasureCount; ++m) {
      const bool worse = degraded && static_cast<std::size_t>(*degraded) == m;
      double value = 0.8;
      switch (kMeasures[m].better) {
        case Better::higher:
          if (worse) value *= 1 - degraded_by;
          break;
        case Better::lower:
          if (worse) value *= 1 + degraded_by;
          break;
        case Better::zero:
          value = -0.8 * (worse ? 1 + degraded_by : 1);
          break;
        case Better::one:
          if (worse) value /= 1 + degraded_by;
          break;
        case Better::none:
          value = worse ? 100 : 1;
          break;
      }
      set(match, static_cast<Measure>(m), value);
    }
  sum_up(c);
  return c;
}

BaselineResult against(const Comparison& now, const Comparison& before, double allowed) {
  return compare_with_baseline(now, comparison_json(before, {}), "before.json", allowed);
}

TEST(Baseline, TheSameIsNotWorse) {
  const BaselineResult v = against(measured(), measured(), 0);
  EXPECT_FALSE(v.worse());
  EXPECT_TRUE(v.lost.empty());
  std::size_t validated = 0;
  for (const MeasureInfo& m : kMeasures) validated += m.better != Better::none ? 1 : 0;
  EXPECT_EQ(v.lines.size(), validated + 2) << "missing and extra area";
  for (const auto& line : v.lines) EXPECT_EQ(line.worse_by, 0) << line.measure;
  EXPECT_THAT(baseline_text(v), HasSubstr("not worse than the baseline"));
}

TEST(Baseline, EachMeasureThreePercentWorseFailsAtTwoAndPassesAtFive) {
  for (std::size_t m = 0; m < kMeasureCount; ++m) {
    if (kMeasures[m].better == Better::none) continue;
    const Comparison now = measured(0.03, static_cast<Measure>(m));
    const BaselineResult strict = against(now, measured(), 0.02);
    EXPECT_TRUE(strict.worse()) << kMeasures[m].id;
    for (const auto& line : strict.lines) EXPECT_EQ(line.fails, line.measure == kMeasures[m].id) << line.measure;
    EXPECT_FALSE(against(now, measured(), 0.05).worse()) << kMeasures[m].id;
    EXPECT_FALSE(against(measured(), now, 0).worse()) << kMeasures[m].id << ": better is not worse";
    EXPECT_THAT(baseline_text(strict), HasSubstr("WORSE"));
  }
}

TEST(Baseline, WhatDoesNotJudgeNeverFails) {
  EXPECT_FALSE(against(measured(1, Measure::triangles_model), measured(), 0.02).worse());
}

TEST(Baseline, TheOtherSignIsNotWorse) {
  Comparison now = measured();
  for (MatchResult& match : now.matches) set(match, Measure::eaves_error, 0.8);
  sum_up(now);
  EXPECT_FALSE(against(now, measured(), 0.02).worse());
}

TEST(Baseline, ARatioAboveOneCountsLikeOneBelow) {
  const auto with = [](double ratio) {
    Comparison c = measured();
    for (MatchResult& match : c.matches) set(match, Measure::volume_ratio, ratio);
    sum_up(c);
    return c;
  };
  EXPECT_FALSE(against(with(1.25), with(0.8), 0.001).worse());
  EXPECT_TRUE(against(with(1.04), with(1), 0.02).worse());
  EXPECT_FALSE(against(with(1.01), with(1), 0.02).worse());
  EXPECT_TRUE(against(with(0), with(1), 0.02).worse()) << "nothing is not infinitely much, but worse";
}

TEST(Baseline, RoundingAboutTheIdealIsNotWorse) {
  const auto with = [](double eaves) {
    Comparison c = measured();
    for (MatchResult& match : c.matches) set(match, Measure::eaves_error, eaves);
    sum_up(c);
    return c;
  };
  EXPECT_FALSE(against(with(0.0009), with(0), 0.02).worse());
  EXPECT_TRUE(against(with(0.02), with(0), 0.02).worse());
}

TEST(Baseline, WhatIsLostFails) {
  Comparison now = measured();
  now.matches.pop_back();
  for (MatchResult& match : now.matches) match.values[static_cast<std::size_t>(Measure::opening_recall)] = {};
  sum_up(now);
  const BaselineResult v = against(now, measured(), 0.02);
  EXPECT_TRUE(v.worse());
  EXPECT_THAT(v.lost, testing::Contains("measure opening_recall"));
  EXPECT_THAT(v.lost, testing::Contains("measure eaves_error (in 2 matches, was in 3)"));
  EXPECT_THAT(v.lost_buildings, ElementsAre("r2"));
  EXPECT_THAT(baseline_text(v), HasSubstr("LOST: building r2\n"));
  EXPECT_THAT(failed_text(v), HasSubstr("lost measure opening_recall"));
  EXPECT_THAT(failed_text(v), testing::EndsWith(", 1 building lost"));
  EXPECT_FALSE(against(measured(), now, 0.02).worse()) << "a measure more is no loss";
}

TEST(Baseline, AnotherGroupingIsNoLossButALostHalfIs) {
  // The first two houses as one block.
  Comparison block = measured();
  block.matches[1].id = block.matches[0].id;
  block.matches[1].reference.buildings = block.matches[1].model.buildings = {0, 1};
  block.matches.erase(block.matches.begin());
  sum_up(block);
  EXPECT_FALSE(against(block, measured(), 0.02).worse()) << baseline_text(against(block, measured(), 0.02));
  EXPECT_FALSE(against(measured(), block, 0.02).worse());
  Comparison half = block;
  half.matches[0].reference.buildings = {0};
  EXPECT_THAT(against(half, block, 0.02).lost_buildings, ElementsAre("r1"));
}

TEST(Baseline, AValueInFewerMatchesIsLost) {
  Comparison now = measured();
  now.matches[1].values[static_cast<std::size_t>(Measure::volume_ratio)] = {};
  sum_up(now);
  EXPECT_THAT(against(now, measured(), 0.02).lost, ElementsAre("measure volume_ratio (in 2 matches, was in 3)"));
  EXPECT_FALSE(against(now, measured(), 0.5).worse());
}

TEST(Baseline, MissingAndExtraAreaAreJudged) {
  Comparison now = measured();
  now.extra.push_back(0);
  const BaselineResult v = against(now, measured(), 0.02);
  EXPECT_EQ(failed_text(v), "extra_area");
  EXPECT_FALSE(against(measured(), now, 0.02).worse());
  now.missing.push_back(0);
  EXPECT_EQ(failed_text(against(now, measured(), 0.02)), "missing_area, extra_area");
  auto j = nlohmann::json::parse(comparison_json(measured(), {}));
  j["counts"].erase("missing_area");
  j["counts"].erase("extra_area");
  EXPECT_FALSE(compare_with_baseline(now, j.dump(), "before.json", 0.02).worse()) << "an older baseline";
}

TEST(Baseline, RatiosOnBothSidesOfOneDoNotCancel) {
  Comparison now = measured(), before = measured();
  for (MatchResult& match : before.matches) set(match, Measure::volume_ratio, 1);
  set(now.matches[0], Measure::volume_ratio, 0.5);
  set(now.matches[1], Measure::volume_ratio, 1.5);
  set(now.matches[2], Measure::volume_ratio, 1);
  sum_up(now);
  sum_up(before);
  EXPECT_EQ(failed_text(against(now, before, 0.02)), "volume_ratio");
  // exp((log 2 + log 1.5) / 3)
  EXPECT_NEAR(*headline(info(Measure::volume_ratio), summary_of(now.summaries, Measure::volume_ratio).counted),
              1.442250, 1e-6);
}

TEST(Baseline, WhatWasComparedOtherwiseIsTold) {
  Comparison now = measured();
  now.absolute_heights = true;
  now.reference.crs = "EPSG:25833";
  const BaselineResult v = compare_with_baseline(now, comparison_json(measured(), {{"align", "none"}, {"seed", "1"}}),
                                                 "before.json", 0.02, {{"align", "both"}, {"lod", "2"}});
  EXPECT_FALSE(v.worse());
  EXPECT_THAT(v.differs,
              ElementsAre("CRS was EPSG:25832 and is EPSG:25833", "heights was above own ground and is absolute",
                          "option align was none and is both", "option lod was not set and is 2",
                          "option seed was 1 and is not set"));
  EXPECT_THAT(baseline_text(v), HasSubstr("warning: CRS was EPSG:25832 and is EPSG:25833\n"));
}

TEST(Baseline, IdsWithBrokenCharactersAreFoundAgain) {
  Comparison c = measured();
  c.reference.buildings[0].id = "a\xff";
  EXPECT_FALSE(against(c, c, 0.02).worse());
}

std::string error_of(const std::string& text) {
  try {
    compare_with_baseline(measured(), text, "before.json", 0.02);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Baseline, AnythingElseIsRefusedWithARemedy) {
  EXPECT_THAT(error_of(""), HasSubstr("before.json:byte"));
  EXPECT_THAT(error_of("{\"a\": "), HasSubstr("is no JSON"));
  EXPECT_THAT(error_of("{\"a\": 1e999}"), HasSubstr("cannot be read"));
  EXPECT_THAT(error_of("[]"), HasSubstr("is no comparison"));
  EXPECT_THAT(error_of("{\"format\": \"geojson\"}"), HasSubstr("before.json:format: is no comparison"));
  auto j = nlohmann::json::parse(comparison_json(measured(), {}));
  j["format_version"] = 99;
  EXPECT_THAT(error_of(j.dump()), HasSubstr("has format version 99, and this program reads 1"));
  j["format_version"] = 1;
  j["summary"]["eaves_error"]["counted"]["mean_abs"] = "x";
  EXPECT_THAT(error_of(j.dump()), HasSubstr("summary/eaves_error"));
  j["summary"] = 5;
  EXPECT_THAT(error_of(j.dump()), HasSubstr("before.json:summary"));
  for (const char* text : {"", "[]", "{}"}) EXPECT_THAT(error_of(text), HasSubstr("Give the compare.json"));
}

}  // namespace
}  // namespace blockrand::compare
