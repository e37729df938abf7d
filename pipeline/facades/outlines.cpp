#include "pipeline/facades/outlines.h"

#include <algorithm>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::facades {

using model::Point2;

Box2 box_of(std::span<const Point2> ring) {
  Box2 box{ring[0].x, ring[0].x, ring[0].y, ring[0].y};
  for (const Point2& p : ring)
    box = {std::min(box.left, p.x), std::max(box.right, p.x), std::min(box.low, p.y), std::max(box.high, p.y)};
  return box;
}

bool segments_meet(Point2 a, Point2 b, Point2 c, Point2 d) {
  const double abc = cross(a, b, c), abd = cross(a, b, d), cda = cross(c, d, a), cdb = cross(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0))) return true;
  const auto between = [](Point2 p, Point2 q, Point2 r) {
    return std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= r.y &&
           r.y <= std::max(p.y, q.y);
  };
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
         (cdb == 0 && between(c, d, b));
}

namespace {

bool nearer_than(double distance, Point2 a, Point2 b, Point2 c, Point2 d) {
  if (std::max(a.x, b.x) + distance < std::min(c.x, d.x) || std::max(c.x, d.x) + distance < std::min(a.x, b.x) ||
      std::max(a.y, b.y) + distance < std::min(c.y, d.y) || std::max(c.y, d.y) + distance < std::min(a.y, b.y))
    return false;
  return segments_meet(a, b, c, d) || geometry::distance_to_segment(a, c, d) < distance ||
         geometry::distance_to_segment(b, c, d) < distance || geometry::distance_to_segment(c, a, b) < distance ||
         geometry::distance_to_segment(d, a, b) < distance;
}

}  // namespace

bool rings_nearer_than(double distance, std::span<const Point2> a, const Box2& around_a, std::span<const Point2> b) {
  for (std::size_t k = 0; k < b.size(); ++k) {
    const Point2 c = b[k], d = b[k + 1 == b.size() ? 0 : k + 1];
    const Box2 edge{std::min(c.x, d.x), std::max(c.x, d.x), std::min(c.y, d.y), std::max(c.y, d.y)};
    if (edge.apart(around_a, distance)) continue;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (nearer_than(distance, a[i], a[i + 1 == a.size() ? 0 : i + 1], c, d)) return true;
  }
  return false;
}

bool surely_inside(std::span<const Point2> ring, Point2 p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[i + 1 == ring.size() ? 0 : i + 1];
    if ((a.y > p.y) != (b.y > p.y) && (b.y > a.y) == (cross(a, b, p) > 0)) inside = !inside;
  }
  return inside;
}

bool is_simple_by(double feature, std::span<const Point2> ring) {
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % n];
    for (std::size_t k = 0; k < n; ++k)
      if (k != i && k != (i + 1) % n && geometry::distance_to_segment(ring[k], a, b) < feature) return false;
    for (std::size_t k = i + 2; k < n; ++k)
      if ((k + 1) % n != i && segments_meet(a, b, ring[k], ring[(k + 1) % n])) return false;
  }
  return true;
}

}  // namespace blockrand::facades
