// The numbers behind the shapes of docs/roofs.md that are given by a table: rings around an apex, heights across a
// plan.
#pragma once

#include <span>
#include <vector>

#include "pipeline/model/roof_shape.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

// Shares of the roof's height (H) and largest run at which pitches change.
inline constexpr double kMansardHeight = 0.65;  ///< of H: the break of mansard and gambrel
inline constexpr double kMansardRun = 0.25;     ///< of the largest run: the same
inline constexpr double kDeckRun = 0.6;         ///< of the largest run: the border of the saltboxes' deck

// Mansards with an attic storey (RoofRequest::attic).
inline constexpr double kLeastBreak = 0.3, kMostBreak = 0.85;        ///< of H: where the break may lie
inline constexpr double kLeastBreakRun = 0.1, kMostBreakRun = 0.45;  ///< of the largest run

// The Berlin roof: tangents, docs/style_measures.md 2.7 (street 45-60-65, deck 4-8-15; knee wall 0.5 to 1.2 m of 3 to 4
// m).
inline constexpr double kBerlinSteep = 1.7320508075688772;    ///< 60 degrees
inline constexpr double kBerlinGentle = 0.14054083470239145;  ///< 8 degrees
inline constexpr double kKneeWall = 0.4;  ///< of the height the roof has without it: about 0.7 m at a depth of 13 m
inline constexpr double kLeastKneeWall = 0.1;  ///< m

/// Rings of a model::ApexRoof for apex_roof(); empty for all other shapes.
std::span<const ApexRing> apex_rings(model::RoofShape shape);

/// Heights of a model::ProfileRoof for profile_roof(); empty for all other shapes.
/// \param width_across  m. The plan's extent in the direction of the profile; decides the number of sawtooth's teeth.
std::vector<ProfilePoint> profile_points(model::RoofShape shape, double width_across);

}  // namespace blockrand::roofs
