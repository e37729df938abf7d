// Which stretch comes after which round the corners of a body: courses go on round them.
#pragma once

#include <span>

#include "pipeline/generate/facade_stretches.h"
#include "pipeline/generate/wall_frame.h"
#include "pipeline/model/building.h"

namespace blockrand::generate {

/// m above the height reference: where the walls of a part end and its roof begins.
double eaves_level(const model::BuildingPart& part);

/// m. Walls whose base and eaves differ by less carry the same courses.
inline constexpr double kSameLevel = 0.02;

/// Fills in turn_left, turn_right, kind_left and kind_right.
/// \param stretches  of facade_stretches() for the same walls
/// \param eaves      m above the height reference
void link_corners(std::span<FacadeStretch> stretches, std::span<const WallFrame> walls, double eaves);

}  // namespace blockrand::generate
