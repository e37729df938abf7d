#include "tests/unit/run/surveyed_surfaces.h"

#include <cmath>

namespace blockrand::run::test {

namespace {

double degrees_between(double a, double b) { return std::fabs(std::remainder(a - b, 360.0)); }

}  // namespace

using model::Point2;
using model::Point3;

void add_roof_of(const model::Solid& solid, RoofSurfaces& out) {
  for (const model::Face& face : solid.faces) {
    if (face.kind != model::SurfaceKind::roof && face.kind != model::SurfaceKind::outer_floor) continue;
    std::vector<std::vector<Point3>> rings;
    for (const auto& loop : solid.loops_of(face)) {
      auto& ring = rings.emplace_back();
      for (const std::uint32_t v : solid.indices_of(loop)) ring.push_back(solid.vertices[v]);
    }
    out.add(rings);
  }
}

RoofSurfaces surfaces_of(const roofs::Roof& roof) {
  RoofSurfaces out;
  for (const auto& surface : roof.surfaces)
    if (!surface.upright) out.add(surface.loops);
  return out;
}

int common_directions(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<bool> taken(b.size(), false);
  int common = 0;
  for (const double d : a) {
    std::size_t best = b.size();
    for (std::size_t i = 0; i < b.size(); ++i)
      if (!taken[i] && degrees_between(d, b[i]) <= 20 &&
          (best == b.size() || degrees_between(d, b[i]) < degrees_between(d, b[best])))
        best = i;
    if (best == b.size()) continue;
    taken[best] = true;
    ++common;
  }
  return common;
}

SurfaceError vertical_error(const RoofSurfaces& built, const RoofSurfaces& surveyed, std::span<const Point2> points) {
  SurfaceError out;
  double squares = 0;
  for (const Point2 p : points) {
    const auto a = built.at(p), b = surveyed.at(p);
    if (!a || !b) continue;
    const double d = a->z - b->z;
    ++out.points;
    out.mean += d;
    squares += d * d;
  }
  if (out.points == 0) return out;
  out.mean /= static_cast<double>(out.points);
  out.rms = std::sqrt(squares / static_cast<double>(out.points));
  return out;
}

}  // namespace blockrand::run::test
