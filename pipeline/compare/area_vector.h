// The area of rings in space. Internal to this folder.
#pragma once

#include <vector>

#include "pipeline/model/vector.h"

namespace blockrand::compare {

/// Twice the area of a ring as a vector along its normal (Newell), computed relative to its first point.
inline model::Point3 area_vector(const std::vector<model::Point3>& ring) {
  model::Point3 sum;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum = sum + cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return sum;
}

}  // namespace blockrand::compare
