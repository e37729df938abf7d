#include "pipeline/geometry/polygon_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/geometry/grid.h"
#include "pipeline/model/vector.h"

namespace blockrand::geometry {

using model::Point2;
using model::Polygon;
using model::Ring;

double signed_area(std::span<const Point2> ring) {
  if (ring.size() < 3) return 0;
  const Point2 o = ring[0];
  double twice = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    twice += (ring[i].x - o.x) * (ring[i + 1].y - o.y) - (ring[i].y - o.y) * (ring[i + 1].x - o.x);
  return twice / 2;
}

double area(const Polygon& polygon) {
  double sum = std::fabs(signed_area(polygon.outer.points));
  for (const Ring& hole : polygon.holes) sum -= std::fabs(signed_area(hole.points));
  return sum;
}

double perimeter(std::span<const Point2> ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    sum += distance(b, a);
  }
  return sum;
}

double perimeter(const Polygon& polygon) {
  double sum = perimeter(polygon.outer.points);
  for (const Ring& hole : polygon.holes) sum += perimeter(hole.points);
  return sum;
}

Point2 centroid(std::span<const Point2> ring) {
  if (ring.empty()) return {};
  const Point2 o = ring[0];
  double twice = 0, sx = 0, sy = 0, mx = 0, my = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a{ring[i].x - o.x, ring[i].y - o.y};
    const Point2 next = ring[(i + 1) % ring.size()];
    const Point2 b{next.x - o.x, next.y - o.y};
    const double cross = a.x * b.y - a.y * b.x;
    twice += cross;
    sx += (a.x + b.x) * cross;
    sy += (a.y + b.y) * cross;
    mx += a.x;
    my += a.y;
  }
  const double n = static_cast<double>(ring.size());
  if (std::fabs(twice) < 1e-9) return {o.x + mx / n, o.y + my / n};
  return {o.x + sx / (3 * twice), o.y + sy / (3 * twice)};
}

bool contains(std::span<const Point2> ring, Point2 p) {
  if (ring.empty()) return false;
  bool inside = false;
  const Grid2 q = to_grid(p);
  Grid2 a = to_grid(ring.back());
  for (const Point2& corner : ring) {
    const Grid2 b = to_grid(corner);
    const bool apart = (a.y > q.y && b.y > q.y) || (a.y < q.y && b.y < q.y);  // most edges
    if (!apart) {
      if (on_segment(a, b, q)) return true;
      if ((a.y > q.y) != (b.y > q.y)) {
        const int side = orientation(a, b, q);
        if ((b.y > a.y) == (side > 0)) inside = !inside;
      }
    }
    a = b;
  }
  return inside;
}

bool contains(const Polygon& polygon, Point2 p) {
  if (!contains(polygon.outer.points, p)) return false;
  for (const Ring& hole : polygon.holes) {
    if (!contains(hole.points, p)) continue;
    bool on_edge = false;
    for (std::size_t i = 0; i < hole.size() && !on_edge; ++i)
      on_edge = on_segment(to_grid(hole.points[i]), to_grid(hole.points[(i + 1) % hole.size()]), to_grid(p));
    if (!on_edge) return false;
  }
  return true;
}

double distance_to_segment(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  double t = length2 > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / length2 : 0;
  t = std::clamp(t, 0.0, 1.0);
  const double ex = p.x - (a.x + t * dx), ey = p.y - (a.y + t * dy);
  return std::sqrt(ex * ex + ey * ey);
}

void orient(Ring& ring, bool counter_clockwise) {
  if ((signed_area(ring.points) > 0) == counter_clockwise) return;
  std::reverse(ring.points.begin(), ring.points.end());
  std::reverse(ring.nodes.begin(), ring.nodes.end());
}

