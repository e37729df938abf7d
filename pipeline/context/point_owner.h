// Which of the buildings around a mapped entrance or address it belongs to.
#pragma once

#include <optional>

#include "pipeline/context/wall_segments.h"

namespace blockrand::context {

/// m. Entrances and addresses are nodes of the outline, or were meant to be, or lie within.
inline constexpr double kEntranceReach = 1;
/// m. Distances that differ by less are the same: repair has moved corners.
inline constexpr double kSameDistance = 0.05;

/// The corner of an outline that was made of an OSM node, where repair has put it.
std::optional<model::Point2> corner_of_node(const model::Polygon& polygon, model::OsmId node);

/// The one building that an entrance or address belongs to, or number 0 for none: the same whichever building asks, and
/// decided by nothing farther than those that hold the point or come within kEntranceReach of it, and by what touches
/// them there.
///
/// In this order: walls before canopies; outlines that the node is a corner of; the nearest, where within is nearest;
/// among several as near (a corner that houses share) those with a wall that no neighbour covers there; the one whose own
/// address is that of the point, house number and street before either; the least id.
model::OsmId owner_of(const SitePoint& point, const VicinityIndex& vicinity, const WallSegmentOptions& options);

}  // namespace blockrand::context
