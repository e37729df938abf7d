// Faces that fit each other, as the outlines of what they cover in plan.
#pragma once

#include <vector>

#include "pipeline/model/polygon.h"
#include "pipeline/model/surroundings.h"

namespace blockrand::outputs {

/// Polygons without the edges that two faces share. Valid in OGC's sense where the faces fit point for point and none lies over
/// another: rings may touch at points, insides hang together. Faces without area in plan count as nothing, faces seen from below
/// as if they were seen from above. Each ring begins at its least point (x, then y); polygons in the order of their first points.
/// O(n log n), and holes times polygons.
std::vector<model::Polygon> dissolved(const std::vector<model::FlatPolygon>& faces);

}  // namespace blockrand::outputs
