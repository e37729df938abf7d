// When a mapped building is told to be gone.
#include "pipeline/observation/presence.h"

#include <gtest/gtest.h>

namespace blockrand::observation {
namespace {

OutlineReceipt on_edges(double share) {
  OutlineReceipt r;
  r.image = 0;
  r.mean = 0.25, r.deviation = 0.06, r.before = r.after = share;
  return r;
}

RoofView surface(double green) {
  RoofView v;
  v.pixels = 1000, v.green = green, v.spread = 0.1;
  return v;
}

TEST(Presence, GrassWithoutEdgesIsNoHouse) {
  EXPECT_GT(gone_probability(on_edges(0.35), surface(0.9), 0), kPerhapsGone);
}

TEST(Presence, ARoofOrWallsOrAShadowAreOne) {
  EXPECT_LT(gone_probability(on_edges(0.75), surface(0), 0.2), 0.05);
  EXPECT_LT(gone_probability(on_edges(0.75), surface(0.9), 0), kPerhapsGone) << "a house under trees has edges";
  EXPECT_LT(gone_probability(on_edges(0.45), surface(0), 0.3), 0.5) << "faint walls, but a shadow";
  const double without = gone_probability(on_edges(0.4), surface(0.5), 0);
  EXPECT_LT(gone_probability(on_edges(0.4), surface(0.5), 0.3), without);
  EXPECT_EQ(gone_probability(on_edges(0.4), surface(0.5), -0.3), without) << "no shadow is no worse than none";
}

TEST(Presence, WhatIsNotSeenIsNotJudged) {
  OutlineReceipt unseen = on_edges(0.3);
  unseen.image = OutlineReceipt::kNoImage;
  EXPECT_EQ(gone_probability(unseen, surface(1), 0), 0);
  EXPECT_EQ(gone_probability(on_edges(0.3), {}, 0), 0);
  OutlineReceipt unmatched = on_edges(0.3);
  unmatched.deviation = 0;
  EXPECT_EQ(gone_probability(unmatched, surface(1), 0), 0);
  RoofView cloud = surface(0.4);
  EXPECT_GT(gone_probability(on_edges(0.2), cloud, 0), kPerhapsGone);
  cloud.colour = model::Colour{232, 231, 235};
  EXPECT_EQ(gone_probability(on_edges(0.2), cloud, 0), 0);
  RoofView other = surface(1);
  other.image = 1;
  EXPECT_EQ(gone_probability(on_edges(0.3), other, 0), 0) << "of another image";
}

}  // namespace
}  // namespace blockrand::observation
