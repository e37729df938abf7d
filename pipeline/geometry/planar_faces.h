// The faces that a set of lines cuts out of the plane: blocks between streets, courtyards between walls.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/geometry/noded_lines.h"
#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

inline constexpr std::uint64_t kNoLine = ~std::uint64_t{0};

/// What lies under one edge of a face's ring.
struct FaceEdge {
  std::uint64_t line = kNoLine;  ///< the least id of the lines that run along it
  bool left = false;             ///< the face lies on the left of that line
};

/// How far a line bounds a face, in metres.
struct BorderLine {
  std::uint64_t id = 0;
  double left = 0;   ///< where the face is on the left of the line
  double right = 0;  ///< where it is on the right
};

struct Face {
  /// Outer ring counter-clockwise, holes clockwise, each beginning at its least point (x, then y); holes in the order
  /// of their first points. Valid in OGC's sense: rings may touch each other at points. `nodes` are those of the lines.
  model::Polygon polygon;
  std::vector<FaceEdge>
      edges;  ///< parallel to the vertices, outer ring first, then the holes: the edge that starts there
  std::vector<BorderLine> lines;  ///< every line along the boundary, ascending by id
};

/// Nodes the lines where they cross, touch or overlap, drops what ends blindly or only connects, and returns the
/// bounded faces of what remains, in the order of their rings.
///
/// Crossings are rounded to the grid by exact snap rounding (noded_edges). The result depends on the set of segments
/// alone: not on the order of lines, their direction (but for left and right), or how they are cut into pieces. It is
/// local: a face depends only on lines that come into its bounding box, since every edge of its boundary is part of a
/// closed ring within that box.
/// O(n log n) for n pieces of lines, and holes times faces for what hangs together by itself.
std::vector<Face> faces_of_lines(std::span<const DividingLine> lines);

/// A point inside the polygon, on the grid, well away from the boundary where the polygon is wide. For polygons
/// narrower than a few millimetres it may lie on the boundary.
model::Point2 inner_point(const model::Polygon& polygon);

}  // namespace blockrand::geometry
