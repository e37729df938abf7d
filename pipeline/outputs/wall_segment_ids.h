// Where the wall segments of a building's outline lie, and their ids, for all outputs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/model/building.h"

namespace blockrand::outputs {

/// A wall segment of the outline on the map.
struct IdentifiedWallSegment {
  std::uint32_t index = 0;  ///< into Building::edges
  /// `w123.e11_12`: from OSM node 11 to node 12. Where repair made a point, `p` and its place in steps of 1/1024 m, x and
  /// y, stand for the node: `w123.e11_p400384000x5958656000`. The second and further wall segments of an edge end in `.1`,
  /// `.2`; where two edges of a building run between the same nodes, the later ones get a `~2`, `~3` before that.
  std::string id;
  model::Point2 from, to;  ///< m, on the 1/1024 m grid
};

/// The wall segments of Building::edges, in their order. Those that point at no edge of the outline, or are shorter than the
/// grid tells apart, have no place on a map and are left out.
std::vector<IdentifiedWallSegment> wall_segments(const model::Building& building);

/// Degrees in [0, 360) clockwise from grid north: where a wall from `from` to `to` looks, the building on its left.
double outward(model::Point2 from, model::Point2 to);

/// "N", "NE", ... for degrees clockwise from north.
std::string_view compass(double degrees);

}  // namespace blockrand::outputs
