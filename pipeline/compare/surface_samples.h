// Places on faces, spread by area, that do not depend on how a surface was cut into polygons.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "pipeline/base/random.h"
#include "pipeline/compare/area_vector.h"
#include "pipeline/compare/face_triangles.h"

namespace blockrand::compare {

/// Unit vectors along a plane, such that faces of one plane get the same ones. \param normal  unit vector
struct PlaneAxes {
  Point3 u, v;
  explicit PlaneAxes(Point3 normal) {
    const bool level = std::fabs(normal.z) > 0.7;
    Point3 a = level ? Point3{1 - normal.x * normal.x, -normal.x * normal.y, -normal.x * normal.z}
                     : Point3{-normal.y, normal.x, 0};
    const double l = length(a);
    u = {a.x / l, a.y / l, a.z / l};
    v = cross(normal, u);
  }
};

/// Calls use(place, m² that it stands for) for one place in every cell of a square lattice in the face's plane whose
/// place lies on the face (stratified sampling). The lattice is fixed by the plane and `anchor` alone, and where in its
/// cell a place lies by the seed and the cell: cutting a face into triangles gives the same places. A face smaller than
/// a cell gets one place or none, as chance has it, and its area on average.
/// \param spacing  m, side of a cell
template <class Use>
void for_each_sample(std::span<const Triangle3> triangles, Point3 normal, Point3 anchor, double spacing,
                     std::uint64_t seed, Use&& use) {
  if (triangles.empty() || !(length(normal) > 0.5)) return;
  const PlaneAxes axes(normal);
  for (const Triangle3& t : triangles) {
    double x[3], y[3];
    for (int i = 0; i < 3; ++i) {
      const Point3 p = t[static_cast<std::size_t>(i)] - anchor;
      x[i] = dot(p, axes.u);
      y[i] = dot(p, axes.v);
    }
    const double twice = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    const double true_twice = length(cross(t[1] - t[0], t[2] - t[0]));
    if (std::fabs(twice) < 1e-12 || !(true_twice > 0)) continue;
    // Polygons that are not plane have triangles that stand across their mean plane.
    const double weight = spacing * spacing * std::min(10.0, true_twice / std::fabs(twice));
    const auto cell = [&](double value) { return static_cast<std::int64_t>(std::floor(value / spacing)); };
    const std::int64_t i0 = cell(std::min({x[0], x[1], x[2]})), i1 = cell(std::max({x[0], x[1], x[2]}));
    const std::int64_t k0 = cell(std::min({y[0], y[1], y[2]})), k1 = cell(std::max({y[0], y[1], y[2]}));
    for (std::int64_t k = k0; k <= k1; ++k)
      for (std::int64_t i = i0; i <= i1; ++i) {
        const std::uint64_t bits =
            base::mix64(base::mix64(seed ^ base::mix64(static_cast<std::uint64_t>(i))) ^ static_cast<std::uint64_t>(k));
        const double px = (static_cast<double>(i) + static_cast<double>(bits >> 32) * 0x1.0p-32) * spacing;
        const double py = (static_cast<double>(k) + static_cast<double>(bits & 0xffffffff) * 0x1.0p-32) * spacing;
        const double b = ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) / twice;
        const double c = ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) / twice;
        if (b < 0 || c < 0 || b + c >= 1) continue;
        const double a = 1 - b - c;
        use(Point3{a * t[0].x + b * t[1].x + c * t[2].x, a * t[0].y + b * t[1].y + c * t[2].y,
                   a * t[0].z + b * t[1].z + c * t[2].z},
            weight);
      }
  }
}

}  // namespace blockrand::compare
