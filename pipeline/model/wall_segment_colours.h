// One colour for each kind of outline edge, the same in plans, QGIS styles and the report.
#pragma once

#include "pipeline/model/building.h"
#include "pipeline/model/colour.h"

namespace blockrand::model {

/// Colours that stay apart for people without red, green or blue cones as well (simulated after Machado, Oliveira and
/// Fernandes 2009; least difference 23 in CIELAB, proved in tests/unit/picture/plan_test.cpp).
constexpr Colour colour_of(WallSegmentKind kind) {
  constexpr Colour colours[kWallSegmentKindCount] = {
      {170, 160, 165},  // unknown
      {200, 35, 25},    // street
      {60, 175, 95},    // courtyard
      {60, 95, 205},    // side
      {20, 20, 20},     // party wall
      {252, 180, 20},   // passage
  };
  return colours[static_cast<int>(kind)];
}

/// What a kind means, for legends.
constexpr std::string_view meaning(WallSegmentKind kind) {
  constexpr std::string_view meanings[kWallSegmentKindCount] = {
      "not known",
      "faces a street",
      "faces a courtyard",
      "faces the space between two buildings, or no street and no courtyard",
      "shared with a neighbour",
      "passage: open at the ground",
  };
  return meanings[static_cast<int>(kind)];
}

/// The same in a few words, for legends in pictures.
constexpr std::string_view short_meaning(WallSegmentKind kind) {
  constexpr std::string_view meanings[kWallSegmentKindCount] = {
      "not known", "to a street", "to a courtyard", "to a gap or open land", "shared with a neighbour", "passage below",
  };
  return meanings[static_cast<int>(kind)];
}

}  // namespace blockrand::model
