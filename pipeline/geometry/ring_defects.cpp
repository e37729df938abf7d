#include "pipeline/geometry/ring_defects.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace blockrand::geometry {

namespace {

using Rings = std::vector<std::vector<Grid2>>;

struct Edge {
  Grid2 a, b;
  std::uint32_t ring, index, ring_size;
  std::int64_t min_x() const { return std::min(a.x, b.x); }
  std::int64_t max_x() const { return std::max(a.x, b.x); }
};

/// How two edges meet.
enum class Meeting { none, point, stretch, crossing };

Meeting meeting(const Edge& e, const Edge& f) {
  if (std::max(std::min(e.a.y, e.b.y), std::min(f.a.y, f.b.y)) >
      std::min(std::max(e.a.y, e.b.y), std::max(f.a.y, f.b.y)))
    return Meeting::none;
  const int o1 = orientation(e.a, e.b, f.a), o2 = orientation(e.a, e.b, f.b);
  const int o3 = orientation(f.a, f.b, e.a), o4 = orientation(f.a, f.b, e.b);
  if (o1 * o2 < 0 && o3 * o4 < 0) return Meeting::crossing;
  if (o1 == 0 && o2 == 0) {
    const auto low = std::max(std::min(e.a, e.b), std::min(f.a, f.b));
    const auto high = std::min(std::max(e.a, e.b), std::max(f.a, f.b));
    return low < high ? Meeting::stretch : low == high ? Meeting::point : Meeting::none;
  }
  return on_segment(e.a, e.b, f.a) || on_segment(e.a, e.b, f.b) || on_segment(f.a, f.b, e.a) ||
                 on_segment(f.a, f.b, e.b)
             ? Meeting::point
             : Meeting::none;
}

/// Neighbours in a ring have a point in common, which is no fault.
bool neighbours(const Edge& e, const Edge& f) {
  return e.ring == f.ring && ((e.index + 1) % e.ring_size == f.index || (f.index + 1) % f.ring_size == e.index);
}

/// A point where two edges that only touch do so: an end of one of them.
Grid2 touching_point(const Edge& e, const Edge& f) {
  for (const Grid2 p : {e.a, e.b})
    if (on_segment(f.a, f.b, p)) return p;
  return on_segment(e.a, e.b, f.a) ? f.a : f.b;
}

enum class Side { inside, outside, boundary };

Side side_of(const std::vector<Grid2>& ring, Grid2 p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Grid2 a = ring[i], b = ring[(i + 1) % ring.size()];
    if (on_segment(a, b, p)) return Side::boundary;
    if ((a.y > p.y) != (b.y > p.y) && (b.y > a.y) == (orientation(a, b, p) > 0)) inside = !inside;
  }
  return inside ? Side::inside : Side::outside;
}

/// Where a ring lies seen from another: its corners and middles of edges (coordinates are even). Both inside and
/// outside where it crosses through corners.
struct Where {
  bool inside = false, outside = false;
};
Where where(const std::vector<Grid2>& ring, const std::vector<Grid2>& seen_from, bool all_points) {
  Where out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Grid2 a = ring[i], b = ring[(i + 1) % ring.size()];
    for (const Grid2 p : {a, Grid2{(a.x + b.x) / 2, (a.y + b.y) / 2}}) {
      const Side side = side_of(seen_from, p);
      out.inside = out.inside || side == Side::inside;
      out.outside = out.outside || side == Side::outside;
      if (!all_points && side != Side::boundary) return out;
    }
  }
  return out;
}

Int128 twice_area(const std::vector<Grid2>& ring) {
  Int128 sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Grid2 u = ring[i] - ring[0], v = ring[i + 1] - ring[0];
    sum += static_cast<Int128>(u.x) * v.y - static_cast<Int128>(u.y) * v.x;
  }
  return sum;
}

/// The same cycle of points, in either direction, from any first point.
bool equal_rings(const std::vector<Grid2>& a, const std::vector<Grid2>& b) {
  if (a.size() != b.size()) return false;
  const std::size_t n = a.size();
  const auto at = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  if (at == n) return false;
  bool forwards = true, backwards = true;
  for (std::size_t i = 0; i < n; ++i) {
    forwards = forwards && a[i] == b[(at + i) % n];
    backwards = backwards && a[i] == b[(at + n - i) % n];
  }
  return forwards || backwards;
}

