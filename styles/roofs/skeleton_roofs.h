// Roofs that rise from the edges of any plan: hips, gables, mansards, decks.
#pragma once

#include <optional>
#include <vector>

#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// A model::EdgeRoof on a plan; empty for all other shapes. Where the plan has no end of a wing, gables are left out.
/// Where the weighted skeleton gives up, hips by CGAL's (SKELETON_FALLBACK); empty when that gives up as well.
std::optional<BuiltRoof> skeleton_roof(const model::Polygon& plan, const RoofRequest& request);

/// How far the slopes of such a roof run, m: the height of the highest point where eaves rise at 45 degrees; 0 where there is
/// no skeleton. The pitch over it is that of all slopes but those of lean-to wings, which are gentler. Of the Berlin roof, whose
/// slopes have pitches of their own, its height.
struct SkeletonRun {
  double run = 0;
  bool leans = false;  ///< a lean-to (RoofSides::leans)
};
SkeletonRun skeleton_run(const model::Polygon& plan, const RoofRequest& request);

/// Domes and onions on plans that have no single apex: five pitches that follow a quarter of an ellipse over every
/// edge.
std::optional<BuiltRoof> vaulted_roof(const model::Polygon& plan, const RoofRequest& request);

}  // namespace blockrand::roofs
