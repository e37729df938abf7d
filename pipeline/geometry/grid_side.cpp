#include "pipeline/geometry/grid_side.h"

#include <cstdint>

#include "pipeline/geometry/grid.h"

namespace blockrand::geometry {

model::Point2 grid_point_on_left(model::Point2 p, model::Point2 a, model::Point2 b) {
  constexpr std::int64_t kAround = 2;  // steps: there is one on each side of any line through the middle
  const double steps = model::kGridStepsPerMetre;
  const Grid2 from = to_grid(a), to = to_grid(b), middle = to_grid(model::snap(p));
  model::Point2 best = model::snap(p);
  double nearest = -1;
  for (std::int64_t x = -kAround; x <= kAround; ++x)
    for (std::int64_t y = -kAround; y <= kAround; ++y) {
      const Grid2 at{middle.x + x, middle.y + y};
      if (orientation(from, to, at) < 0) continue;
      const model::Point2 q{static_cast<double>(at.x) / steps, static_cast<double>(at.y) / steps};
      const double distance = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
      if (nearest >= 0 && distance >= nearest) continue;
      best = q;
      nearest = distance;
    }
  return best;
}

}  // namespace blockrand::geometry
