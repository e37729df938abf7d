#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipeline/outputs/explain/explanation.h"
#include "pipeline/outputs/gzip.h"
#include "tests/unit/outputs/row_sample.h"
#include "tests/unit/outputs/sample_region.h"

namespace blockrand::outputs {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

ExplainOptions plain_options() {
  ExplainOptions o;
  o.tile = "15_1_2";
  o.files = {"tiles/15/1/2.glb"};
  o.final_state = [](std::uint32_t) { return FinalState{model::ObjectState::modelled, model::IssueCode::none, {}}; };
  return o;
}

std::map<std::string, json> lines_of(const std::string& text) {
  std::map<std::string, json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const json j = json::parse(line);
    EXPECT_TRUE(lines.emplace(j.at("id"), j).second) << line;
  }
  return lines;
}

TEST(Explain, EveryOwnedBuildingHasOneLineOfJson) {
  const auto zoo = test::SampleRegion::zoo();
  const Explanations out = explain(zoo.region(), plain_options());
  const auto lines = lines_of(out.lines);
  std::size_t owned = 0;
  for (const model::Building& b : zoo.region().buildings) {
    EXPECT_EQ(lines.count(b.id()), b.owned) << b.id();
    owned += b.owned;
  }
  EXPECT_EQ(lines.size(), owned);
  for (const auto& [object, building] : out.objects) EXPECT_TRUE(lines.count(building.text())) << object.text();
  EXPECT_EQ(explain(zoo.region(), plain_options()).lines, out.lines);
}

TEST(Explain, ValuesCarrySourceReasonAndWhatLost) {
  test::SampleRegion sample;
  model::Building& b = sample.add_building(7, {{"building", "house"}, {"name", "a \"quoted\"\nname"}});
  sample.add_box(b, "w7", 0, 0, 10, 8, 0, 6);
  auto& region = sample.region();
  b.attributes.storeys = {
      4, model::Source::neighbours, 0.6f,
      region.evidence.add({"median of 7 neighbours", {{model::Source::preset, 0.3f, "3", "usual for houses"}}})};
  const json line = lines_of(explain(region, plain_options()).lines).at("w7");
  EXPECT_EQ(line.at("name"), "a \"quoted\"\nname");
  EXPECT_EQ(line.at("tags").at("building"), "house");
  bool seen = false;
  for (const json& a : line.at("attributes")) {
    if (a.at("name") != "storeys") continue;
    seen = true;
    EXPECT_EQ(a.at("value"), 4);
    EXPECT_EQ(a.at("source"), "neighbours");
    EXPECT_NEAR(a.at("confidence").get<double>(), 0.6, 1e-6);
    EXPECT_EQ(a.at("why"), "median of 7 neighbours");
    ASSERT_EQ(a.at("lost").size(), 1u);
    EXPECT_EQ(a.at("lost")[0], json({{"value", "3"},
                                     {"source", "preset"},
                                     {"confidence", a.at("lost")[0].at("confidence")},
                                     {"why", "usual for houses"}}));
  }
  EXPECT_TRUE(seen);
}

TEST(Explain, NotesComeFromBeforeAndFromTheTile) {
  test::SampleRegion sample;
  model::Building& b = sample.add_building(7, {{"building", "yes"}});
  sample.add_box(b, "w7", 0, 0, 10, 8, 0, 6);
  const model::OsmId seven{model::OsmType::way, 7}, eight{model::OsmType::way, 8};
  sample.region().report.add(eight, model::IssueCode::spike_removed, "of another");
  sample.region().report.add(seven, model::IssueCode::spike_removed, "1 points");
  const std::vector<model::ReportRow> earlier = {{seven, model::IssueCode::value_unreadable, "height=tall"},
                                                 {eight, model::IssueCode::value_clamped, "x"}};
  ExplainOptions options = plain_options();
  options.earlier = earlier;
  const json line = lines_of(explain(sample.region(), options).lines).at("w7");
  ASSERT_EQ(line.at("notes").size(), 2u);
  EXPECT_EQ(line.at("notes")[0].at("code"), "VALUE_UNREADABLE");
  EXPECT_EQ(line.at("notes")[0].at("detail"), "height=tall");
  EXPECT_EQ(line.at("notes")[1].at("code"), "SPIKE_REMOVED");
  std::map<std::string, std::string> stages;
  for (const json& s : line.at("stages")) stages[s.at("stage")] = s.at("text");
  EXPECT_THAT(stages.at("read"), HasSubstr("height=tall"));
  EXPECT_THAT(stages.at("repair"), HasSubstr("1 points"));
}

