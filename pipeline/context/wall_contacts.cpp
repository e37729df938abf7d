#include "pipeline/context/wall_contacts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::context {

namespace {

using model::Point2;

/// m. A way whose node was meant to lie on the outline lies within this.
constexpr double kOnOutline = 0.3;
/// Sine of the least angle between a passage and the wall it opens in (20 degrees): ways along a wall open nothing.
constexpr double kMinPortalSine = 0.342;
/// m. How far behind the outline a way is looked for inside the building.
constexpr double kInside = 0.6;

/// Keeps of overlapping intervals the longest, then the first by `key`; the others keep what sticks out.
template <class Interval, class Key>
std::vector<Interval> without_overlaps(std::vector<Interval> all, Key&& key) {
  std::sort(all.begin(), all.end(), [&](const Interval& p, const Interval& q) {
    const double lp = p.end - p.start, lq = q.end - q.start;
    return std::tuple(-lp, key(p), p.start) < std::tuple(-lq, key(q), q.start);
  });
  std::vector<Interval> kept;
  for (const Interval& next : all) {
    std::vector<Interval> rest{next};
    for (const Interval& k : kept) {
      std::vector<Interval> cut;
      for (const Interval& r : rest) {
        if (r.end <= k.start || k.end <= r.start) {
          cut.push_back(r);
          continue;
        }
        Interval left = r, right = r;
        left.end = k.start;
        right.start = k.end;
        if (left.end > left.start) cut.push_back(left);
        if (right.end > right.start) cut.push_back(right);
      }
      rest = std::move(cut);
    }
    kept.insert(kept.end(), rest.begin(), rest.end());
  }
  std::sort(kept.begin(), kept.end(), [](const Interval& p, const Interval& q) { return p.start < q.start; });
  return kept;
}

/// Where a linear function that is `u` at `s` and `v` at `t` lies within [-limit, limit]; empty when s >= t.
void clip(double& s, double& t, double u, double v, double limit) {
  const double s0 = s, t0 = t;
  for (const double sign : {1.0, -1.0}) {
    const double p = sign * u - limit, q = sign * v - limit;  // outside where positive
    if (p > 0 && q > 0) {
      t = s;
      return;
    }
    if (p > 0) s = std::max(s, s0 + (t0 - s0) * (p / (p - q)));
    if (q > 0) t = std::min(t, s0 + (t0 - s0) * (p / (p - q)));
  }
}

struct PortalPoint {
  Point2 place, direction;  ///< direction: unit vector of the way there
  double width = 0;
  std::uint32_t passage = 0;
};

bool in_building(const model::Building& building, Point2 p) {
  return std::any_of(building.outline.begin(), building.outline.end(),
                     [&](const model::Polygon& polygon) { return geometry::contains(polygon, p); });
}

/// Where a way crosses an edge or has a node on it.
void add_portal_points(const model::Building& building, const OutlineEdge& edge, const PassageWay& way,
                       std::uint32_t index, std::vector<PortalPoint>& out) {
  for (std::size_t i = 1; i < way.points.size(); ++i) {
    const Point2 p = way.points[i - 1], q = way.points[i], d = q - p;
    const double length = std::sqrt(dot(d, d));
    if (length == 0) continue;
    const Point2 unit{d.x / length, d.y / length};
    const double sine = cross(edge.along, unit);
    if (std::fabs(sine) < kMinPortalSine) continue;
    // Along the way to the edge's line, and along the edge to there.
    const double to_line = cross(edge.a - p, edge.along) / -sine;
    const Point2 m{p.x + unit.x * to_line, p.y + unit.y * to_line};
    const double along = dot(m - edge.a, edge.along);
    if (to_line < -kOnOutline || to_line > length + kOnOutline || along < -kOnOutline ||
        along > edge.length + kOnOutline)
      continue;
    if (way.covered_only) {
      // Roofs over a path along a wall, or up to a door, open nothing: the way must go on inside.
      const double before = std::max(0.0, to_line - kInside), after = std::min(length, to_line + kInside);
      const Point2 b{p.x + unit.x * before, p.y + unit.y * before}, a{p.x + unit.x * after, p.y + unit.y * after};
      if (!in_building(building, b) && !in_building(building, a)) continue;
    }
    out.push_back({m, unit, way.width, index});
  }
}

}  // namespace

std::vector<OutlineEdge> edges_of(const std::vector<model::Polygon>& outline) {
  std::vector<OutlineEdge> out;
  for (std::uint32_t p = 0; p < outline.size(); ++p) {
    const auto add = [&](const model::Ring& ring, std::uint32_t number) {
      for (std::uint32_t i = 0; i < ring.size(); ++i) {
        const std::size_t next = (i + 1) % ring.size();
        OutlineEdge e{.polygon = p, .ring = number, .edge = i, .a = ring.points[i], .b = ring.points[next]};
        if (next < ring.nodes.size() && i < ring.nodes.size()) {
          e.from_node = ring.nodes[i];
          e.to_node = ring.nodes[next];
        }
        const Point2 d = e.b - e.a;
        e.length = std::sqrt(dot(d, d));
        if (e.length > 0) e.along = {d.x / e.length, d.y / e.length};
        e.outward = {e.along.y, -e.along.x};
        out.push_back(e);
      }
    };
    add(outline[p].outer, 0);
    for (std::uint32_t h = 0; h < outline[p].holes.size(); ++h) add(outline[p].holes[h], h + 1);
  }
  return out;
}

