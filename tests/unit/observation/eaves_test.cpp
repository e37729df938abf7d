// Heights of eaves by tags, shadows and neighbours: which of them speaks, and how sure the answer is.
#include "pipeline/observation/eaves.h"

#include <gtest/gtest.h>

namespace blockrand::observation {
namespace {

/// Houses of 10 m x 10 m, `apart` m from each other.
struct Town {
  explicit Town(std::uint32_t count, double apart = 30) : store(count) {
    extract.buildings.resize(count);
    for (std::uint32_t b = 0; b < count; ++b) {
      footprints::StoredFootprint f;
      f.id = {model::OsmType::way, b + 1};
      f.lead = b;
      model::Polygon p;
      const double x = b * apart;
      p.outer.points = {{x, 0}, {x + 10, 0}, {x + 10, 10}, {x, 10}};
      p.outer.nodes.assign(4, 0);
      store.set(b, f, {&p, 1});
    }
  }
  model::MappedAttributes& tags(std::uint32_t b) { return extract.buildings[b].attributes; }
  EavesHeights eaves() const { return {extract, store}; }
  model::Extract extract;
  footprints::FootprintStore store;
};

ShadowHeights shadow_of(std::uint32_t count, std::uint32_t building, double height, double clearness) {
  ShadowHeights out;
  out.buildings.resize(count);
  out.buildings[building].height = height;
  out.buildings[building].shadow.clearness = clearness;
  return out;
}

TEST(Eaves, TagsSpeakFirst) {
  Town town(3);
  town.tags(0).height = 12.0F, town.tags(0).roof_height = 4.0F;
  town.tags(1).height = 10.0F, town.tags(1).roof_shape = model::RoofShape::flat;
  town.tags(2).storeys = 3.0F;
  const EavesHeights eaves = town.eaves();
  EXPECT_DOUBLE_EQ(eaves.height(0), 8);
  EXPECT_DOUBLE_EQ(eaves.height(1), 10);
  EXPECT_NEAR(eaves.height(2), 9.6, 0.01);
  for (std::uint32_t b = 0; b < 3; ++b) {
    EXPECT_TRUE(eaves.is_tagged(b));
    EXPECT_DOUBLE_EQ(eaves.uncertainty(b), kTaggedUncertainty);
  }
}

TEST(Eaves, ThreeNeighboursSpeakForOneTwoDoNot) {
  for (const std::uint32_t tagged : {2U, 3U}) {
    Town town(tagged + 1);
    for (std::uint32_t b = 1; b <= tagged; ++b)
      town.tags(b).height = 10.0F + static_cast<float>(b), town.tags(b).roof_shape = model::RoofShape::flat;
    const EavesHeights eaves = town.eaves();
    EXPECT_FALSE(eaves.is_tagged(0));
    if (tagged == 3) {
      EXPECT_DOUBLE_EQ(eaves.height(0), 12);
      EXPECT_DOUBLE_EQ(eaves.uncertainty(0), kNeighbourUncertainty);
    } else {
      EXPECT_LT(eaves.height(0), 8);
      EXPECT_DOUBLE_EQ(eaves.uncertainty(0), kGuessedUncertainty);
    }
  }
}

TEST(Eaves, AClearShadowOutweighsAGuessAndIsForgotten) {
  Town town(1);
  EavesHeights eaves = town.eaves();
  const double guess = eaves.height(0);
  eaves.take(shadow_of(1, 0, 14, 0.3));
  EXPECT_GT(eaves.height(0), 12.5);
  EXPECT_LT(eaves.height(0), 14);
  EXPECT_LT(eaves.uncertainty(0), shadow_uncertainty(0.3));
  eaves.take(shadow_of(1, 0, 14, -0.1));  // hardly one at all
  EXPECT_LT(eaves.height(0), 2 * guess);
  eaves.forget_shadows();
  EXPECT_DOUBLE_EQ(eaves.height(0), guess);
  eaves.take({});
  EXPECT_DOUBLE_EQ(eaves.height(0), guess);
}

TEST(Eaves, ATagAndAShadowShareTheWord) {
  Town town(1);
  town.tags(0).height = 10.0F, town.tags(0).roof_shape = model::RoofShape::flat;
  EavesHeights eaves = town.eaves();
  eaves.take(shadow_of(1, 0, 12, 0.3));
  EXPECT_GT(eaves.height(0), 10.5);
  EXPECT_LT(eaves.height(0), 12);
}

TEST(Eaves, ShadowsOfNeighboursSpeakForOneThatHasNone) {
  Town town(5);
  ShadowHeights shadows;
  shadows.buildings.resize(5);
  for (std::uint32_t b = 1; b < 5; ++b) shadows.buildings[b] = {.shadow = {.clearness = 0.3}, .height = 15};
  EavesHeights eaves = town.eaves();
  eaves.take(shadows);
  EXPECT_DOUBLE_EQ(eaves.height(0), 15);
  EXPECT_DOUBLE_EQ(eaves.uncertainty(0), kNeighbourUncertainty);
}

TEST(Eaves, LowIsWhatIsTaggedLowOrHasASmallPlan) {
  Town town(3);
  town.tags(1).storeys = 5.0F;
  town.tags(2).storeys = 1.0F;
  const EavesHeights eaves = town.eaves();
  EXPECT_TRUE(eaves.surely_low(0));
  EXPECT_FALSE(eaves.surely_low(1));
  EXPECT_TRUE(eaves.surely_low(2));
}

TEST(Eaves, WhatHasNoOutlineHasAHeightAllTheSame) {
  Town town(2);
  footprints::StoredFootprint f;
  f.id = {model::OsmType::way, 2};
  f.lead = 1;
  town.store.set(1, f, {});
  EavesHeights eaves = town.eaves();
  eaves.take({});
  EXPECT_GE(eaves.height(1), 0);
}

}  // namespace
}  // namespace blockrand::observation
