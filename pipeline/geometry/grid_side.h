// Grid points on one side of a line: rounding that cannot lead to the other side.
#pragma once

#include "pipeline/model/point.h"

namespace blockrand::geometry {

/// The grid point nearest to `p` that lies on the line from a to b or left of it. `p` lies no farther than a step on
/// its right; a and b are different grid points. At most 1.5 steps of the 1/1024 m grid away. Decided in integers.
model::Point2 grid_point_on_left(model::Point2 p, model::Point2 a, model::Point2 b);

}  // namespace blockrand::geometry
