// The plan of a roof cut by lines: pieces that lie under one surface each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/model/polygon.h"
#include "styles/roofs/roof.h"
#include "styles/roofs/roof_outline.h"

namespace blockrand::roofs {

/// A piece of the plan. Neighbouring pieces have the same points on their common borders.
struct RoofPiece {
  model::Polygon plan;        ///< m, on the grid; holes may touch at points
  std::int32_t surface = -1;  ///< of Roof::surfaces
  std::uint32_t region = 0;   ///< the first of the regions that hold it
};

/// What of convex regions (counter-clockwise) lies under the roof, cut along the borders of its surfaces and of all
/// regions.
std::vector<RoofPiece> pieces_under(const Roof& roof, std::span<const std::vector<model::Point2>> regions);

/// Polygons (outer counter-clockwise, holes clockwise) cut by the borders of each other and by lines; `surface` is the
/// polygon's number.
std::vector<RoofPiece> pieces_of(std::span<const model::Polygon> polygons,
                                 std::span<const std::vector<model::Point2>> lines);

}  // namespace blockrand::roofs
