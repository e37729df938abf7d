// Where a stretch of a building's outline lies.
#pragma once

#include <optional>

#include "pipeline/model/building.h"

namespace blockrand::geometry {

struct WallSegmentEnds {
  model::Point2 from, to;            ///< m, on the 1/1024 m grid; the building on the left
  model::Point2 edge_from, edge_to;  ///< m, of the whole edge
};

/// The ends of `edge`, one of building.edges. An end within half a grid step of a corner is that corner.
/// \returns nothing where the edge points at no edge of the outline, or is shorter than the grid tells apart
std::optional<WallSegmentEnds> ends_of(const model::Building& building, const model::WallSegment& edge);

}  // namespace blockrand::geometry
