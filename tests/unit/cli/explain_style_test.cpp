#include "pipeline/cli/explain_style.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipeline/base/error.h"
#include "pipeline/cli/explain_command.h"
#include "styles/classify/features.h"

namespace blockrand::cli {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Json weights(double gruenderzeit, double modern) {
  return {{"gruenderzeit", gruenderzeit}, {"tenement", 0}, {"modern", modern}, {"other", 0}};
}

Json house() {
  Json style = {
      {"class", "gruenderzeit"},
      {"probabilities", {{"gruenderzeit", 0.8203}, {"tenement", 0.0491}, {"modern", 0.1292}, {"other", 0.0014}}},
      {"era", {{"pre1840", 0.031}, {"1840_1918", 0.91}, {"1919_1945", 0.056}, {"post1945", 0.003}}},
      {"morphology", {{"perimeter_block", 0.97}, {"old_town", 0.03}, {"slab", 0}, {"detached", 0}, {"terrace", 0}}},
      {"substyle", "gz_mk_front"},
      {"substyle_p", 0.6431},
      {"prior", weights(0.2, 0)},
      {"elsewhere", weights(0.75, -0.25)},
      {"second", "modern"},
      {"terms", Json::array()},
      {"changes", Json::array()}};
  const auto term = [](const char* feature, const char* unit, const char* meaning, double value, Json w) -> Json {
    return {{"feature", feature}, {"meaning", meaning}, {"value", value}, {"unit", unit}, {"weights", std::move(w)}};
  };
  style["terms"].push_back(term("position", "", "1 free standing, 2 end of row, 3 mid row", 3, weights(0.1, 0)));
  style["terms"].push_back(term("depth_ratio", "",
                                "greatest depth over depth behind the front: 1.5 and more with wings", 1.8999999,
                                weights(1.5, -0.34)));
  style["terms"].push_back(term("area", "m2", "footprint area", 312.4156, weights(0, 0.4)));
  style["terms"].push_back(
      term("party_share", "", "share of the outline that touches other buildings", 0.4312, weights(0.6, 0)));
  for (int i = 1; i <= 4; ++i)
    style["terms"].push_back(term("row_count", "", "houses in the row", 12 + i, weights(0.25, 0)));
  Json change = style["terms"][1];
  change["high"] = 1.2;
  style["changes"].push_back(change);
  change = style["terms"][0];
  change["low"] = 4.5;
  style["changes"].push_back(change);
  change = style["terms"][2];
  change["low"] = 400;
  change["high"] = 1200;
  style["changes"].push_back(change);
  return style;
}

TEST(ExplainStyle, BeginsWithASentence) {
  EXPECT_THAT(style_text(house(), false),
              testing::StartsWith("\nIts style, and why\n  Gr\u00fcnderzeit house (82 %), sub-style gz_mk_front (64 "
                                  "%): a street-side house of 1840 to 1918 with a\n"
                                  "  composed front. Or else: modern (13 %), tenement (5 %).\n"
                                  "  Era: 1840 to 1918 (91 %), 1919 to 1945 (6 %), before 1840 (3 %).\n"
                                  "  Its quarter: perimeter block (97 %), old town (3 %).\n"));
}

std::string line_with(const std::string& text, const std::string& part) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line.find(part) != std::string::npos) return line;
  return "no line with " + part;
}

TEST(ExplainStyle, WeightsAreThoseAgainstTheNextLikelyAndAddUp) {
  const std::string text = style_text(house(), false);
  EXPECT_THAT(text, HasSubstr("What speaks for gruenderzeit and against modern, the next likely answer."));
  EXPECT_EQ(line_with(text, "greatest depth over"),
            "    +1.84  1.9              greatest depth over depth behind the front: 1.5 and more with wings");
  EXPECT_EQ(line_with(text, "share of the outline"),
            "    +0.60  43 %             share of the outline that touches other buildings");
  EXPECT_EQ(line_with(text, "footprint area"), "    -0.40  312 m\u00b2           footprint area");
  EXPECT_LT(text.find("greatest depth"), text.find("share of the outline")) << "the weightiest first";
  EXPECT_EQ(line_with(text, "lighter ones"),
            "    +0.35                   2 lighter ones together (--style lists them)");
  EXPECT_EQ(line_with(text, "before anything is known"),
            "    +0.20                   how frequent both are before anything is known of it");
  EXPECT_EQ(line_with(text, "its row, its block"),
            "    +1.00                   what is usual in the region, its row, its block and its era");
  // 1.84 + 0.6 - 0.4 + 4 x 0.25 + 0.1 + 0.2 + 1.0
  EXPECT_THAT(line_with(text, "together: gr"),
              AllOf(HasSubstr("+4.34"), HasSubstr("gruenderzeit is 77 times as likely as modern")));
}

