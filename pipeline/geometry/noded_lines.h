// Lines cut at all their crossings, on the 1/1024 m grid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::geometry {

/// A line that may bound faces. Points in metres on the 1/1024 m grid; a closed line repeats its first point.
struct DividingLine {
  std::uint64_t id = 0;  ///< whose line it is; several lines may have the same id
  std::vector<model::Point2> points;
  std::vector<std::int64_t> nodes;  ///< OSM nodes of the points, or empty
};

/// A piece of a line between two nodes of the arrangement, with a < b. Where lines run together each has its own.
struct NodedEdge {
  model::Point2 a, b;
  std::uint64_t line = 0;
  bool forward = true;  ///< the line runs from a to b
  friend bool operator==(const NodedEdge&, const NodedEdge&) = default;
  friend auto operator<=>(const NodedEdge&, const NodedEdge&) = default;
};

/// All lines cut where they cross, touch or overlap, ascending and each edge of a line once. Edges of different ends
/// meet at common ends only.
///
/// Snap rounding (Hobby 1999): every end of a segment and every crossing, rounded to the grid, makes its grid square
/// hot; a segment becomes the chain of the centres of the hot squares that it passes through. So nothing moves by more
/// than 0.71 grid steps, and no edge comes to cross another. All in exact integers: the result depends on the set of
/// segments alone, and around a place only on segments that come there. (GEOS's noder inserts hot pixels in an order
/// from std::random_device, which costs more than the noding.) About O(n log n) for segments that cross few others.
std::vector<NodedEdge> noded_edges(std::span<const DividingLine> lines);

}  // namespace blockrand::geometry
