#include "pipeline/generate/ridge_direction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/geometry/polygon.h"

namespace blockrand::generate {

using model::Point2;
using model::Polygon;
using model::Ring;

namespace {

/// Share of a side's length: less of it covered is a corner or a shed, not a neighbour.
constexpr double kNeighbour = 0.3;
/// Share of the one long side that must be covered where nobody stands at the other: garages cover less.
constexpr double kMostOfSide = 0.5;
/// m. Party walls of an outline are walls of a part that lies so near: repair moves both together.
constexpr double kSameWall = 0.1;

double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }

double distance_to_boundary(const Polygon& plan, Point2 p) {
  double nearest = 1e300;
  const auto ring = [&](const Ring& r) {
    for (std::size_t i = 0; i < r.size(); ++i)
      nearest = std::min(nearest, geometry::distance_to_segment(p, r.points[i], r.points[(i + 1) % r.size()]));
  };
  ring(plan.outer);
  for (const Ring& hole : plan.holes) ring(hole);
  return nearest;
}

}  // namespace

bool ridge_runs_across(const Polygon& plan, std::span<const WallStretch> party_walls, double widest) {
  if (plan.outer.size() < 3 || party_walls.empty()) return false;
  const Point2 axis = geometry::long_axis(plan.outer.points), side{-axis.y, axis.x};
  const auto extent = [&](Point2 direction) {
    const auto e = geometry::extent_along(plan.outer.points, direction);
    return e.maximum - e.minimum;
  };
  const double length = extent(axis), width = extent(side);
  if (length > widest || width <= 0) return false;
  // Covered length of the long sides that look left and right of the axis, and of the short sides behind and ahead.
  std::array<double, 2> long_sides{}, short_sides{};
  for (const WallStretch& wall : party_walls) {
    const Point2 d{wall.b.x - wall.a.x, wall.b.y - wall.a.y};
    const double along = dot(d, axis), across = dot(d, side);
    if (std::fabs(along) > std::fabs(across))
      long_sides[along > 0] += std::fabs(along);
    else
      short_sides[across > 0] += std::fabs(across);
  }
  if (std::max(short_sides[0], short_sides[1]) > kNeighbour * width) return false;
  const auto [less, more] = std::minmax(long_sides[0], long_sides[1]);
  return less > kNeighbour * length || more > kMostOfSide * length;
}

std::vector<WallStretch> party_walls_at(const model::Building& building, const Polygon& plan) {
  std::vector<WallStretch> out;
  for (const model::FacadeEdge& e : building.edges) {
    if (e.kind != model::EdgeKind::party_wall || e.polygon >= building.outline.size()) continue;
    const Polygon& outline = building.outline[e.polygon];
    if (e.ring > outline.holes.size()) continue;
    const Ring& ring = e.ring == 0 ? outline.outer : outline.holes[e.ring - 1];
    if (e.edge >= ring.size()) continue;
    const Point2 p = ring.points[e.edge], q = ring.points[(e.edge + 1) % ring.size()];
    const Point2 d{q.x - p.x, q.y - p.y};
    const double l = std::sqrt(dot(d, d));
    if (l <= 0) continue;
    const auto at = [&](double s) { return Point2{p.x + d.x * s / l, p.y + d.y * s / l}; };
    if (distance_to_boundary(plan, at((e.start + e.end) / 2)) <= kSameWall) out.push_back({at(e.start), at(e.end)});
  }
  return out;
}

}  // namespace blockrand::generate
