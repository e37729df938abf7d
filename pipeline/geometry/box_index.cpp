#include "pipeline/geometry/box_index.h"

namespace blockrand::geometry {

void PlanBox::include(model::Point2 p) {
  if (empty()) {
    minimum = maximum = p;
    return;
  }
  minimum = {std::min(minimum.x, p.x), std::min(minimum.y, p.y)};
  maximum = {std::max(maximum.x, p.x), std::max(maximum.y, p.y)};
}

void PlanBox::include(const PlanBox& other) {
  if (other.empty()) return;
  include(other.minimum);
  include(other.maximum);
}

PlanBox box_of(std::span<const model::Point2> points) {
  PlanBox box;
  for (const model::Point2 p : points) box.include(p);
  return box;
}

bool PlanBox::near(const PlanBox& other, double distance) const {
  if (empty() || other.empty()) return false;
  return minimum.x <= other.maximum.x + distance && other.minimum.x <= maximum.x + distance &&
         minimum.y <= other.maximum.y + distance && other.minimum.y <= maximum.y + distance;
}

}  // namespace blockrand::geometry
