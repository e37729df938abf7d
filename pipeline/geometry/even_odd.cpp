#include "pipeline/geometry/even_odd.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "pipeline/base/random.h"
#include "pipeline/geometry/footprint_overlap.h"
#include "pipeline/geometry/geos_scope.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/model/vector.h"

namespace blockrand::geometry {

namespace {

using model::Point2;

/// m. Where points stand on edges, moving them by so little decides whether edges cross there; 1/100 of the grid.
constexpr double kApart = 1e-5;

/// The ring's points relative to the first, each moved by less than kApart in a way that depends on its place in the
/// ring alone.
std::vector<Point2> moved_apart(std::span<const Point2> ring) {
  std::vector<Point2> out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::uint64_t bits = base::mix64(i);
    const auto part = [](std::uint64_t half) {
      return kApart * (static_cast<double>(half & 0xffffffff) / 4294967296.0);
    };
    const Point2 p = ring[i] - ring[0];
    out.push_back({p.x + part(bits), p.y + part(bits >> 32)});
  }
  return out;
}

/// Along each edge the places, from 0 to 1 and ascending, where others cross it.
std::vector<std::vector<double>> crossings_of(const std::vector<Point2>& p) {
  const std::size_t n = p.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto end = [&](std::size_t i) { return p[i + 1 == n ? 0 : i + 1]; };
  const auto low = [&](std::size_t i) { return std::min(p[i].x, end(i).x); };
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return low(i) < low(j); });
  std::vector<std::vector<double>> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t e = order[i];
    const Point2 a = p[e], u = end(e) - a;
    const double most = std::max(a.x, end(e).x);
    for (std::size_t k = i + 1; k < n && low(order[k]) <= most; ++k) {
      const std::size_t f = order[k];
      if ((e + 1) % n == f || (f + 1) % n == e) continue;
      const Point2 c = p[f], v = end(f) - c, w = c - a;
      const double turn = cross(u, v);
      if (turn == 0) continue;
      const double along_e = cross(w, v) / turn, along_f = cross(w, u) / turn;
      if (along_e <= 0 || along_e >= 1 || along_f <= 0 || along_f >= 1) continue;
      out[e].push_back(along_e);
      out[f].push_back(along_f);
    }
  }
  for (std::vector<double>& places : out) std::sort(places.begin(), places.end());
  return out;
}

}  // namespace

double tangled_area(const model::Ring& ring) {
  if (ring.size() < 3) return 0;
  const std::vector<Point2> p = moved_apart(ring.points);
  const std::vector<std::vector<double>> crossings = crossings_of(p);
  double twice = 0, side = 1;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point2 a = p[i], u = p[i + 1 == p.size() ? 0 : i + 1] - a;
    double from = 0;
    const auto go_to = [&](double to) {
      twice += side * (to - from) * cross(a, u);  // of a and b, twice the triangle with the origin
      from = to;
    };
    for (const double place : crossings[i]) {
      go_to(place);
      side = -side;  // beyond another edge what is enclosed lies on the other side
    }
    go_to(1);
  }
  return std::fabs(twice) / 2;
}

bool hopeless(const model::Ring& ring) {
  return conflicting_edges({ring, {}}, kMostCrossings + 1).size() > kMostCrossings;
}

model::Ring convex_hull(const model::Ring& ring) {
  std::vector<std::pair<Point2, std::int64_t>> points;
  for (std::size_t i = 0; i < ring.size(); ++i) points.emplace_back(ring.points[i], ring.nodes[i]);
  std::sort(points.begin(), points.end());
  points.erase(
      std::unique(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
      points.end());
  model::Ring hull;
  if (points.size() < 3) return hull;
  const Grid2 origin = to_grid(points[0].first);
  const auto at = [&](std::size_t i) { return to_grid(hull.points[i]) - origin; };
  const auto add = [&](const std::pair<Point2, std::int64_t>& p, std::size_t kept) {
    const Grid2 place = to_grid(p.first) - origin;
    while (hull.size() > kept && orientation(at(hull.size() - 2), at(hull.size() - 1), place) <= 0) {
      hull.points.pop_back();
      hull.nodes.pop_back();
    }
    hull.points.push_back(p.first);
    hull.nodes.push_back(p.second);
  };
  for (const auto& p : points) add(p, 1);  // below, from the least point to the greatest
  const std::size_t below = hull.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], below);
  hull.points.pop_back();  // the least point again
  hull.nodes.pop_back();
  if (hull.size() < 3) hull = {};
  return hull;
}

bool tangled(const model::Ring& ring) {
  const std::size_t most = kTangle * ring.size() + kTangle;
  return conflicting_edges({ring, {}}, most + 1).size() > most;
}

double even_odd_area(const model::Ring& ring) {
  if (ring.size() < 3) return 0;
  if (tangled(ring)) return tangled_area(ring);
  const geos::Geometry polygon = geos::polygon_of({ring, {}}, ring.points[0]);
  // LINEWORK, the other method than the one that mends.
  const geos::Geometry valid = geos::made_valid(polygon.get(), GEOS_MAKE_VALID_LINEWORK);
  double area = 0;
  if (valid) GEOSArea_r(geos::context(), valid.get(), &area);
  return area;
}

}  // namespace blockrand::geometry
