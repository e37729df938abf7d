// How far the triangles of one polygon look apart: what val3dity calls 204, on the triangulation that it makes.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/model/solid.h"

namespace blockrand::geometry {

struct NormalDeviation {
  double angle = 0;                       ///< rad: the largest between the normals of two triangles
  std::array<model::Point3, 3> triangle;  ///< the one that leans most off the plane
};

/// The constrained Delaunay triangulation of a polygon in the plane that fits all of its points best (least squares),
/// and the largest angle between the normals that two of its triangles have in space. val3dity 2.6 compares each
/// triangle with the first of the triangulation; which one that is, is chance, so any two count here.
/// \param rings  m: the outer ring, then holes; no point twice
/// \return nothing where the rings cross or touch in that plane
std::optional<NormalDeviation> normal_deviation(std::span<const std::vector<model::Point3>> rings);

/// The same of a solid's face: only the angle, in rad. 0 for triangles and where the face lies in one plane.
double normal_deviation(const model::Solid& solid, const model::Face& face);

}  // namespace blockrand::geometry
