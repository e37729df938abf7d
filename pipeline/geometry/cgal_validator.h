// A second opinion on solids that shares no code with geometry::check_solid: CGAL's polygon mesh processing.
#pragma once

#include <string>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::geometry {

/// One planar polygon with holes; rings without a repeated last point, outer counter-clockwise from outside.
using PolygonRings = std::vector<std::vector<model::Point3>>;

/// Empty when the boundary encloses a volume: closed, manifold, outward, free of self-intersections. Else what is wrong.
/// Points are equal only when their coordinates are.
std::string validate_solid(const std::vector<PolygonRings>& polygons);

/// The same for triangles.
std::string validate_triangles(const std::vector<std::vector<model::Point3>>& triangles);

}  // namespace blockrand::geometry
