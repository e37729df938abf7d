// Seeded random polygons with holes of the kinds that break roofs: stars, tangles, grids with many equal distances.
#pragma once

#include <cstdint>

#include "pipeline/model/polygon.h"

namespace blockrand::testing_shapes {

/// A strictly simple polygon on the grid, 3 to about 40 corners, 0 to 3 holes, 5 to 60 m wide. By `number % 4`:
/// 0 a star with corners at random distances, 1 a random polygon without order (2-opt), 2 a union of cells of a random
/// grid (exact right angles, many simultaneous events), 3 that grid turned by a random angle and rounded.
model::Polygon random_plan(std::uint64_t seed, std::uint64_t number);

}  // namespace blockrand::testing_shapes