std::vector<Contact> contacts_of(const OutlineEdge& edge, model::OsmId own, bool canopy, const VicinityIndex& index,
                                 const WallSegmentOptions& options) {
  const Scene& scene = index.scene();
  const double reach = options.touching;
  std::vector<std::uint32_t> near;
  scene.walls_near({std::min(edge.a.x, edge.b.x) - reach, std::min(edge.a.y, edge.b.y) - reach},
                   {std::max(edge.a.x, edge.b.x) + reach, std::max(edge.a.y, edge.b.y) + reach}, near);
  std::vector<Contact> pieces;
  for (const std::uint32_t w : near) {
    const Wall& wall = scene.walls()[w];
    const model::OsmId id = index.all().footprints[wall.footprint].id;
    if (id == own || (!canopy && scene.is_canopy(wall.footprint))) continue;
    const Point2 p = wall.b - edge.a, q = wall.a - edge.a;  // a neighbour's wall runs the other way
    double s = dot(p, edge.along), t = dot(q, edge.along);
    if (t <= s) continue;
    double u = dot(p, edge.outward), v = dot(q, edge.outward);
    const double s0 = s, slope = (v - u) / (t - s);
    s = std::max(s, 0.0);
    t = std::min(t, edge.length);
    if (t <= s) continue;
    v = u + (t - s0) * slope;
    u = u + (s - s0) * slope;
    clip(s, t, u, v, reach);
    if (t > s) pieces.push_back({s, t, id});
  }
  // Walls of one neighbour that follow each other are one contact.
  std::sort(pieces.begin(), pieces.end(), [](const Contact& p, const Contact& q) {
    return std::tuple(p.neighbour, p.start, p.end) < std::tuple(q.neighbour, q.start, q.end);
  });
  std::vector<Contact> joined;
  for (const Contact& p : pieces) {
    if (!joined.empty() && joined.back().neighbour == p.neighbour &&
        p.start <= joined.back().end + options.min_wall_segment)
      joined.back().end = std::max(joined.back().end, p.end);
    else
      joined.push_back(p);
  }
  std::erase_if(joined,
                [&](const Contact& c) { return c.end - c.start < std::min(options.min_contact, edge.length / 2); });
  return without_overlaps(std::move(joined), [](const Contact& c) { return c.neighbour; });
}

namespace {

/// m. Arcades are no deeper than this from the way in their middle to their front.
constexpr double kArcadeHalfDepth = 4;
/// m. Shorter walls along a way are no front with an arcade.
constexpr double kMinArcade = 5;

/// Whether an arcade runs along wall `front`: parallel to the way (no portal could open in it), and no neighbour's.
bool has_arcade(const OutlineEdge& front, const PortalPoint& m, const model::Building& building,
                const VicinityIndex& index, const WallSegmentOptions& options) {
  if (front.length < kMinArcade || std::fabs(cross(front.along, m.direction)) >= kMinPortalSine) return false;
  double covered = 0;
  for (const Contact& c : contacts_of(front, building.osm, false, index, options)) covered += c.end - c.start;
  return 2 * covered < front.length;
}

}  // namespace

std::vector<std::vector<Portal>> portals_of(const model::Building& building, const std::vector<OutlineEdge>& edges,
                                            const VicinityIndex& index, const WallSegmentOptions& options) {
  std::vector<std::vector<Portal>> out(edges.size());
  std::vector<PortalPoint> points;
  for (const std::uint32_t w : index.passages_near(box_of(building, kOnOutline)))
    for (const OutlineEdge& edge : edges)
      if (edge.length > 0) add_portal_points(building, edge, index.all().passages[w], w, points);
  if (points.empty()) return out;
  const auto same_ring = [&](std::size_t a, std::size_t b) {
    return edges[a].polygon == edges[b].polygon && edges[a].ring == edges[b].ring;
  };
  const auto after = [&](std::size_t e) {
    return e + 1 < edges.size() && same_ring(e, e + 1) ? e + 1 : e - edges[e].edge;
  };
  const auto before = [&](std::size_t e) {
    if (edges[e].edge > 0) return e - 1;
    while (e + 1 < edges.size() && same_ring(e, e + 1)) ++e;
    return e;
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const OutlineEdge& edge = edges[e];
    if (edge.length == 0) continue;
    for (const PortalPoint& m : points) {
      const Point2 to = m.place - edge.a;
      const double sine = std::fabs(cross(edge.along, m.direction));
      if (sine < kMinPortalSine || std::fabs(dot(to, edge.outward)) > kOnOutline) continue;
      const double half = m.width / 2 / sine, middle = dot(to, edge.along);
      double start = std::max(0.0, middle - half), end = std::min(edge.length, middle + half);
      if (end <= start) continue;
      // An arcade is open to the front along which it runs: its portal reaches to the corner.
      if (start > 0 && middle < kArcadeHalfDepth && has_arcade(edges[before(e)], m, building, index, options))
        start = 0;
      if (end < edge.length && edge.length - middle < kArcadeHalfDepth &&
          has_arcade(edges[after(e)], m, building, index, options))
        end = edge.length;
      out[e].push_back({start, end, m.passage});
    }
    out[e] = without_overlaps(std::move(out[e]), [&](const Portal& m) { return index.all().passages[m.passage].id; });
  }
  return out;
}

}  // namespace blockrand::context