/// Rings and the points where they touch, as a graph: a cycle in it encloses a piece of the polygon.
bool has_cycle(const std::map<Grid2, std::set<int>>& touches, std::size_t ring_count) {
  std::vector<std::size_t> parent(ring_count + touches.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::size_t point = ring_count;
  for (const auto& [place, rings] : touches) {
    for (const int ring : rings) {
      const std::size_t a = root(point), b = root(static_cast<std::size_t>(ring));
      if (a == b) return true;
      parent[a] = b;
    }
    ++point;
  }
  return false;
}

}  // namespace

RingsDefect find_rings_defect(std::span<const std::vector<Grid2>> given) {
  Rings rings(given.begin(), given.end());
  const int count = static_cast<int>(rings.size());
  for (int r = 0; r < count; ++r) {
    auto& ring = rings[static_cast<std::size_t>(r)];
    if (ring.size() < 3) return {SolidDefect::too_few_points, r};
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (ring[i] == ring[(i + 1) % ring.size()]) return {SolidDefect::same_points, r};
    for (Grid2& p : ring) p = {2 * p.x, 2 * p.y};  // so that middles of edges are on the grid
    if (twice_area(ring) == 0) return {SolidDefect::ring_crosses, r};
  }
  std::vector<Edge> edges;
  for (int r = 0; r < count; ++r) {
    const auto& ring = rings[static_cast<std::size_t>(r)];
    const auto n = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < n; ++i)
      edges.push_back({ring[i], ring[(i + 1) % n], static_cast<std::uint32_t>(r), i, n});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& f) {
    return std::tuple(e.min_x(), e.ring, e.index) < std::tuple(f.min_x(), f.ring, f.index);
  });
  std::set<std::pair<int, int>> crossing, touching;
  std::map<Grid2, std::set<int>> touches;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size() && edges[j].min_x() <= edges[i].max_x(); ++j) {
      const Edge &e = edges[i], &f = edges[j];
      const Meeting how = meeting(e, f);
      if (how == Meeting::none) continue;
      const int a = static_cast<int>(std::min(e.ring, f.ring)), b = static_cast<int>(std::max(e.ring, f.ring));
      if (a == b) {
        if (how == Meeting::point && neighbours(e, f)) continue;
        return {SolidDefect::ring_crosses, a};
      }
      if (how != Meeting::point) {
        crossing.emplace(a, b);
      } else {
        touching.emplace(a, b);
        auto& at = touches[touching_point(e, f)];
        at.insert(a);
        at.insert(b);
      }
    }
  const auto ring = [&](int r) -> const std::vector<Grid2>& { return rings[static_cast<std::size_t>(r)]; };
  for (const auto& [a, b] : crossing)
    if (equal_rings(ring(a), ring(b))) return {SolidDefect::rings_equal, a, b};
  if (!crossing.empty()) return {SolidDefect::rings_meet, crossing.begin()->first, crossing.begin()->second};
  RingsDefect outside, nested;
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      const bool touch = touching.count({a, b}) > 0;
      const Where there = where(ring(b), ring(a), touch);
      if (there.inside && there.outside) return {SolidDefect::rings_meet, a, b};
      if (a == 0) {
        if (there.outside && outside.first < 0) outside = {SolidDefect::hole_outside, b};
      } else if (nested.first < 0 && (there.inside || where(ring(a), ring(b), touch).inside)) {
        nested = {SolidDefect::hole_in_hole, a, b};
      }
    }
  if (outside.first >= 0) return outside;
  if (nested.first >= 0) return nested;
  if (has_cycle(touches, rings.size()))
    return {SolidDefect::face_split, touching.begin()->first, touching.begin()->second};
  if (!touching.empty()) return {SolidDefect::rings_meet, touching.begin()->first, touching.begin()->second};
  for (int b = 1; b < count; ++b)
    if ((twice_area(ring(0)) > 0) == (twice_area(ring(b)) > 0)) return {SolidDefect::hole_turned, b};
  return {};
}

}  // namespace blockrand::geometry
