// Triangles of polygons as strangers draw them: not quite plane, with spikes, touching or crossing themselves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/compare/city.h"

namespace blockrand::compare {

using Triangle3 = std::array<Point3, 3>;

/// Triangles of a polygon with holes, turned as its outer ring is; their corners are the polygon's own. Polygons that
/// are not simple in the projection along their normal are mended there (geometry::make_valid; new corners lie in the
/// mean plane). Empty for polygons without an area. \param mended  set to true where that was needed
std::vector<Triangle3> triangles_of(const Rings3& rings, bool* mended = nullptr);

}  // namespace blockrand::compare
