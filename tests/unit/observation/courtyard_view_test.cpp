// When a hole of an outline is told to be open, and when to be built over.
#include "pipeline/observation/courtyard_view.h"

#include <gtest/gtest.h>

namespace blockrand::observation {
namespace {

CourtyardEvidence roof_within() {
  return {.alike = 0.85, .level = 0.05, .dark = 0.05, .green = 0, .edge = 0.3, .around = 0.3};
}

TEST(CourtyardView, ARoofLikeTheOneAroundIsBuiltOver) {
  EXPECT_GE(built_over_probability(roof_within()), kSureBuiltOver);
}

TEST(CourtyardView, ShadowsAndLeavesAreOpen) {
  CourtyardEvidence shade = roof_within();
  shade.alike = 0.2, shade.dark = 0.7, shade.level = 0.4, shade.edge = 0.7;
  EXPECT_LE(built_over_probability(shade), 1 - kSureOpen);
  CourtyardEvidence garden = roof_within();
  garden.alike = 0.2, garden.green = 0.7, garden.level = 0.3, garden.edge = 0.6;
  EXPECT_LE(built_over_probability(garden), 1 - kSureOpen);
}

TEST(CourtyardView, NamesAreThoseOfTheOutputs) {
  EXPECT_EQ(name(CourtyardState::open), "open");
  EXPECT_EQ(name(CourtyardState::built_over), "perhaps_built_over");
  EXPECT_EQ(name(CourtyardState::unknown), "unknown");
}

}  // namespace
}  // namespace blockrand::observation