TEST(Explain, SaysThatSurroundingsWereNotLookedAt) {
  test::SampleRegion sample;
  model::Building& b = sample.add_building(7, {{"building", "yes"}});
  sample.add_box(b, "w7", 0, 0, 10, 8, 0, 6);
  b.outline = {b.parts[0].plan};
  const json line = lines_of(explain(sample.region(), plain_options()).lines).at("w7");
  EXPECT_EQ(line.at("stages")[2].at("stage"), "context");
  EXPECT_EQ(line.at("stages")[2].at("text"), "its surroundings were not looked at");
}

std::map<std::string, std::string> stages_of(const json& line) {
  std::map<std::string, std::string> stages;
  for (const json& s : line.at("stages")) stages[s.at("stage")] = s.at("text");
  return stages;
}

TEST(ExplainRow, SaysHowAHouseStands) {
  ExplainOptions options = plain_options();
  options.courtyard = [](std::string_view id) {
    EXPECT_EQ(id, "w1.y7_8");
    return CourtyardFacts{312.4, true};
  };
  const auto lines = lines_of(explain(test::row_sample().region(), options).lines);
  EXPECT_EQ(
      stages_of(lines.at("w1")).at("context"),
      "corner house; fronts on Oderberger Straße (14.0 m, looks W) and Kastanienallee (12.0 m, looks S); "
      "1 mapped entrance; walls shared with w2 (14.0 m); 14.0 m deep and 12.0 m wide; stands at a closed courtyard "
      "of 312 m2; in block w900.n5.l");
  EXPECT_EQ(
      stages_of(lines.at("w2")).at("context"),
      "within a row; front on Kastanienallee (14.7 m, looks S); a passage 3.3 m wide; walls shared with w3 (14.0 m) "
      "and w1 (14.0 m); 14.0 m deep and 18.0 m wide; 0.4 m behind the building line of the street; stands at a "
      "closed courtyard of 312 m2; in block w900.n5.l");
  EXPECT_EQ(
      stages_of(lines.at("w4")).at("context"),
      "rear building (Hinterhaus); no wall is shared with a neighbour; 9.0 m deep and 12.0 m wide; stands at a closed "
      "courtyard of 312 m2; in block w900.n5.l");
}

TEST(ExplainRow, SaysWhatRepairDid) {
  auto sample = test::row_sample();
  model::Building& fourth = sample.region().buildings.at(3);
  fourth.repaired.moved = 1;
  fourth.repaired.mean_shift = fourth.repaired.max_shift = 0.2;
  fourth.repaired.overlaps_resolved = 1;
  fourth.repaired.overlap_left = 0.25;
  const auto lines = lines_of(explain(sample.region(), plain_options()).lines);
  EXPECT_EQ(stages_of(lines.at("w1")).at("repair"), "no corner was moved; the footprint has 4 points and 168.0 m2");
  EXPECT_EQ(
      stages_of(lines.at("w2")).at("repair"),
      "3 of 4 corners moved by 0.08 m on average, 0.31 m at most, to share 2 walls with w3 and w1 and to make corners "
      "right; 1 gap between walls closed; area 251.4 -> 252.0 m2; the footprint has 4 points and 252.0 m2");
  EXPECT_EQ(
      stages_of(lines.at("w4")).at("repair"),
      "1 of 4 corners moved by 0.20 m on average, 0.20 m at most, to resolve 1 overlap; 0.2 m2 still overlap with "
      "others; 1 curve kept; the footprint has 4 points and 108.0 m2");
}

TEST(ExplainRow, MachinesReadTheSame) {
  const auto lines = lines_of(explain(test::row_sample().region(), plain_options()).lines);
  const json& line = lines.at("w2");
  EXPECT_EQ(line.at("repair"), json({{"vertices", 4},
                                     {"moved", 3},
                                     {"mean_shift", 0.082},
                                     {"max_shift", 0.31},
                                     {"mapped_area", 251.4},
                                     {"area", 252},
                                     {"shared_walls", 2},
                                     {"gaps_closed", 1},
                                     {"overlaps_resolved", 0},
                                     {"overlap_left", 0},
                                     {"direction", 90}}));
  EXPECT_EQ(line.at("situation"), json({{"position", "mid_row"},
                                        {"orientation", 180},
                                        {"depth", 14},
                                        {"width", 18},
                                        {"setback", 0.4},
                                        {"party_wall_length", 28},
                                        {"block", "w900.n5.l"},
                                        {"courtyards", {"w1.y7_8"}}}));
  const json& edges = line.at("edges");
  ASSERT_EQ(edges.size(), 6u);
  EXPECT_EQ(edges[1], json({{"id", "w2.e20_21.1"},
                            {"kind", "passage"},
                            {"confidence", 0.9},
                            {"length", 3.3},
                            {"looks", "S"},
                            {"street", "w900"},
                            {"street_name", "Kastanienallee"},
                            {"street_class", "residential"},
                            {"street_distance", 11.5},
                            {"street_angle", 0.2},
                            {"visibility", 1}}));
  EXPECT_EQ(edges[2].at("front"), true);
  EXPECT_EQ(lines.at("w1").at("edges")[0].at("points"),
            json({{{"id", "n71"}, {"entrance", true}, {"house_number", "7"}},
                  {{"id", "n72"}, {"entrance", false}, {"house_number", "7a"}},
                  {{"id", "n73"}, {"entrance", false}, {"house_number", "7"}}}));
  EXPECT_FALSE(edges[2].contains("points"));
  EXPECT_EQ(edges[3].at("neighbour"), "w3");
  EXPECT_EQ(lines.at("w4").at("edges")[2].at("radius"), 6.25);
}

