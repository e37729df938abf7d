// Which wall segment comes after which round the corners of a body: courses go on round them.
#pragma once

#include <span>

#include "pipeline/facades/facade_segments.h"
#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/building.h"

namespace blockrand::facades {

/// m above the height reference: where the walls of a part end and its roof begins, as they were built: roofs of
/// unknown shape are flat at full height, failed ones flat at half the roof's, others were clamped. That is height less
/// roof_height where some face of the LoD2 roof ends on a wall of the plan at that height (so bays whose roof comes
/// down lower, gables and high sides of skillion roofs do not count); else the lowest place where one does. Looks
/// through the whole solid: ask once a part.
double eaves_level(const model::BuildingPart& part);

/// m. Points of solids lie on the grid, attributes do not: two steps of it.
inline constexpr double kSameEaves = 0.002;
/// m. Walls whose base and eaves differ by less carry the same courses.
inline constexpr double kSameLevel = 0.02;

/// Fills in turn_left, turn_right, kind_left and kind_right.
/// \param segments  of facade_segments() for the same walls, after take_portals()
/// \param eaves      m above the height reference
void link_corners(std::span<FacadeSegment> segments, std::span<const WallFrame> walls, double eaves);

}  // namespace blockrand::facades
