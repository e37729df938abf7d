#include "styles/roofs/roof_outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "pipeline/geometry/grid.h"
#include "pipeline/model/vector.h"

namespace blockrand::roofs {

using geometry::Grid3;
using model::Point2;
using model::Point3;

namespace {

constexpr double kLevel = 0.0349;  // tan 2 degrees

/// Newell's normal, twice the area long.
Point3 normal_of(const std::vector<std::vector<Point3>>& loops) {
  Point3 n;
  const Point3 o = loops[0][0];
  for (const auto& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3 &p = loop[i], &q = loop[(i + 1) % loop.size()];
      n = n + cross(p - o, q - o);
    }
  return n;
}

/// What of the segment pq lies deeper than `depth` in the polygon, as shares of pq; empty when first > second.
std::pair<double, double> inside_range(const std::vector<Point2>& convex, Point2 p, Point2 q, double depth) {
  double first = 0, last = 1;
  for (std::size_t i = 0; i < convex.size(); ++i) {
    const Point2 a = convex[i], b = convex[(i + 1) % convex.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (length == 0) continue;
    const auto left = [&](Point2 r) {
      return ((b.x - a.x) * (r.y - a.y) - (b.y - a.y) * (r.x - a.x)) / length - depth;
    };
    const double at_p = left(p), at_q = left(q);
    if (at_p < 0 && at_q < 0) return {1, 0};
    if (at_p < 0) first = std::max(first, at_p / (at_p - at_q));
    if (at_q < 0) last = std::min(last, at_p / (at_p - at_q));
  }
  return {first, last};
}

}  // namespace

RoofPlane plane_of(const Roof::Surface& surface) {
  const Point3 n = normal_of(surface.loops);
  RoofPlane plane;
  // The mean of the outer loop: what is not quite plane is off to both sides then.
  const auto& loop = surface.loops[0];
  const Point3 o = loop[0];
  for (const Point3& p : loop) {
    plane.point.x += p.x - o.x;
    plane.point.y += p.y - o.y;
    plane.point.z += p.z - o.z;
  }
  const double count = static_cast<double>(loop.size());
  plane.point = {o.x + plane.point.x / count, o.y + plane.point.y / count, o.z + plane.point.z / count};
  if (n.z > 0) plane.gradient = {-n.x / n.z, -n.y / n.z};
  return plane;
}

bool is_level(const Roof::Surface& surface) {
  const Point3 n = normal_of(surface.loops);
  return !surface.upright && n.z > 0 && std::hypot(n.x, n.y) <= kLevel * n.z;
}

double TopSegment::length() const { return std::hypot(to.x - from.x, to.y - from.y); }

std::vector<TopSegment> top_segments(const model::Polygon& plan, const Roof& roof) {
  std::map<std::pair<Grid3, Grid3>, std::int32_t> surface_at;
  for (std::size_t s = 0; s < roof.surfaces.size(); ++s) {
    if (roof.surfaces[s].upright) continue;
    for (const auto& loop : roof.surfaces[s].loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        surface_at[{geometry::to_grid(loop[i]), geometry::to_grid(loop[(i + 1) % loop.size()])}] =
            static_cast<std::int32_t>(s);
  }
  std::vector<TopSegment> out;
  std::uint32_t edge = 0;
  const auto add_ring = [&](const model::Ring& ring, std::uint32_t number) {
    for (std::size_t i = 0; i < ring.size(); ++i, ++edge) {
      const auto& top = roof.wall_tops[edge];
      for (std::size_t k = top.size(); k-- > 1;) {
        const Point3 p = top[k], q = top[k - 1];
        TopSegment segment;
        segment.edge = edge;
        segment.ring = number;
        segment.from = p;
        segment.to = q;
        const double length = segment.length();
        if (length == 0) continue;
        segment.along = {(q.x - p.x) / length, (q.y - p.y) / length};
        const auto found = surface_at.find({geometry::to_grid(p), geometry::to_grid(q)});
        if (found != surface_at.end()) {
          segment.surface = found->second;
          segment.gradient = plane_of(roof.surfaces[static_cast<std::size_t>(found->second)]).gradient;
        }
        out.push_back(segment);
      }
    }
  };
  add_ring(plan.outer, 0);
  for (std::size_t h = 0; h < plan.holes.size(); ++h) add_ring(plan.holes[h], static_cast<std::uint32_t>(h + 1));
  return out;
}

std::vector<PlanEdge> plan_edges(const model::Polygon& plan) {
  std::vector<PlanEdge> out;
  const auto add_ring = [&](const model::Ring& ring, std::uint32_t number) {
    const auto first = static_cast<std::uint32_t>(out.size()), count = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      PlanEdge e;
      e.from = ring.points[i];
      e.to = ring.points[(i + 1) % count];
      e.ring = number;
      e.before = first + (i + count - 1) % count;
      e.after = first + (i + 1) % count;
      e.length = std::hypot(e.to.x - e.from.x, e.to.y - e.from.y);
      e.along = {(e.to.x - e.from.x) / e.length, (e.to.y - e.from.y) / e.length};
      out.push_back(e);
    }
  };
  add_ring(plan.outer, 0);
  for (std::size_t h = 0; h < plan.holes.size(); ++h) add_ring(plan.holes[h], static_cast<std::uint32_t>(h + 1));
  return out;
}

bool segment_enters(const std::vector<Point2>& convex, Point2 p, Point2 q, double depth) {
  const auto [first, last] = inside_range(convex, p, q, depth);
  return first < last;
}

bool convex_overlap(const std::vector<Point2>& a, const std::vector<Point2>& b, double depth) {
  const auto enters = [&](const std::vector<Point2>& one, const std::vector<Point2>& other) {
    for (std::size_t i = 0; i < other.size(); ++i)
      if (segment_enters(one, other[i], other[(i + 1) % other.size()], depth)) return true;
    return false;
  };
  if (enters(a, b) || enters(b, a)) return true;
  // The same polygon twice, or one in the other: no border runs inside, but a middle lies there.
  const auto middle = [](const std::vector<Point2>& p) {
    Point2 sum;
    for (const Point2 q : p) sum = {sum.x + q.x - p[0].x, sum.y + q.y - p[0].y};
    const double n = static_cast<double>(p.size());
    return Point2{p[0].x + sum.x / n, p[0].y + sum.y / n};
  };
  const auto holds = [&](const std::vector<Point2>& one, Point2 m) {
    return segment_enters(one, m, {m.x + 1e-6, m.y}, depth);
  };
  return holds(a, middle(b)) && holds(b, middle(a));
}

}  // namespace blockrand::roofs
