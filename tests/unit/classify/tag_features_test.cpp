#include "styles/classify/tag_features.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace blockrand::classify {
namespace {

using TagList = std::vector<std::pair<std::string_view, std::string_view>>;

const TagTables& tables() {
  static const TagTables read = TagTables::read(std::string(BLOCKRAND_SOURCE_DIR) + "/configs/styles/tags.toml");
  return read;
}

FeatureVector features(const model::MappedAttributes& attributes, std::string_view use = "yes",
                       const TagList& tags = {}) {
  FeatureVector f;
  fill_tag_features(
      f, attributes, use,
      [&](std::string_view key) {
        for (const auto& [k, v] : tags)
          if (k == key) return v;
        return std::string_view();
      },
      tables());
  return f;
}

TEST(TagFeatures, WhatIsNotTaggedIsNotKnown) {
  const FeatureVector f = features({});
  for (const Feature x : {Feature::tag_storeys, Feature::tag_roof, Feature::tag_roof_storeys, Feature::tag_year,
                          Feature::tag_heritage, Feature::tag_shop})
    EXPECT_FALSE(f.has(x)) << kFeatures[static_cast<std::size_t>(x)].name;
  EXPECT_EQ(f[Feature::tag_use], 0) << "building=yes tells no use";
  EXPECT_EQ(f[Feature::tag_number], 0);
}

TEST(TagFeatures, AreThoseOfTheGroupTag) {
  for (std::size_t i = 0; i < kFeatureCount; ++i)
    EXPECT_EQ(is_tag(static_cast<Feature>(i)), kFeatures[i].group == "tag") << kFeatures[i].name;
}

TEST(TagFeatures, CountsAndFlagsAreTakenOver) {
  model::MappedAttributes a;
  a.storeys = 5;
  a.roof_storeys = 1;
  a.roof_shape = model::RoofShape::gambrel;
  const FeatureVector f =
      features(a, "apartments", {{"heritage", "4"}, {"shop", "bakery"}, {"addr:housenumber", "7a"}});
  EXPECT_EQ(f[Feature::tag_storeys], 5);
  EXPECT_EQ(f[Feature::tag_roof_storeys], 1);
  EXPECT_EQ(f[Feature::tag_roof], 4) << "a mansard";
  EXPECT_EQ(f[Feature::tag_use], 1) << "flats";
  EXPECT_EQ(f[Feature::tag_heritage], 2);
  EXPECT_EQ(f[Feature::tag_shop], 1);
  EXPECT_EQ(f[Feature::tag_number], 1);
  EXPECT_EQ(features({}, "yes", {{"historic", "building"}})[Feature::tag_heritage], 2);
  EXPECT_EQ(features({}, "yes", {{"ref:lda", "09065001"}})[Feature::tag_heritage], 2) << "a list of monuments";
  EXPECT_EQ(features({}, "yes", {{"wikidata", "Q1"}})[Feature::tag_heritage], 1) << "known";
  EXPECT_FALSE(features({}, "yes", {{"heritage", "no"}}).has(Feature::tag_heritage));
  EXPECT_EQ(features({}, "yes", {{"office", "lawyer"}})[Feature::tag_shop], 1);
  EXPECT_EQ(features({}, "yes", {{"amenity", "pub"}})[Feature::tag_shop], 1);
}

TEST(TagFeatures, UsesThatNoTableKnowsAreOther) {
  EXPECT_EQ(tables().use_of("cathedral"), 9);
  EXPECT_EQ(tables().use_of("pyramid_of_glass"), 12);
  EXPECT_EQ(tables().use_of("yes"), 0);
}

TEST(TagFeatures, ANamedStyleOutranksTheYearOfARebuilding) {
  model::MappedAttributes a;
  a.built = model::ConstructionDate{{1950, 1956}, 0.9f};
  EXPECT_EQ(features(a)[Feature::tag_year], 1953) << "the middle of the years";
  EXPECT_EQ(features(a, "yes", {{"building:architecture", "baroque"}})[Feature::tag_year], 1720);
  EXPECT_EQ(features(a, "yes", {{"building:architecture", "space_age_gothic"}})[Feature::tag_year], 1953)
      << "not in the table";
  a.built->confidence = 0.45f;
  EXPECT_FALSE(features(a).has(Feature::tag_year)) << "may date the business";
}

TEST(TagFeatures, EveryRoofShapeHasAKind) {
  std::set<int> kinds;
  for (std::size_t i = 0; i < std::size(model::kRoofShapeNames); ++i)
    kinds.insert(roof_kind(static_cast<model::RoofShape>(i)));
  EXPECT_THAT(kinds, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_EQ(roof_kind(model::RoofShape::berlin), 5);
  EXPECT_EQ(roof_kind(model::RoofShape::onion), 8);
}

}  // namespace
}  // namespace blockrand::classify