TEST(ExplainRow, FrontsWithoutAStreetsNameAndTrees) {
  auto sample = test::row_sample();
  model::Building& b = sample.region().buildings.at(2);
  b.edges[0].street_name.clear();
  b.edges[0].street_class = "living_street";
  b.edges[0].chamfer = true;
  b.trees = {{{model::OsmType::node, 77}, {391040, 5819003}, 0, 3.25f}};
  const auto lines = lines_of(explain(sample.region(), plain_options()).lines);
  const std::string text = stages_of(lines.at("w3")).at("context");
  EXPECT_THAT(text, HasSubstr("end of a row; front on w900 (living street without a name) (15.0 m, looks S)"));
  EXPECT_THAT(text, HasSubstr("the street corner is cut off"));
  EXPECT_THAT(text, HasSubstr("1 tree before its walls"));
  EXPECT_THAT(text, HasSubstr("stands at the courtyard w1.y7_8"));
  EXPECT_EQ(lines.at("w3").at("situation").at("trees"), json::array({{{"id", "n77"}, {"distance", 3.25}}}));
}

TEST(ExplainRow, WithoutRepairAndContextNothingIsClaimed) {
  const auto zoo = test::SampleRegion::zoo();
  for (const auto& [id, line] : lines_of(explain(zoo.region(), plain_options()).lines))
    for (const char* key : {"repair", "situation", "edges"}) EXPECT_FALSE(line.contains(key)) << id;
}

TEST(Explain, WhatWasNotBuiltSaysWhy) {
  test::SampleRegion sample;
  sample.add_building(7, {{"building", "yes"}});
  ExplainOptions options = plain_options();
  options.final_state = [](std::uint32_t) {
    return FinalState{model::ObjectState::reported, model::IssueCode::zero_area, {}};
  };
  const json line = lines_of(explain(sample.region(), options).lines).at("w7");
  EXPECT_EQ(line.at("state"), "reported");
  EXPECT_EQ(line.at("code"), "ZERO_AREA");
  EXPECT_TRUE(line.at("files").empty()) << "no file shows it";
  EXPECT_THAT(line.at("stages").back().at("text"), HasSubstr("nothing was built"));
}

TEST(Explain, GivesPiecesThatAreTheWhole) {
  const test::SampleRegion town = test::SampleRegion::settlement(2000, false);
  const Explanations whole = explain(town.region(), plain_options());
  ASSERT_GT(whole.lines.size(), 2 * kExplainedPiece) << "several pieces";
  std::string joined;
  std::size_t pieces = 0;
  const Explanations rest = explain(town.region(), plain_options(), [&](std::string_view piece) {
    EXPECT_TRUE(piece.ends_with('\n'));
    EXPECT_LT(piece.size(), kExplainedPiece + 200'000);
    joined += piece;
    ++pieces;
  });
  EXPECT_GT(pieces, 2u);
  EXPECT_TRUE(rest.lines.empty());
  EXPECT_EQ(joined, whole.lines);
  EXPECT_EQ(rest.objects, whole.objects);
}

TEST(Gzip, ComesBackAndNoticesDamage) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += std::to_string(i * 7919 % 1000);
  const std::string packed = gzip(text, 4);
  EXPECT_LT(packed.size(), text.size());
  EXPECT_EQ(gunzip(packed), text);
  EXPECT_EQ(gunzip(gzip("")), "");
  const std::string members = packed + gzip("") + gzip("more", 9, "a comment") + packed;
  EXPECT_EQ(gunzip(members), text + "more" + text);
  EXPECT_THROW(gunzip(members.substr(0, packed.size() + 5)), std::runtime_error) << "the second member is cut off";
  EXPECT_THROW(gunzip(packed.substr(0, packed.size() / 2)), std::runtime_error);
  EXPECT_THROW(gunzip(""), std::runtime_error);
  std::string damaged = packed;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 0x55);
  EXPECT_THROW(gunzip(damaged), std::runtime_error);
}

