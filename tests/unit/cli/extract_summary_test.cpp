#include "pipeline/cli/extract_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace blockrand::cli {
namespace {

using model::IssueCode;
using model::ObjectKind;
using model::ObjectState;
using model::OsmType;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

constexpr std::int32_t kDegree = 10'000'000;

/// Builds an extract object by object.
class Maker {
 public:
  model::Extract extract;

  model::MappedBuilding& add(OsmType type, std::int64_t number, ObjectKind kind,
                             const std::vector<std::pair<std::string, std::string>>& tags) {
    model::MappedBuilding b;
    b.id = {type, number};
    b.kind = kind;
    b.tags = tags_range(tags);
    b.attributes.use = extract.strings.intern(tags.front().second);
    extract.buildings.push_back(b);
    auto& c = extract.counts;
    if (kind == ObjectKind::building)
      ++(type == OsmType::node ? c.building_nodes : type == OsmType::way ? c.building_ways : c.building_relations);
    else
      ++(type == OsmType::node ? c.part_nodes : type == OsmType::way ? c.part_ways : c.part_relations);
    return extract.buildings.back();
  }

  /// A square of 1e-4 degrees around a place.
  void give_ring(model::MappedBuilding& b, std::int32_t lon, std::int32_t lat) {
    constexpr std::int32_t d = 500;
    const auto first = static_cast<std::uint32_t>(extract.vertices.size());
    for (const auto& [x, y] : {std::pair{-d, -d}, {d, -d}, {d, d}, {-d, d}}) {
      extract.vertices.push_back({lon + x, lat + y});
      extract.vertex_nodes.push_back(static_cast<std::int64_t>(extract.vertices.size()));
    }
    b.rings = {static_cast<std::uint32_t>(extract.rings.size()), 1};
    extract.rings.push_back({{first, 4}, false});
  }

  void add_feature(std::uint32_t kinds) {
    model::Feature f;
    f.kinds = kinds;
    extract.features.push_back(f);
  }