TEST(ExplainStyle, AllIsListedOnDemand) {
  const std::string text = style_text(house(), true);
  EXPECT_THAT(text, Not(HasSubstr("--style")));
  EXPECT_EQ(line_with(text, "how it stands "), "no line with how it stands ");
  EXPECT_EQ(line_with(text, "+0.10"), "    +0.10  within a row     how it stands");
}

TEST(ExplainStyle, SaysWhatWouldHaveToChange) {
  const std::string text = style_text(house(), false);
  EXPECT_THAT(text, HasSubstr("\n  It would be modern if\n"
                              "    greatest depth over depth behind the front: below 1.2 (is 1.9)\n"
                              "    or how it stands: rear building or wing (is within a row)\n"
                              "    or footprint area: 400 m\u00b2 to 1200 m\u00b2 (is 312 m\u00b2)\n"));
  Json none = house();
  none["changes"].clear();
  EXPECT_THAT(style_text(none, false), HasSubstr("No single thing about it would make it modern."));
}

TEST(ExplainStyle, CountsAreWhole) {
  Json style = house();
  style["changes"].clear();
  Json change = {{"feature", "corners"}, {"meaning", "corners"}, {"value", 4}, {"weights", weights(0, 0)}};
  const auto with = [&](double low, double high) {
    Json c = change;
    if (low >= 0) c["low"] = low;
    if (high >= 0) c["high"] = high;
    style["changes"] = Json::array({c});
    return line_with(style_text(style, false), "corners: ");
  };
  EXPECT_EQ(with(0.5, 1.5), "    corners: 1 (is 4)");
  EXPECT_EQ(with(1.5, 4.5), "    corners: 2 to 4 (is 4)");
  EXPECT_EQ(with(-1, 2.5), "    corners: at most 2 (is 4)");
  EXPECT_EQ(with(5.5, -1), "    corners: 6 and more (is 4)");
}

TEST(ExplainStyle, OfWhatIsNoHouseTheRuleIsTold) {
  Json shed = house();
  shed["class"] = "other";
  shed["probabilities"] = {{"gruenderzeit", 0}, {"tenement", 0}, {"modern", 0.0004}, {"other", 0.9996}};
  shed["rule"] = "building=garage: a garage";
  const std::string text = style_text(shed, false);
  EXPECT_THAT(text, AllOf(HasSubstr("Other building (> 99 %)"),
                          HasSubstr("A stated rule says that it is no house (building=garage: a garage)")));
  EXPECT_THAT(text, Not(HasSubstr("What speaks for"))) << "its shape did not decide";
  EXPECT_THAT(style_text(shed, true), AllOf(HasSubstr("What speaks for"), Not(HasSubstr("It would be"))));
}

TEST(ExplainStyle, YearsAreToldAsTagged) {
  Json style = house();
  style["years"] = {1890, 1895};
  EXPECT_THAT(style_text(style, false), HasSubstr("; tagged 1890 to 1895."));
  style["years"] = {1890, 1890};
  EXPECT_THAT(style_text(style, false), HasSubstr("; tagged 1890."));
}

TEST(ExplainStyle, ValuesAreForPeople) {
  EXPECT_EQ(value_in_words("area", "m2", "footprint area", 1234.567), "1235 m\u00b2");
  EXPECT_EQ(value_in_words("frontage", "m", "width of the main front", 19.87654), "19.9 m");
  EXPECT_EQ(value_in_words("setback", "m", "main front behind the building line", -0.001), "0 m");
  EXPECT_EQ(value_in_words("street_angle", "degree", "between", 3.256), "3.26\u00b0");
  EXPECT_EQ(value_in_words("town_density", "1/ha", "buildings per hectare", 20), "20 per ha");
  EXPECT_EQ(value_in_words("block_area", "ha", "area of the block", 1.5), "1.5 ha");
  EXPECT_EQ(value_in_words("block_court", "", "courtyards' share of the block", 0.256), "26 %");
  EXPECT_EQ(value_in_words("tag_year", "", "year of construction", 1905), "1905");
  EXPECT_EQ(value_in_words("tag_use", "", "use", 9), "church");
  EXPECT_EQ(value_in_words("tag_number", "", "1 with, 0 without a house number", 1), "with");
  EXPECT_EQ(value_in_words("position", "", "position", 99), "99") << "no name for it";
  EXPECT_EQ(era_in_words("pre1840"), "before 1840");
}

