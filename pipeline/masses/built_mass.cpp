#include "pipeline/masses/built_mass.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "pipeline/geometry/grid.h"

namespace blockrand::masses {

using model::Point2;
using model::Point3;

namespace {

/// Through whole numbers, as the solid's vertices are made: model::snap() may leave a negative zero.
double on_grid(double metres) {
  const double step = 1.0 / model::kGridStepsPerMetre;
  return static_cast<double>(geometry::to_grid(metres)) * step;
}
Point3 on_grid(const Point3& p) { return {on_grid(p.x), on_grid(p.y), on_grid(p.z)}; }

model::Ring on_grid(model::Ring ring) {
  for (Point2& p : ring.points) p = {on_grid(p.x), on_grid(p.y)};
  return ring;
}

std::vector<Point3> on_grid(const std::vector<Point3>& line) {
  std::vector<Point3> out;
  out.reserve(line.size());
  for (const Point3& p : line)
    if (const Point3 rounded = on_grid(p); out.empty() || out.back() != rounded) out.push_back(rounded);
  return out;
}

std::vector<Point3> closed_on_grid(const std::vector<Point3>& loop) {
  std::vector<Point3> out = on_grid(loop);
  while (out.size() > 1 && out.back() == out.front()) out.pop_back();
  return out;
}

}  // namespace

BuiltMass built_mass(const model::Polygon& plan, double bottom, const roofs::Roof& roof) {
  BuiltMass out;
  out.plan.outer = on_grid(plan.outer);
  for (const model::Ring& hole : plan.holes) out.plan.holes.push_back(on_grid(hole));
  out.bottom = on_grid(bottom);
  out.roof.elements = roof.elements;
  out.roof.wall_tops.reserve(roof.wall_tops.size());
  for (const auto& top : roof.wall_tops) out.roof.wall_tops.push_back(on_grid(top));
  out.roof.surfaces.reserve(roof.surfaces.size());
  for (const roofs::Roof::Surface& surface : roof.surfaces) {
    roofs::Roof::Surface made{surface.edge, {}, surface.upright, surface.element};
    for (const auto& loop : surface.loops) {
      auto points = closed_on_grid(loop);
      if (points.size() >= 3)
        made.loops.push_back(std::move(points));
      else if (made.loops.empty())
        break;  // without its outer loop the surface is left out, its holes with it
    }
    if (!made.loops.empty()) out.roof.surfaces.push_back(std::move(made));
  }
  return out;
}

BuiltMasses::BuiltMasses(std::vector<Entry> entries) : entries_(std::move(entries)) {
  assert(std::adjacent_find(entries_.begin(), entries_.end(),
                            [](const Entry& a, const Entry& b) { return a.body >= b.body; }) == entries_.end());
}

const BuiltMass* BuiltMasses::find(BodyIndex body) const {
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), body,
                                      [](const Entry& entry, BodyIndex wanted) { return entry.body < wanted; });
  return place != entries_.end() && place->body == body ? &place->mass : nullptr;
}

BuiltMass* BuiltMasses::find(BodyIndex body) {
  return const_cast<BuiltMass*>(static_cast<const BuiltMasses&>(*this).find(body));
}

}  // namespace blockrand::masses