 private:
  model::Range tags_range(const std::vector<std::pair<std::string, std::string>>& tags) {
    const model::Range range{static_cast<std::uint32_t>(extract.tags.size()), static_cast<std::uint32_t>(tags.size())};
    for (const auto& [key, value] : tags)
      extract.tags.push_back({extract.strings.intern(key), extract.strings.intern(value)});
    return range;
  }
};

model::Extract quarter() {
  Maker m;
  m.extract.file = "quarter.osm";
  m.extract.data_time = "2026-01-02T03:04:05Z";
  auto& node = m.add(OsmType::node, 1, ObjectKind::building, {{"building", "house"}});
  node.state = ObjectState::reported;
  node.code = IssueCode::node_only;
  m.extract.report.add(node.id, IssueCode::node_only);
  m.give_ring(m.add(OsmType::way, 1, ObjectKind::building, {{"building", "house"}, {"height", "12"}}), 13 * kDegree,
              52 * kDegree);
  m.give_ring(m.add(OsmType::way, 2, ObjectKind::building,
                    {{"building", "apartments"}, {"roof:shape", "gabled"}, {"building:levels", "4"}}),
              13 * kDegree + 100'000, 52 * kDegree + 200'000);
  m.give_ring(m.add(OsmType::way, 3, ObjectKind::building, {{"building", "house"}, {"height", "x"}}),
              13 * kDegree + 50'000, 52 * kDegree);
  m.extract.report.add({OsmType::way, 3}, IssueCode::value_unreadable, "height=x");
  m.give_ring(m.add(OsmType::way, 4, ObjectKind::building_part, {{"building:part", "yes"}, {"roof:shape", "flat"}}),
              13 * kDegree, 52 * kDegree);
  m.add(OsmType::relation, 5, ObjectKind::building, {{"building", "yes"}}).state = ObjectState::duplicate;
  using model::FeatureKind;
  m.add_feature(static_cast<std::uint32_t>(FeatureKind::street));
  m.add_feature(static_cast<std::uint32_t>(FeatureKind::shop) | static_cast<std::uint32_t>(FeatureKind::address));
  return std::move(m.extract);
}

TEST(ExtractSummary, CountsObjectsByTypeAndState) {
  const ExtractSummary s = summarise(quarter());
  EXPECT_EQ(s.counts.buildings(), 5u);
  EXPECT_EQ(s.counts.parts(), 1u);
  EXPECT_EQ(s.to_build, 4u);
  EXPECT_EQ(s.duplicates, 1u);
  EXPECT_THAT(s.reported, ElementsAre(Pair("NODE_ONLY", 1)));
  EXPECT_THAT(s.notices, ElementsAre(Pair("VALUE_UNREADABLE", 1)));
}

TEST(ExtractSummary, CountsTagsAndValues) {
  const ExtractSummary s = summarise(quarter());
  for (const KeyUse& k : s.keys) {
    if (k.key == "height") {
      EXPECT_THAT(k, testing::FieldsAre("height", 2u, 0u));
    }
    if (k.key == "roof:shape") {
      EXPECT_THAT(k, testing::FieldsAre("roof:shape", 1u, 1u));
    }
    if (k.key == "roof:angle") {
      EXPECT_THAT(k, testing::FieldsAre("roof:angle", 0u, 0u)) << "in no tag of the extract";
    }
  }
  EXPECT_THAT(s.building_values, ElementsAre(Pair("house", 3), Pair("apartments", 1), Pair("yes", 1)))
      << "equal ones by name";
  EXPECT_THAT(s.part_values, ElementsAre(Pair("yes", 1)));
  EXPECT_THAT(s.roof_shapes, ElementsAre(Pair("flat", 1), Pair("gabled", 1)));
}

TEST(ExtractSummary, AFeatureCountsOnceForEachOfItsKinds) {
  std::map<std::string, std::uint64_t> features;
  for (const auto& [kind, count] : summarise(quarter()).features) features[kind] = count;
  EXPECT_EQ(features["streets"], 1u);
  EXPECT_EQ(features["shops"], 1u);
  EXPECT_EQ(features["addresses"], 1u);
  EXPECT_EQ(features["trees"], 0u);
}

TEST(ExtractSummary, LocatesTheOutlines) {
  const ExtractSummary s = summarise(quarter());
  ASSERT_TRUE(s.extent && s.centre);
  EXPECT_NEAR(s.extent->west, 13, 1e-9);
  EXPECT_NEAR(s.extent->east, 13.01, 1e-9);
  EXPECT_NEAR(s.extent->north, 52.02, 1e-9);
  EXPECT_NEAR(s.centre->lat, 52, 1e-9);
  EXPECT_GE(s.size.tiles, 2u) << "0.02 degrees are more than two tiles high";
}

TEST(ExtractSummary, AnExtractAcross180DegreesIsNarrow) {
  Maker m;
  m.give_ring(m.add(OsmType::way, 1, ObjectKind::building, {{"building", "yes"}}), 1'799'990'000, -17 * kDegree);
  m.give_ring(m.add(OsmType::way, 2, ObjectKind::building, {{"building", "yes"}}), -1'799'990'000, -17 * kDegree);
  m.give_ring(m.add(OsmType::way, 3, ObjectKind::building, {{"building", "yes"}}), 1'799'980'000, -17 * kDegree);
  const ExtractSummary s = summarise(m.extract);
  ASSERT_TRUE(s.extent);
  EXPECT_NEAR(s.extent->west, 179.998, 1e-9);
  EXPECT_NEAR(s.extent->east, -179.999, 1e-9);
  EXPECT_LT(s.extent->width(), 0.01);
}

TEST(ExtractSummary, AnEmptyExtractIsNoError) {
  const ExtractSummary s = summarise(model::Extract{});
  EXPECT_FALSE(s.extent);
  EXPECT_EQ(s.size.tiles, 0u);
  EXPECT_THAT(summary_text(s, std::nullopt, {}), HasSubstr("a build would be empty"));
  EXPECT_TRUE(nlohmann::json::parse(summary_json(s, std::nullopt, {}))["extent"].is_null());
}

TEST(ExtractSummary, TextAndJsonSayTheSame) {
  const ExtractSummary s = summarise(quarter());
  const CrsChoice crs{"EPSG:25833", "ETRS89 / UTM zone 33N", "UTM zone 33N", 0};
  const BuildEstimate e{2.5, 60'000'000, 1'000'000};
  const std::string text = summary_text(s, crs, e);
  EXPECT_THAT(text, ContainsRegex("buildings +1 +3 +1 +5\n"));
  EXPECT_THAT(text, ContainsRegex("height +40.0 % +0.0 %\n"));
  EXPECT_THAT(text, HasSubstr("data of 2026-01-02T03:04:05Z"));
  EXPECT_THAT(text, HasSubstr("EPSG:25833 ETRS89 / UTM zone 33N"));
  EXPECT_THAT(text, HasSubstr("A build would take some seconds, about 60.0 MB of memory and about 1.0 MB of disk"));
  const auto j = nlohmann::json::parse(summary_json(s, crs, e));
  EXPECT_EQ(j["buildings"]["count"], 5);
  EXPECT_EQ(j["reported"]["NODE_ONLY"], 1);
  EXPECT_EQ(j["building_values"][0]["value"], "house");
  EXPECT_EQ(j["crs"]["code"], "EPSG:25833");
  EXPECT_EQ(j["extent"].size(), 4u);
}

TEST(ExtractSummary, BytesThatAreNoUtf8DoNotStopJson) {
  Maker m;
  m.add(OsmType::way, 1, ObjectKind::building, {{"building", "\xFF\xFE"}});
  EXPECT_NO_THROW(nlohmann::json::parse(summary_json(summarise(m.extract), std::nullopt, {})));
}

}  // namespace
}  // namespace blockrand::cli
