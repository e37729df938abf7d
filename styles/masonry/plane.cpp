#include "styles/masonry/plane.h"

#include <algorithm>
#include <cmath>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/valid_polygon.h"

namespace blockrand::masonry {
namespace {

/// m. What GEOS moves apart where rings touch: two steps of the grid.
constexpr double kApartRings = 0.002;
/// m. Points nearer than that are one.
constexpr double kSamePoint = 1e-6;
/// m. Edges that the grid would turn by half a right angle.
constexpr double kShortEdge = 0.003;

model::Polygon polygon_of(const Outline& points) {
  model::Polygon out;
  for (const Point2& p : points) out.outer.points.push_back(model::snap(p));
  out.outer.nodes.assign(points.size(), 0);
  return out;
}

std::vector<Outline> outlines_without_holes(const geometry::ValidPolygons& made) {
  std::vector<Outline> out;
  for (const model::Polygon& p : made.polygons)
    if (p.holes.empty()) out.push_back(p.outer.points);
  return out;
}

}  // namespace

Box box_of(std::span<const Point2> points) {
  Box box;
  for (const Point2& p : points) {
    box.left = std::min(box.left, p.x), box.right = std::max(box.right, p.x);
    box.low = std::min(box.low, p.y), box.high = std::max(box.high, p.y);
  }
  return box;
}

double area_of(std::span<const Point2> points) { return geometry::signed_area(points); }

double narrowest(std::span<const Point2> points) {
  double out = 1e300;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2 a = points[i], b = points[(i + 1) % points.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (length < kSamePoint) continue;
    double low = 1e300, high = -1e300;
    for (const Point2& p : points) {
      const double across = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / length;
      low = std::min(low, across), high = std::max(high, across);
    }
    out = std::min(out, high - low);
  }
  return points.size() < 3 ? 0 : out;
}

bool is_convex(std::span<const Point2> points, double tolerance) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = points[i], b = points[(i + 1) % n], c = points[(i + 2) % n];
    const double length = std::hypot(c.x - a.x, c.y - a.y);
    const double turn = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
    if (turn < -tolerance * std::max(length, kSamePoint)) return false;
  }
  return n >= 3;
}

Outline rectangle_outline(double left, double low, double right, double high) {
  return {{left, low}, {right, low}, {right, high}, {left, high}};
}

Outline cut_half_plane(const Outline& convex, Point2 at, Point2 normal) {
  Outline out;
  const auto side = [&](const Point2& p) { return (p.x - at.x) * normal.x + (p.y - at.y) * normal.y; };
  for (std::size_t i = 0; i < convex.size(); ++i) {
    const Point2 &a = convex[i], &b = convex[(i + 1) % convex.size()];
    const double sa = side(a), sb = side(b);
    if (sa <= 0) out.push_back(a);
    if ((sa < 0 && sb > 0) || (sa > 0 && sb < 0)) {
      const double t = sa / (sa - sb);
      out.push_back({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t});
    }
  }
  if (out.size() < 3) out.clear();
  return out;
}

Outline inset_convex(const Outline& convex, double by) {
  Outline out = convex;
  for (std::size_t i = 0; i < convex.size() && !out.empty(); ++i) {
    const Point2 &a = convex[i], &b = convex[(i + 1) % convex.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (length < kSamePoint) continue;
    const Point2 outward{(b.y - a.y) / length, (a.x - b.x) / length};
    out = cut_half_plane(out, {a.x - outward.x * by, a.y - outward.y * by}, outward);
  }
  return out;
}

Outline without_short_edges(const Outline& outline) {
  Outline out;
  for (const Point2& p : outline)
    if (out.empty() || std::hypot(p.x - out.back().x, p.y - out.back().y) > kShortEdge) out.push_back(p);
  while (out.size() > 1 && std::hypot(out[0].x - out.back().x, out[0].y - out.back().y) <= kShortEdge) out.pop_back();
  return out;
}

std::vector<Outline> cut_away(const Outline& from, std::span<const Outline> away, double least) {
  const Box box = box_of(from);
  std::vector<model::Polygon> cutters;
  for (const Outline& o : away)
    if (box_of(o).meets(box)) cutters.push_back(polygon_of(o));
  if (cutters.empty()) return {from};
  const std::vector<model::Polygon> whole{polygon_of(from)};
  return outlines_without_holes(geometry::difference(whole, cutters, least, kApartRings));
}

std::vector<Outline> cut_to(const Outline& from, const Outline& limits, double least) {
  // The part beyond the limits goes: a frame around both, less the limits.
  const Box box = box_of(from);
  const std::vector<model::Polygon> whole{polygon_of(from)};
  const std::vector<model::Polygon> frame{
      polygon_of(rectangle_outline(box.left - 1, box.low - 1, box.right + 1, box.high + 1))};
  const std::vector<model::Polygon> inner{polygon_of(limits)};
  const auto beyond = geometry::difference(frame, inner, 0, kApartRings);
  return outlines_without_holes(geometry::difference(whole, beyond.polygons, least, kApartRings));
}

}  // namespace blockrand::masonry
