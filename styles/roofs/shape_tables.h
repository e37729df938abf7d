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

/// Rings of pyramidal, cone, dome, onion and spire for apex_roof(); empty for all other shapes.
std::span<const ApexRing> apex_rings(model::RoofShape shape);

/// Heights of skillion, saltbox, butterfly, gabled_height_moved and sawtooth for profile_roof(); empty for all other
/// shapes. \param width_across  m. The plan's extent in the direction of the profile; decides the number of sawtooth's
/// teeth.
std::vector<ProfilePoint> profile_points(model::RoofShape shape, double width_across);

}  // namespace blockrand::roofs
