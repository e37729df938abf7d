// Exact tests between and within footprints, on the 1/1024 m grid.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// True when some area belongs to the insides of both. Common points, walls and corners are none. Both must be strictly
/// simple, outer rings counter-clockwise and holes clockwise. Exact; cost grows with the product of the edges that come
/// into the common part of both bounding boxes.
bool interiors_meet(const model::Polygon& a, const model::Polygon& b);

/// An edge of a polygon: ring 0 is the outer one, k is holes[k - 1]; from point `index` to the next.
struct EdgeOf {
  std::uint32_t ring = 0, index = 0;
  friend auto operator<=>(const EdgeOf&, const EdgeOf&) = default;
};

/// All pairs of edges that cross, overlap or touch elsewhere than neighbours at their common point; edges of no length
/// are paired with themselves. At most `most` pairs. Exact. Empty for rings that are wrong in another way (nested,
/// without area).
std::vector<std::pair<EdgeOf, EdgeOf>> conflicting_edges(const model::Polygon& polygon, std::size_t most = 1000);

}  // namespace blockrand::geometry
