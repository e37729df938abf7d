#include "importers/elevation/bilinear.h"

#include <algorithm>

namespace blockrand::importers::elevation {
namespace {

/// Below this sum of weights no known corner has any.
constexpr double kNoWeight = 1e-9;

/// c0 + c1 t + c2 t².
struct Quadratic {
  double c0 = 0, c1 = 0, c2 = 0;
  double operator()(double t) const { return c0 + t * (c1 + t * c2); }
};

/// A bilinear function with these corners along the line from `a` to `b`.
Quadratic along(double z00, double z10, double z01, double z11, CellPoint a, CellPoint b) {
  const double per_u = z10 - z00, per_v = z01 - z00, twist = z00 - z10 - z01 + z11;
  const double du = b.u - a.u, dv = b.v - a.v;
  return {z00 + per_u * a.u + per_v * a.v + twist * a.u * a.v, per_u * du + per_v * dv + twist * (a.u * dv + a.v * du),
          twist * du * dv};
}

}  // namespace

void widen(Extremes& extremes, const Cell& cell, CellPoint a, CellPoint b) {
  Extremes corners;
  for (const double z : {cell.z00, cell.z10, cell.z01, cell.z11}) corners.add(z);
  if (!corners.known()) return;
  // Heights above the lowest corner: flat ground comes out exactly.
  const double zero = corners.lowest;
  const auto value = [zero](double z) { return std::isnan(z) ? 0 : z - zero; };
  const auto weight = [](double z) { return std::isnan(z) ? 0.0 : 1.0; };
  const Quadratic n = along(value(cell.z00), value(cell.z10), value(cell.z01), value(cell.z11), a, b);
  const Quadratic w = along(weight(cell.z00), weight(cell.z10), weight(cell.z01), weight(cell.z11), a, b);
  const auto take = [&](double t) {
    if (!(t >= 0 && t <= 1)) return;
    const double sum = w(t);
    if (sum > kNoWeight) extremes.add(zero + std::clamp(n(t) / sum, 0.0, corners.highest - zero));
  };
  take(0);
  take(1);
  // n' w - n w': its cubic term is none.
  const double q0 = n.c1 * w.c0 - n.c0 * w.c1, q1 = 2 * (n.c2 * w.c0 - n.c0 * w.c2), q2 = n.c2 * w.c1 - n.c1 * w.c2;
  const double discriminant = q1 * q1 - 4 * q2 * q0;
  if (discriminant < 0) return;
  const double q = -0.5 * (q1 + std::copysign(std::sqrt(discriminant), q1));
  if (q2 != 0) take(q / q2);
  if (q != 0) take(q0 / q);
}

}  // namespace blockrand::importers::elevation
