// Arithmetic of points as vectors. Internal to this folder.
#pragma once

#include <cmath>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::compare {

inline model::Point3 minus(model::Point3 a, model::Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline model::Point3 cross(model::Point3 a, model::Point3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double dot(model::Point3 a, model::Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(model::Point3 a) { return std::sqrt(dot(a, a)); }

/// Twice the area of a ring as a vector along its normal (Newell), computed relative to its first point.
inline model::Point3 area_vector(const std::vector<model::Point3>& ring) {
  model::Point3 sum;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const model::Point3 n = cross(minus(ring[i], ring[0]), minus(ring[i + 1], ring[0]));
    sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
  }
  return sum;
}

}  // namespace blockrand::compare
