// Objects around houses that come into several areas count once.
#include "pipeline/run/area_surroundings.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pipeline/georef/tiles.h"

namespace blockrand::run::test {
namespace {

using model::OsmType;
using model::SurroundingState;
using surroundings::SharedOutcome;
using surroundings::SurroundingAccount;
using surroundings::SurroundingKind;

SharedOutcome told(OsmType type, std::int64_t number, SurroundingKind kind, std::size_t state) {
  return {{type, number}, static_cast<std::uint8_t>(kind), static_cast<std::uint8_t>(state)};
}
constexpr auto kModelled = static_cast<std::size_t>(SurroundingState::modelled);
constexpr auto kCovered = static_cast<std::size_t>(SurroundingState::covered);

/// Lines between places in degrees from the south-west corner of an area.
model::Extract lines(const model::TileId& area, std::initializer_list<std::array<double, 4>> ends) {
  const georef::GeoBox box = georef::bounds(area);
  model::Extract extract;
  for (const auto& [x0, y0, x1, y1] : ends) {
    model::Feature feature;
    feature.id = {OsmType::way, static_cast<std::int64_t>(extract.features.size()) + 1};
    model::MappedRing ring;
    ring.vertices = {static_cast<std::uint32_t>(extract.vertices.size()), 2};
    for (const auto& [x, y] : {std::pair(x0, y0), std::pair(x1, y1)})
      extract.vertices.push_back({static_cast<std::int32_t>(std::lround((box.west + x) * 1e7)),
                                  static_cast<std::int32_t>(std::lround((box.south + y) * 1e7))});
    feature.rings = {static_cast<std::uint32_t>(extract.rings.size()), 1};
    extract.rings.push_back(ring);
    feature.kinds = static_cast<std::uint32_t>(model::FeatureKind::street);
    feature.tags = {static_cast<std::uint32_t>(extract.tags.size()), 1};
    extract.tags.push_back({extract.strings.intern("highway"), extract.strings.intern("residential")});
    extract.features.push_back(feature);
  }
  return extract;
}

TEST(AreaSurroundings, WhatReachesOutOfAnAreaIsShared) {
  const model::TileId area{13, 8700, 6438};  // about 0.02 degrees
  // In its middle; out of it in the east; within 150 m of its southern side; beginning in the west of it.
  const model::Extract extract = lines(
      area,
      {{0.01, 0.01, 0.011, 0.011}, {0.01, 0.01, 0.03, 0.01}, {0.01, 0.001, 0.01, 0.002}, {-0.01, 0.01, 0.01, 0.01}});
  const surroundings::Catalogue catalogue(std::string(BLOCKRAND_SOURCE_DIR) + "/configs/surroundings.toml");
  const auto thing_of = thing_recorder(extract, catalogue, {.ground = true, .bodies = true, .objects = true}, area);
  std::vector<RecordedThing> things;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(begins_in(extract, extract.features[i], area, false), i < 3);
    if (i == 3) break;
    const std::optional<RecordedThing> thing = thing_of(extract.features[i]);
    ASSERT_TRUE(thing);
    EXPECT_EQ(thing->kind, static_cast<std::uint8_t>(SurroundingKind::road));
    EXPECT_EQ(thing->inside, i == 0);
    things.push_back(*thing);
  }
  EXPECT_FALSE(begins_in(extract, {}, area, false));
  EXPECT_TRUE(begins_in(extract, {}, area, true));
  EXPECT_FALSE(thing_of(model::Feature())) << "no tag says what it is";
  EXPECT_FALSE(thing_recorder(extract, catalogue, {}, area)(extract.features[0])) << "no layer is asked for";
  SurroundingAccount account;
  for (const std::int64_t n : {1, 2, 4}) account.take(told(OsmType::way, n, SurroundingKind::road, kModelled));
  std::vector<std::pair<std::int64_t, std::size_t>> shared;
  for (const SharedOutcome& o : close_surroundings(things, account)) shared.emplace_back(o.object.number, o.state);
  EXPECT_EQ(shared, (std::vector<std::pair<std::int64_t, std::size_t>>{
                        {2, kModelled}, {3, surroundings::kElsewhere}, {4, kModelled}}));
}

TEST(AreaSurroundings, TheWholeCountsWhatIsSharedOnce) {
  // A street that one area modelled, one covers, and that begins in a third which has no tile for it; a tree of one area.
  const SharedOutcome best = told(OsmType::way, 1, SurroundingKind::road, kModelled),
                      covered = told(OsmType::way, 1, SurroundingKind::road, kCovered),
                      elsewhere = told(OsmType::way, 1, SurroundingKind::road, surroundings::kElsewhere);
  nlohmann::ordered_json sum = {{"road", {{"modelled", 1}, {"covered", 1}, {"elsewhere", 1}}},
                                {"tree", {{"modelled", 1}}}};
  settle_surroundings({covered, elsewhere, best}, sum);
  EXPECT_EQ(sum, (nlohmann::ordered_json{{"road", {{"modelled", 1}}}, {"tree", {{"modelled", 1}}}}));
}

TEST(AreaSurroundings, RunJsonKeepsThem) {
  const std::vector<SharedOutcome> outcomes{
      told(OsmType::relation, -7, SurroundingKind::water, kCovered),
      told(OsmType::node, 1'000'000'000'000, SurroundingKind::tree, surroundings::kElsewhere)};
  std::vector<SharedOutcome> read;
  ASSERT_TRUE(read_shared(shared_json(outcomes), read));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].object, outcomes[0].object);
  EXPECT_EQ(read[1].state, surroundings::kElsewhere);
  for (const char* wrong :
       {"{}", "[[0,1,2]]", "[[0,1,2,99]]", "[[9,1,2,0]]", "[[0,1,200,0]]", "[[0,\"1\",2,0]]", "null"})
    EXPECT_FALSE(read_shared(nlohmann::ordered_json::parse(wrong), read)) << wrong;
}

}  // namespace
}  // namespace blockrand::run::test
