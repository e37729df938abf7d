// Flat roofs, and directions.
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

using model::Point2;
using model::Point3;
using model::Polygon;
using model::Ring;

namespace {

/// Visits all rings, outer first.
template <class Visit>
void for_each_ring(const Polygon& plan, Visit&& visit) {
  visit(plan.outer);
  for (const Ring& hole : plan.holes) visit(hole);
}

/// The roof whose height over every plan point is `z(point)`, an affine function.
template <class Height>
Roof single_plane(const Polygon& plan, Height&& z) {
  Roof roof;
  Roof::Surface surface;
  for_each_ring(plan, [&](const Ring& ring) {
    std::vector<Point3> loop;
    for (const Point2 p : ring.points) loop.push_back({p.x, p.y, z(p)});
    for (std::size_t i = 0; i < loop.size(); ++i) roof.wall_tops.push_back({loop[(i + 1) % loop.size()], loop[i]});
    surface.loops.push_back(std::move(loop));
  });
  roof.surfaces.push_back(std::move(surface));
  return roof;
}

}  // namespace

Point2 compass_vector(double degrees) {
  constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180;
  return {base::sin(degrees * kRadiansPerDegree), base::cos(degrees * kRadiansPerDegree)};
}

Point2 default_slope(const Polygon& plan) {
  double longest = -1;
  Point2 down{0, -1};
  const auto& points = plan.outer.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2 a = points[i], b = points[(i + 1) % points.size()];
    const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    if (length > longest) {
      longest = length;
      down = {(b.y - a.y) / length, -(b.x - a.x) / length};
    }
  }
  return down;
}

Roof flat_roof(const Polygon& plan, double z) {
  return single_plane(plan, [z](Point2) { return z; });
}

}  // namespace blockrand::roofs
