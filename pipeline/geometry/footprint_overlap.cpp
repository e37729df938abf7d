#include "pipeline/geometry/footprint_overlap.h"

#include <algorithm>
#include <limits>

#include "pipeline/geometry/grid.h"

namespace blockrand::geometry {

namespace {

using model::Polygon;
using model::Ring;

struct Box {
  std::int64_t x0 = std::numeric_limits<std::int64_t>::max(), y0 = x0, x1 = -x0, y1 = -x0;
  void add(Grid2 p) {
    x0 = std::min(x0, p.x);
    y0 = std::min(y0, p.y);
    x1 = std::max(x1, p.x);
    y1 = std::max(y1, p.y);
  }
  bool meets(const Box& o) const { return x0 <= o.x1 && o.x0 <= x1 && y0 <= o.y1 && o.y0 <= y1; }
};

struct Edge {
  Grid2 a, b;
  Box box;
  EdgeOf of;
};

/// Edges with doubled coordinates, so that middles of edges are on the grid.
std::vector<Edge> edges_of(const Polygon& polygon, Grid2 origin) {
  std::vector<Edge> out;
  std::uint32_t number = 0;
  const auto add = [&](const Ring& ring) {
    const auto n = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      const Grid2 a = to_grid(ring.points[i]) - origin, b = to_grid(ring.points[(i + 1) % n]) - origin;
      Edge e{{2 * a.x, 2 * a.y}, {2 * b.x, 2 * b.y}, {}, {number, i}};
      e.box.add(e.a);
      e.box.add(e.b);
      out.push_back(e);
    }
    ++number;
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  return out;
}

Box box_of(const Polygon& polygon, Grid2 origin) {
  Box box;
  for (const model::Point2 p : polygon.outer.points) {
    const Grid2 g = to_grid(p) - origin;
    box.add({2 * g.x, 2 * g.y});
  }
  return box;
}

bool strictly_inside(const std::vector<Edge>& edges, Grid2 p) {
  bool inside = false;
  for (const Edge& e : edges) {
    if (p.y < e.box.y0 || p.y > e.box.y1 || p.x > e.box.x1) continue;
    if (on_segment(e.a, e.b, p)) return false;
    if ((e.a.y > p.y) == (e.b.y > p.y)) continue;
    // The edge passes p's height to the right of p when p lies on its left going up, on its right going down.
    if (orientation(e.a, e.b, p) == (e.b.y > e.a.y ? 1 : -1)) inside = !inside;
  }
  return inside;
}

std::int64_t dot(Grid2 u, Grid2 v) { return u.x * v.x + u.y * v.y; }

/// Does a piece of an edge of `a`, cut where `b` touches it, run through the inside of `b`? No edges may cross properly.
bool runs_inside(const std::vector<Edge>& a, const std::vector<Edge>& b, const Box& common) {
  std::vector<Grid2> cuts;
  for (const Edge& e : a) {
    if (!e.box.meets(common)) continue;
    cuts = {e.a, e.b};
    for (const Edge& f : b)
      if (f.box.meets(e.box) && f.a != e.a && f.a != e.b && on_segment(e.a, e.b, f.a)) cuts.push_back(f.a);
    if (cuts.size() > 2)
      std::sort(cuts.begin(), cuts.end(),
                [&](Grid2 p, Grid2 q) { return dot(p - e.a, e.b - e.a) < dot(q - e.a, e.b - e.a); });
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
      if (strictly_inside(b, {(cuts[i].x + cuts[i + 1].x) / 2, (cuts[i].y + cuts[i + 1].y) / 2})) return true;
  }
  return false;
}

}  // namespace

bool interiors_meet(const Polygon& a, const Polygon& b) {
  const Grid2 origin = to_grid(a.outer.points[0]);
  const Box box_a = box_of(a, origin), box_b = box_of(b, origin);
  const Box common{std::max(box_a.x0, box_b.x0), std::max(box_a.y0, box_b.y0), std::min(box_a.x1, box_b.x1),
                   std::min(box_a.y1, box_b.y1)};
  if (common.x0 >= common.x1 || common.y0 >= common.y1) return false;
  const std::vector<Edge> edges_a = edges_of(a, origin), edges_b = edges_of(b, origin);
  for (const Edge& e : edges_a) {
    if (!e.box.meets(common)) continue;
    for (const Edge& f : edges_b) {
      if (!e.box.meets(f.box)) continue;
      const int o1 = orientation(e.a, e.b, f.a), o2 = orientation(e.a, e.b, f.b);
      if (o1 * o2 > 0) continue;
      if (o1 == 0 && o2 == 0) {
        // On one line: the same direction means insides on the same side, where they have a stretch in common.
        const Grid2 d = e.b - e.a;
        if (dot(d, f.b - f.a) > 0 && dot(d, f.b - e.a) > 0 && dot(d, f.a - e.b) < 0) return true;
        continue;
      }
      const int o3 = orientation(f.a, f.b, e.a), o4 = orientation(f.a, f.b, e.b);
      if (o1 * o2 < 0 && o3 * o4 < 0) return true;
    }
  }
  return runs_inside(edges_a, edges_b, common) || runs_inside(edges_b, edges_a, common);
}

std::vector<std::pair<EdgeOf, EdgeOf>> conflicting_edges(const Polygon& polygon, std::size_t most) {
  std::vector<std::pair<EdgeOf, EdgeOf>> out;
  if (polygon.outer.size() == 0) return out;
  std::vector<Edge> edges = edges_of(polygon, to_grid(polygon.outer.points[0]));
  const auto size_of = [&](std::uint32_t ring) {
    return static_cast<std::uint32_t>(ring == 0 ? polygon.outer.size() : polygon.holes[ring - 1].size());
  };
  std::sort(edges.begin(), edges.end(),
            [](const Edge& e, const Edge& f) { return e.box.x0 != f.box.x0 ? e.box.x0 < f.box.x0 : e.of < f.of; });
  const auto conflict = [&](const Edge& e, const Edge& f) {
    const bool e_first = e.of.ring == f.of.ring && (e.of.index + 1) % size_of(e.of.ring) == f.of.index;
    const bool f_first = e.of.ring == f.of.ring && (f.of.index + 1) % size_of(f.of.ring) == e.of.index;
    if (e_first || f_first) {
      const Edge &first = e_first ? e : f, &second = e_first ? f : e;
      if (orientation(first.a, first.b, second.b) != 0) return false;
      return on_segment(first.a, first.b, second.b) || on_segment(second.a, second.b, first.a);
    }
    const int o1 = orientation(e.a, e.b, f.a), o2 = orientation(e.a, e.b, f.b);
    const int o3 = orientation(f.a, f.b, e.a), o4 = orientation(f.a, f.b, e.b);
    if (o1 * o2 < 0 && o3 * o4 < 0) return true;
    return on_segment(e.a, e.b, f.a) || on_segment(e.a, e.b, f.b) || on_segment(f.a, f.b, e.a) ||
           on_segment(f.a, f.b, e.b);
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].a == edges[i].b) out.emplace_back(edges[i].of, edges[i].of);
    for (std::size_t j = i + 1; j < edges.size() && edges[j].box.x0 <= edges[i].box.x1; ++j) {
      if (out.size() >= most) return out;
      if (edges[i].box.meets(edges[j].box) && conflict(edges[i], edges[j]))
        out.emplace_back(std::min(edges[i].of, edges[j].of), std::max(edges[i].of, edges[j].of));
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace blockrand::geometry
