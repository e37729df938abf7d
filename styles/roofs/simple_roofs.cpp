// Roofs that need no skeleton: flat, skillion, pyramidal, gabled on four corners.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon.h"
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

/// Signed distance of p to the left of the line from a to b.
double distance_left(Point2 a, Point2 b, Point2 p) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return (dx * (p.y - a.y) - dy * (p.x - a.x)) / std::sqrt(dx * dx + dy * dy);
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

Point2 long_axis(const Polygon& plan) { return geometry::long_axis(plan.outer.points); }

Roof flat_roof(const Polygon& plan, double z) {
  return single_plane(plan, [z](Point2) { return z; });
}

std::optional<Roof> skillion_roof(const Polygon& plan, RoofMeasures measures, Point2 down) {
  const geometry::Extent extent = geometry::extent_along(plan.outer.points, down);
  const double length = extent.maximum - extent.minimum;
  if (length <= 0) return std::nullopt;
  return single_plane(plan, [&](Point2 p) {
    return measures.eaves + measures.height * (extent.maximum - (p.x * down.x + p.y * down.y)) / length;
  });
}

std::optional<Roof> pyramidal_roof(const Polygon& plan, RoofMeasures measures) {
  if (!plan.holes.empty()) return std::nullopt;
  constexpr double kLeastDistance = 0.05;  // m. A nearer edge would make a face that stands almost upright.
  const auto& points = plan.outer.points;
  const Point2 apex = model::snap(geometry::centroid(points));
  Roof roof;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2 a = points[i], b = points[(i + 1) % points.size()];
    if (distance_left(a, b, apex) < kLeastDistance) return std::nullopt;
    const Point3 low_a{a.x, a.y, measures.eaves}, low_b{b.x, b.y, measures.eaves};
    roof.surfaces.push_back(
        {static_cast<std::int32_t>(i), {{low_a, low_b, {apex.x, apex.y, measures.eaves + measures.height}}}});
    roof.wall_tops.push_back({low_b, low_a});
  }
  return roof;
}

std::optional<Roof> gabled_quadrilateral(const Polygon& plan, RoofMeasures measures, int eaves_edge) {
  if (!plan.holes.empty() || plan.outer.size() != 4) return std::nullopt;
  const auto corner = [&](int i) { return plan.outer.points[static_cast<std::size_t>((i + 4) % 4)]; };
  for (int i = 0; i < 4; ++i)
    if (geometry::orientation(geometry::to_grid(corner(i)), geometry::to_grid(corner(i + 1)),
                              geometry::to_grid(corner(i + 2))) <= 0)
      return std::nullopt;
  // Eaves run along 0-1 and 2-3 after this renumbering, gables along 1-2 and 3-0.
  const Point2 p0 = corner(eaves_edge), p1 = corner(eaves_edge + 1), p2 = corner(eaves_edge + 2), p3 = corner(eaves_edge + 3);
  struct Ridge {
    Point2 point;
    double distance;
  };
  // On a gable edge from s (on the first eaves line) to e (on the second) both distances grow linearly; they are equal
  // at the fraction t.
  const auto ridge_end = [&](Point2 s, Point2 e) -> std::optional<Ridge> {
    const double first = distance_left(p0, p1, e), second = distance_left(p2, p3, s);
    if (first <= 0 || second <= 0) return std::nullopt;
    const double t = second / (first + second);
    constexpr double kLeastShare = 0.1;  // a ridge nearer to a corner is no gable any more
    if (t < kLeastShare || t > 1 - kLeastShare) return std::nullopt;
    return Ridge{{s.x + t * (e.x - s.x), s.y + t * (e.y - s.y)}, t * first};
  };
  const auto near_end = ridge_end(p1, p2), far_end = ridge_end(p0, p3);
  if (!near_end || !far_end) return std::nullopt;
  const double pitch = measures.height / std::max(near_end->distance, far_end->distance);
  const auto low = [&](Point2 p) { return Point3{p.x, p.y, measures.eaves}; };
  const auto high = [&](const Ridge& r) { return Point3{r.point.x, r.point.y, measures.eaves + pitch * r.distance}; };
  const Point3 q = high(*near_end), r = high(*far_end);
  Roof roof;
  roof.surfaces.push_back({(eaves_edge) % 4, {{low(p0), low(p1), q, r}}});
  roof.surfaces.push_back({(eaves_edge + 2) % 4, {{low(p2), low(p3), r, q}}});
  roof.wall_tops.resize(4);
  roof.wall_tops[static_cast<std::size_t>(eaves_edge % 4)] = {low(p1), low(p0)};
  roof.wall_tops[static_cast<std::size_t>((eaves_edge + 1) % 4)] = {low(p2), q, low(p1)};
  roof.wall_tops[static_cast<std::size_t>((eaves_edge + 2) % 4)] = {low(p3), low(p2)};
  roof.wall_tops[static_cast<std::size_t>((eaves_edge + 3) % 4)] = {low(p0), r, low(p3)};
  return roof;
}

}  // namespace blockrand::roofs
