// Exact predicates on the 1/1024 m grid: coordinates become integers, so that no test depends on rounding.
#pragma once

#include <cassert>
#include <cmath>
#include <cstdint>

#include "pipeline/model/point.h"

namespace blockrand::geometry {

__extension__ typedef __int128 Int128;

/// Grid coordinates relative to a nearby origin. The predicates below are exact while |coordinate| < 2^31 (2,000 km).
struct Grid2 {
  std::int64_t x = 0, y = 0;
  friend bool operator==(const Grid2&, const Grid2&) = default;
  friend auto operator<=>(const Grid2&, const Grid2&) = default;
};
struct Grid3 {
  std::int64_t x = 0, y = 0, z = 0;
  friend bool operator==(const Grid3&, const Grid3&) = default;
  friend auto operator<=>(const Grid3&, const Grid3&) = default;
};

/// Steps: 268,000 km at 1/1024 m, farther than any place on Earth or in its orbits' frames. Sums and differences of such
/// numbers, and the products of the predicates, stay within their types.
inline constexpr double kFarthestStep = 274877906944.0;  // 2^38

/// A number of steps that integers hold: what lies farther out, or is not a number, lies at the end. Broken files have
/// such coordinates.
inline double within_grid(double steps) {
  return steps > kFarthestStep ? kFarthestStep : steps > -kFarthestStep ? steps : -kFarthestStep;
}
inline std::int64_t to_steps(double steps) { return static_cast<std::int64_t>(std::llrint(within_grid(steps))); }
inline std::int64_t to_grid(double metres) { return to_steps(metres * model::kGridStepsPerMetre); }
inline Grid2 to_grid(model::Point2 p) { return {to_grid(p.x), to_grid(p.y)}; }
inline Grid3 to_grid(model::Point3 p) { return {to_grid(p.x), to_grid(p.y), to_grid(p.z)}; }

inline Grid2 operator-(Grid2 a, Grid2 b) { return {a.x - b.x, a.y - b.y}; }
inline Grid3 operator-(Grid3 a, Grid3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

inline int sign(Int128 v) { return (v > 0) - (v < 0); }

/// +1 when c lies left of the line from a to b, -1 right, 0 on it.
inline int orientation(Grid2 a, Grid2 b, Grid2 c) {
  return sign(static_cast<Int128>(b.x - a.x) * (c.y - a.y) - static_cast<Int128>(b.y - a.y) * (c.x - a.x));
}

/// +1 when d lies on the side of the plane (a, b, c) from which the three run clockwise, i.e. below; -1 above, where
/// they run counter-clockwise; 0 on it.
inline int orientation(Grid3 a, Grid3 b, Grid3 c, Grid3 d) {
  const Grid3 u = a - d, v = b - d, w = c - d;
  // Products of three 32-bit differences fit doubles to a relative error of a few 2^-53; only near zero is exact
  // arithmetic needed.
  const double ux = static_cast<double>(u.x), uy = static_cast<double>(u.y), uz = static_cast<double>(u.z);
  const double vx = static_cast<double>(v.x), vy = static_cast<double>(v.y), vz = static_cast<double>(v.z);
  const double wx = static_cast<double>(w.x), wy = static_cast<double>(w.y), wz = static_cast<double>(w.z);
  const double m1 = ux * (vy * wz - vz * wy), m2 = uy * (vz * wx - vx * wz), m3 = uz * (vx * wy - vy * wx);
  const double det = m1 + m2 + m3;
  const double bound = 1e-14 * (std::fabs(ux) * (std::fabs(vy * wz) + std::fabs(vz * wy)) +
                                std::fabs(uy) * (std::fabs(vz * wx) + std::fabs(vx * wz)) +
                                std::fabs(uz) * (std::fabs(vx * wy) + std::fabs(vy * wx)));
  if (det > bound) return 1;
  if (det < -bound) return -1;
  const Int128 exact = static_cast<Int128>(u.x) * (static_cast<Int128>(v.y) * w.z - static_cast<Int128>(v.z) * w.y) +
                       static_cast<Int128>(u.y) * (static_cast<Int128>(v.z) * w.x - static_cast<Int128>(v.x) * w.z) +
                       static_cast<Int128>(u.z) * (static_cast<Int128>(v.x) * w.y - static_cast<Int128>(v.y) * w.x);
  return sign(exact);
}

/// True when p lies on the closed segment ab.
inline bool on_segment(Grid2 a, Grid2 b, Grid2 p) {
  return orientation(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

}  // namespace blockrand::geometry
