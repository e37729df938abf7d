#include "pipeline/masses/stacked_parts.h"

#include <algorithm>

#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::masses {

namespace {

constexpr double kLeastCommon = 1e-4;     // m²; less is no ground that two parts share
constexpr double kLeastThickness = 0.01;  // m, of a slab

bool share_ground(const model::Polygon& a, const model::Polygon& b) {
  if (!geometry::box_of(a.outer.points).near(geometry::box_of(b.outer.points), 0)) return false;
  return geometry::common_area(std::vector{a}, std::vector{b}) > kLeastCommon;
}

}  // namespace

std::vector<GivenWay> settle_stacks(std::span<const model::Polygon> plans, std::span<Levels> levels) {
  std::vector<GivenWay> out;
  for (std::size_t i = 0; i < levels.size(); ++i)
    for (std::size_t k = 0; k < levels.size(); ++k) {
      // i below k; of equal bottoms neither is below.
      if (i == k || plans[i].outer.points.size() < 3 || plans[k].outer.points.size() < 3) continue;
      Levels &lower = levels[i], &upper = levels[k];
      // What ends higher does not lie below.
      if (!(lower.bottom < upper.bottom && lower.top > upper.bottom && lower.top <= upper.top) ||
          !share_ground(plans[i], plans[k]))
        continue;
      if (lower.eaves == lower.top && upper.bottom - lower.bottom >= kLeastThickness) {
        out.push_back({i, k, lower.top - upper.bottom});
        lower.eaves = lower.top = upper.bottom;
      } else if (2 * (upper.top - lower.top) >= upper.top - upper.bottom &&
                 upper.eaves - lower.top >= kLeastThickness) {
        out.push_back({k, i, lower.top - upper.bottom});
        upper.bottom = lower.top;
      }
    }
  return out;
}

}  // namespace blockrand::masses
