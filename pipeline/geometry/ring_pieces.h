// Small simple polygons that need not be convex, cut and drawn in: what GEOS does, without its types.
#pragma once

#include <span>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::geometry {

/// A polygon without holes, counter-clockwise, on the 1/1024 m grid; the last point is not repeated.
using RingPoints = std::vector<model::Point2>;

/// What is left when all edges of a simple polygon move inwards by `distance` m, corners mitred: pieces of at least
/// `least` m², largest first.
std::vector<RingPoints> drawn_in(std::span<const model::Point2> ring, double distance, double least);

/// What two simple polygons have in common: pieces of at least `least` m², largest first.
std::vector<RingPoints> common_pieces(std::span<const model::Point2> a, std::span<const model::Point2> b, double least);

}  // namespace blockrand::geometry
