// Which rule of ISO 19107 the rings of a polygon break. For polygons that a cheaper test has found bad.
#pragma once

#include <span>
#include <vector>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/solid_defect.h"

namespace blockrand::geometry {

struct RingsDefect {
  SolidDefect defect = SolidDefect::none;
  int first = -1, second = -1;  ///< rings concerned; 0 is the outer one
};

/// The first rule that the rings break, in this order: too_few_points, same_points, ring_crosses, rings_equal,
/// rings_meet (crossing, or a common stretch), hole_outside, hole_in_hole, face_split, rings_meet (touching in one
/// point, which ISO 19107 allows and this project does not: walls on such rings are no manifold), hole_turned. Exact.
/// Cost: O(n log n), plus pairs of edges that meet along x, plus holes times points.
/// \param rings  the outer ring first, in either direction; no repeated last point
RingsDefect find_rings_defect(std::span<const std::vector<Grid2>> rings);

}  // namespace blockrand::geometry