/// A house that classification looked at.
model::Building& classified(test::SampleRegion& sample) {
  model::Building& b = sample.add_building(7, {{"building", "yes"}});
  sample.add_box(b, "w7", 0, 0, 10, 8, 0, 6);
  b.style.style = {0.825f, 0.05f, 0.11f, 0.015f};
  b.style.era = {0.0625f, 0.875f, 0.03125f, 0.03125f};
  b.style.morphology = {0.75f, 0, 0.25f, 0, 0};
  b.style.substyle_p = 0.64f;
  b.style.years = model::YearRange{1890, 1895};
  b.attributes.substyle.value = "gz_mk_front";
  b.style_why.second = model::StyleClass::modern;
  b.style_why.prior = {0.125f, -0.125f, 0, 0};
  b.style_why.elsewhere = {1.3333334f, 0, -1, 0};
  b.style_why.terms = {
      {"depth_ratio",
       "",
       "greatest depth: wings",
       1.9f,
       1.5f,
       std::numeric_limits<float>::infinity(),
       {2.f, 1.f, -0.5f, 0.f}},
      {"area", "m2", "footprint area", 312.40001f, -std::numeric_limits<float>::infinity(), 400.f, {0.25f, 0, 0, 0}}};
  b.style_why.changes = {{"depth_ratio",
                          "",
                          "greatest depth: wings",
                          1.9f,
                          -std::numeric_limits<float>::infinity(),
                          1.2f,
                          {-2.f, 0, 1.f, 0}}};
  return b;
}

TEST(ExplainStyle, IsToldToMachines) {
  test::SampleRegion sample;
  classified(sample);
  const json style = lines_of(explain(sample.region(), plain_options()).lines).at("w7").at("style");
  EXPECT_EQ(style.at("class"), "gruenderzeit");
  EXPECT_EQ(style.at("probabilities"),
            json({{"gruenderzeit", 0.825}, {"tenement", 0.05}, {"modern", 0.11}, {"other", 0.015}}));
  EXPECT_EQ(style.at("era"),
            json({{"pre1840", 0.0625}, {"1840_1918", 0.875}, {"1919_1945", 0.0312}, {"post1945", 0.0312}}));
  EXPECT_EQ(style.at("morphology").at("slab"), 0.25);
  EXPECT_EQ(style.at("years"), json({1890, 1895}));
  EXPECT_EQ(style.at("substyle"), "gz_mk_front");
  EXPECT_EQ(style.at("substyle_p"), 0.64);
  EXPECT_EQ(style.at("second"), "modern");
  EXPECT_EQ(style.at("prior").at("gruenderzeit"), 0.125);
  EXPECT_EQ(style.at("elsewhere").at("gruenderzeit"), 1.333) << "weights have three decimals";
  EXPECT_FALSE(style.contains("rule"));
  ASSERT_EQ(style.at("terms").size(), 2u);
  EXPECT_EQ(style.at("terms")[0],
            json({{"feature", "depth_ratio"},
                  {"meaning", "greatest depth: wings"},
                  {"value", 1.9},
                  {"low", 1.5},
                  {"weights", {{"gruenderzeit", 2}, {"tenement", 1}, {"modern", -0.5}, {"other", 0}}}}))
      << "an open bin has no high";
  EXPECT_EQ(style.at("terms")[1].at("unit"), "m2");
  EXPECT_EQ(style.at("terms")[1].at("value"), 312.4);
  EXPECT_FALSE(style.at("terms")[1].contains("low"));
  EXPECT_EQ(style.at("terms")[1].at("high"), 400);
  ASSERT_EQ(style.at("changes").size(), 1u);
  EXPECT_EQ(style.at("changes")[0].at("high"), 1.2);
}

TEST(ExplainStyle, NamesTheRuleForWhatIsNoHouse) {
  test::SampleRegion sample;
  model::Building& b = classified(sample);
  b.style_why.rule = "building=garage: a \"garage\"";
  b.attributes.substyle.value.clear();
  const json style = lines_of(explain(sample.region(), plain_options()).lines).at("w7").at("style");
  EXPECT_EQ(style.at("rule"), "building=garage: a \"garage\"");
  EXPECT_FALSE(style.contains("substyle"));
}

TEST(ExplainStyle, IsLeftOutWhereNothingWasClassified) {
  test::SampleRegion sample;
  classified(sample).style.style = {};
  EXPECT_FALSE(lines_of(explain(sample.region(), plain_options()).lines).at("w7").contains("style"));
}

}  // namespace
}  // namespace blockrand::outputs