void remove_collinear(Ring& ring, double tolerance) {
  // A linked list keeps the neighbours; each round removes the flattest point, so that the result does not depend on
  // where the ring starts (ties: smaller coordinates). Rings of thousands of points take the one-pass way first.
  const std::size_t n = ring.size();
  if (n <= 3) return;
  std::vector<std::size_t> next(n), previous(n);
  for (std::size_t i = 0; i < n; ++i) next[i] = (i + 1) % n, previous[i] = (i + n - 1) % n;
  std::vector<double> deviation(n);
  std::vector<bool> removed(n, false);
  const auto measure = [&](std::size_t i) {
    // A turn back (spike) is not collinear: its tip is far from the segment between its neighbours.
    return distance_to_segment(ring.points[i], ring.points[previous[i]], ring.points[next[i]]);
  };
  struct Entry {
    double deviation;
    Point2 point;
    std::size_t index;
    bool operator<(const Entry& o) const {
      if (deviation != o.deviation) return deviation > o.deviation;
      return o.point < point;
    }
  };
  std::vector<Entry> heap;
  for (std::size_t i = 0; i < n; ++i) {
    deviation[i] = measure(i);
    if (deviation[i] <= tolerance) heap.push_back({deviation[i], ring.points[i], i});
  }
  if (heap.empty()) return;
  std::make_heap(heap.begin(), heap.end());
  std::size_t left = n;
  while (!heap.empty() && left > 3) {
    std::pop_heap(heap.begin(), heap.end());
    const Entry entry = heap.back();
    heap.pop_back();
    const std::size_t i = entry.index;
    if (removed[i] || entry.deviation != deviation[i]) continue;
    removed[i] = true;
    --left;
    const std::size_t p = previous[i], q = next[i];
    next[p] = q;
    previous[q] = p;
    for (const std::size_t k : {p, q}) {
      const double was = deviation[k];
      // Deviations only accumulate: a point that was kept for its corner must not vanish by many small steps.
      deviation[k] = std::max(measure(k), entry.deviation);
      if (deviation[k] <= tolerance && deviation[k] != was) {
        heap.push_back({deviation[k], ring.points[k], k});
        std::push_heap(heap.begin(), heap.end());
      }
    }
  }
  Ring kept;
  for (std::size_t i = 0; i < n; ++i) {
    if (removed[i]) continue;
    kept.points.push_back(ring.points[i]);
    kept.nodes.push_back(ring.nodes[i]);
  }
  ring = std::move(kept);
}

double equivalent_width(const Polygon& polygon) {
  const double half_perimeter = perimeter(polygon) / 2, a = area(polygon);
  const double discriminant = half_perimeter * half_perimeter - 4 * a;
  if (discriminant <= 0) return std::sqrt(std::max(a, 0.0));
  return (half_perimeter - std::sqrt(discriminant)) / 2;
}

Extent extent_along(std::span<const Point2> ring, Point2 direction) {
  if (ring.empty()) return {0, 0};
  Extent e{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Point2 p : ring) {
    const double d = p.x * direction.x + p.y * direction.y;
    e.minimum = std::min(e.minimum, d);
    e.maximum = std::max(e.maximum, d);
  }
  return e;
}

Point2 long_axis(std::span<const Point2> ring) {
  // The smallest rectangle has a side along an edge of the hull; trying all ring edges costs little at footprint sizes.
  // Large rings look at no more than 256 edges, the longest information being in the long ones anyway.
  std::vector<std::size_t> edges(ring.size());
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = i;
  const auto length2 = [&](std::size_t i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
  };
  constexpr std::size_t kMostEdges = 256;
  if (edges.size() > kMostEdges) {
    std::stable_sort(edges.begin(), edges.end(), [&](std::size_t i, std::size_t j) { return length2(i) > length2(j); });
    edges.resize(kMostEdges);
  }
  double best = std::numeric_limits<double>::infinity();
  Point2 axis{1, 0};
  for (const std::size_t i : edges) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    const double length = std::sqrt(length2(i));
    if (length <= 0) continue;
    const Point2 u{(b.x - a.x) / length, (b.y - a.y) / length}, v{-u.y, u.x};
    const Extent along = extent_along(ring, u), across = extent_along(ring, v);
    const double l = along.maximum - along.minimum, w = across.maximum - across.minimum;
    if (l * w < best * (1 - 1e-9)) {
      best = l * w;
      axis = l >= w ? u : v;
    }
  }
  return axis;
}

}  // namespace blockrand::geometry
