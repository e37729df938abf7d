#include "pipeline/export/explain/explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipeline/export/gzip.h"
#include "tests/unit/export/sample_region.h"

namespace blockrand::export_ {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

ExplainOptions plain_options() {
  ExplainOptions o;
  o.tile = "15_1_2";
  o.files = {"tiles/15/1/2.glb"};
  o.fate = [](std::uint32_t) { return Fate{model::ObjectState::modelled, model::IssueCode::none, {}}; };
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
  b.attributes.storeys = {4, model::Source::neighbours, 0.6f,
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
    EXPECT_EQ(a.at("lost")[0], json({{"value", "3"}, {"source", "preset"}, {"confidence", a.at("lost")[0].at("confidence")}, {"why", "usual for houses"}}));
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
  const std::vector<model::ReportRow> earlier = {{seven, model::IssueCode::value_unreadable, "height=tall"}, {eight, model::IssueCode::value_clamped, "x"}};
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

TEST(Explain, SharedWallsNameTheNeighbours) {
  test::SampleRegion sample;
  model::Building& b = sample.add_building(7, {{"building", "yes"}});
  sample.add_box(b, "w7", 0, 0, 10, 8, 0, 6);
  b.outline = {b.parts[0].plan};
  b.edges.assign(4, {});
  b.edges[1].from_node = 11;
  b.edges[1].to_node = 12;
  b.edges[1].kind = model::EdgeKind::party_wall;
  ExplainOptions options = plain_options();
  options.sharers = [](std::int64_t from, std::int64_t to) {
    EXPECT_EQ(from, 11);
    EXPECT_EQ(to, 12);
    return std::vector<model::OsmId>{{model::OsmType::way, 7}, {model::OsmType::way, 9}};
  };
  const json line = lines_of(explain(sample.region(), options).lines).at("w7");
  EXPECT_EQ(line.at("stages")[2].at("stage"), "context");
  EXPECT_EQ(line.at("stages")[2].at("text"), "1 of 4 walls (8.0 m) is shared with w9");
}

TEST(Explain, WhatWasNotBuiltSaysWhy) {
  test::SampleRegion sample;
  sample.add_building(7, {{"building", "yes"}});
  ExplainOptions options = plain_options();
  options.fate = [](std::uint32_t) { return Fate{model::ObjectState::reported, model::IssueCode::zero_area, {}}; };
  const json line = lines_of(explain(sample.region(), options).lines).at("w7");
  EXPECT_EQ(line.at("state"), "reported");
  EXPECT_EQ(line.at("code"), "ZERO_AREA");
  EXPECT_TRUE(line.at("files").empty()) << "no file shows it";
  EXPECT_THAT(line.at("stages").back().at("text"), HasSubstr("nothing was built"));
}

TEST(Gzip, ComesBackAndNoticesDamage) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += std::to_string(i * 7919 % 1000);
  const std::string packed = gzip(text, 4);
  EXPECT_LT(packed.size(), text.size());
  EXPECT_EQ(gunzip(packed), text);
  EXPECT_EQ(gunzip(gzip("")), "");
  EXPECT_THROW(gunzip(packed.substr(0, packed.size() / 2)), std::runtime_error);
  EXPECT_THROW(gunzip(""), std::runtime_error);
  std::string damaged = packed;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 0x55);
  EXPECT_THROW(gunzip(damaged), std::runtime_error);
}

}  // namespace
}  // namespace blockrand::export_
