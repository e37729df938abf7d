// Arithmetic of points and directions: + - * / and sqrt alone, which every x86-64 rounds alike (DESIGN law 3).
#pragma once

#include <cmath>

#include "pipeline/model/point.h"

namespace blockrand::picture {

using model::Point3;

inline Point3 plus(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point3 minus(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 times(Point3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point3 cross(Point3 a, Point3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Point3 a) { return std::sqrt(dot(a, a)); }
/// `a` with length 1; zero where it has none.
inline Point3 unit(Point3 a) {
  const double l = length(a);
  return l > 0 ? times(a, 1 / l) : Point3{};
}

}  // namespace blockrand::picture