/// Numbers that stand for things are listed in the meaning ("1 flat, 2 gabled"): people are told the thing.
TEST(ExplainStyle, EveryFeatureOfCategoriesHasWords) {
  for (const classify::FeatureInfo& f : classify::kFeatures) {
    const bool categories =
        f.meaning.find("1 ") != std::string_view::npos && f.meaning.find(", 2 ") != std::string_view::npos;
    if (!categories) continue;
    EXPECT_THAT(value_in_words(f.name, f.unit, f.meaning, 2), testing::MatchesRegex("[a-z ]+")) << f.name;
  }
}

/// Numbers without a unit that are shares read as percents, and only they.
TEST(ExplainStyle, SharesArePercents) {
  int shares = 0;
  for (const classify::FeatureInfo& f : classify::kFeatures) {
    const bool percent = value_in_words(f.name, f.unit, f.meaning, 0.5) == "50 %";
    const bool share = f.name.ends_with("_share") || f.name.ends_with("_built") || f.name.ends_with("_rear") ||
                       f.name == "around_depth_ratio" || f.name == "row_alike" || f.name == "block_closure" ||
                       f.name == "block_court";
    EXPECT_EQ(percent, share) << f.name;
    shares += share;
  }
  EXPECT_GT(shares, 10);
}

// ---- the whole text

outputs::FoundExplanation found(const Json& style) {
  Json line = {
      {"id", "w7"},
      {"state", "modelled"},
      {"tags", Json::object()},
      {"stages", Json::array()},
      {"attributes",
       Json::array({{{"name", "era"}, {"value", "1840_1918"}, {"source", "geometry"}, {"confidence", 0.91}},
                    {{"name", "substyle"}, {"value", "gz_mk_front"}, {"source", "geometry"}, {"confidence", 0.64}},
                    {{"name", "preset"}, {"value", ""}, {"source", "default"}, {"confidence", 0}}})},
      {"bodies", Json::array({{{"id", "w7"}, {"built_roof", "gabled"}}})},
      {"notes", Json::array()}};
  if (!style.is_null()) line["style"] = style;
  outputs::FoundExplanation f;
  f.asked = f.explained = {model::OsmType::way, 7};
  f.json = line.dump();
  f.in_model = true;
  return f;
}

TEST(ExplainStyle, StandsInTheExplanation) {
  const std::string text = explanation_text(found(house()));
  EXPECT_THAT(text, AllOf(HasSubstr("\nIts style, and why\n"), HasSubstr("--style lists them")));
  EXPECT_THAT(explanation_text(found(house()), "", false, true), Not(HasSubstr("--style lists them")));
  EXPECT_THAT(explanation_text(found(nullptr)), Not(HasSubstr("Its style")));
  EXPECT_THAT(line_with(text, "  era"), HasSubstr("1840 to 1918"));
  EXPECT_THAT(line_with(text, "  substyle"), HasSubstr("gz_mk_front"));
  EXPECT_EQ(line_with(text, "  preset"), "no line with   preset") << "nothing is known";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 102u) << line;
}

TEST(PlainText, IsWrappedByLettersAndCannotSteerTheTerminal) {
  outputs::FoundExplanation f = found(nullptr);
  Json j = Json::parse(f.json);
  j["name"] = "Улица\u009b31m Ленина\n  forged";
  f.json = j.dump();
  const std::string text = plain_text(f);
  EXPECT_THAT(text, testing::StartsWith("Улица\uFFFD31m Ленина   forged\n\n  What it is: "));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    EXPECT_LE(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; }), 100) << line;
  f.json = "{}";
  EXPECT_THROW(plain_text(f), base::InputError) << "no line of an explanation";
  f.json = "{\"id\":\"w7\",\"bodies\":[]}";
  EXPECT_THROW(plain_text(f), base::InputError);
}

TEST(ExplainStyle, DamageIsNamed) {
  Json style = house();
  style.erase("prior");
  EXPECT_THROW(explanation_text(found(style)), std::exception);
}

}  // namespace
}  // namespace blockrand::cli
