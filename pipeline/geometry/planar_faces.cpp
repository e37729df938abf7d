#include "pipeline/geometry/planar_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include "pipeline/geometry/geos_scope.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/noded_lines.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::geometry {

namespace {

using model::Point2;
using model::Polygon;
using model::Ring;

/// The arrangement of noded edges as a planar map, and the rings of its faces.
class PlanarMap {
 public:
  explicit PlanarMap(const std::vector<NodedEdge>& edges) {
    for (const NodedEdge& e : edges) {
      points_.push_back(e.a);
      points_.push_back(e.b);
    }
    std::sort(points_.begin(), points_.end());
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    const auto node = [&](Point2 p) {
      return static_cast<std::uint32_t>(std::lower_bound(points_.begin(), points_.end(), p) - points_.begin());
    };
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (i > 0 && edges[i].a == edges[i - 1].a && edges[i].b == edges[i - 1].b) continue;
      // Half-edge 2 k runs from a to b, its twin 2 k + 1 back.
      from_.push_back(node(edges[i].a));
      from_.push_back(node(edges[i].b));
    }
    alive_.assign(from_.size(), 1);
    grid_.reserve(points_.size());
    for (const Point2 p : points_) grid_.push_back(to_grid(p));
  }

  /// Drops what ends blindly or only connects, and returns the faces' polygons in no particular order.
  std::vector<Polygon> faces() {
    sort_around_nodes();
    drop_dead_ends();
    trace();
    bool bridges = false;
    for (std::uint32_t h = 0; h < from_.size(); h += 2)
      if (alive_[h] && cycle_[h] == cycle_[h + 1]) {
        alive_[h] = alive_[h + 1] = 0;
        bridges = true;
      }
    if (bridges) trace();
    return polygons();
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t to(std::uint32_t h) const { return from_[h ^ 1]; }

  /// Half-edges that leave each node, counter-clockwise.
  void sort_around_nodes() {
    first_.assign(points_.size() + 1, 0);
    for (const std::uint32_t n : from_) ++first_[n + 1];
    for (std::size_t n = 0; n < points_.size(); ++n) first_[n + 1] += first_[n];
    around_.resize(from_.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t h = 0; h < from_.size(); ++h) around_[next[from_[h]]++] = h;
    for (std::size_t n = 0; n < points_.size(); ++n)
      std::sort(around_.begin() + first_[n], around_.begin() + first_[n + 1], [&](std::uint32_t g, std::uint32_t h) {
        const Grid2 u = grid_[to(g)] - grid_[n], v = grid_[to(h)] - grid_[n];
        const bool upper_u = u.y > 0 || (u.y == 0 && u.x > 0), upper_v = v.y > 0 || (v.y == 0 && v.x > 0);
        if (upper_u != upper_v) return upper_u;
        return static_cast<Int128>(u.x) * v.y - static_cast<Int128>(u.y) * v.x > 0;
      });
  }

  void drop_dead_ends() {
    std::vector<std::uint32_t> degree(points_.size(), 0), ends;
    for (const std::uint32_t n : from_) ++degree[n];
    for (std::uint32_t n = 0; n < points_.size(); ++n)
      if (degree[n] == 1) ends.push_back(n);
    while (!ends.empty()) {
      const std::uint32_t n = ends.back();
      ends.pop_back();
      for (std::uint32_t i = first_[n]; i < first_[n + 1]; ++i) {
        const std::uint32_t h = around_[i];
        if (!alive_[h]) continue;
        alive_[h] = alive_[h ^ 1] = 0;
        --degree[n];
        if (--degree[to(h)] == 1) ends.push_back(to(h));
      }
    }
  }

  /// Cycles of half-edges with one face on their left.
  void trace() {
    next_.assign(from_.size(), kNone);
    for (std::size_t n = 0; n < points_.size(); ++n) {
      // After arriving by the twin of a half-edge one leaves by the next one clockwise.
      std::uint32_t before = kNone, first = kNone;
      for (std::uint32_t i = first_[n]; i < first_[n + 1]; ++i) {
        const std::uint32_t h = around_[i];
        if (!alive_[h]) continue;
        if (before == kNone)
          first = h;
        else
          next_[h ^ 1] = before;
        before = h;
      }
      if (first != kNone) next_[first ^ 1] = before;
    }
    cycle_.assign(from_.size(), kNone);
    cycles_.clear();
    for (std::uint32_t h = 0; h < from_.size(); ++h) {
      if (!alive_[h] || cycle_[h] != kNone) continue;
      for (std::uint32_t g = h; cycle_[g] == kNone; g = next_[g])
        cycle_[g] = static_cast<std::uint32_t>(cycles_.size());
      cycles_.push_back(h);
    }
  }

  /// Which nodes hang together.
  std::vector<std::uint32_t> components() const {
    std::vector<std::uint32_t> parent(points_.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t n) {
      while (parent[n] != n) n = parent[n] = parent[parent[n]];
      return n;
    };
    for (std::uint32_t h = 0; h < from_.size(); h += 2) {
      if (!alive_[h]) continue;
      const std::uint32_t a = root(from_[h]), b = root(to(h));
      if (a != b) parent[std::max(a, b)] = std::min(a, b);
    }
    for (std::uint32_t n = 0; n < parent.size(); ++n) parent[n] = root(n);
    return parent;
  }

  std::vector<Polygon> polygons() const {
    const std::vector<std::uint32_t> component = components();
    struct Shell {
      Polygon polygon;
      std::uint32_t component = 0;
      double area = 0;
      Point2 low, high;
    };
    struct Hole {
      Ring ring;
      std::uint32_t component = 0;
    };
    std::vector<Shell> shells;
    std::vector<Hole> holes;
    std::vector<std::uint32_t> place(points_.size(), kNone);  // of a node on the path
    std::vector<std::uint32_t> path;
    for (const std::uint32_t start : cycles_) {
      // A cycle that touches itself in a node falls into rings there: at most one runs counter-clockwise, the shell.
      std::vector<Ring> rings;
      const auto cut_off = [&](std::size_t from) {
        Ring ring;
        for (std::size_t i = from; i < path.size(); ++i) {
          ring.points.push_back(points_[path[i]]);
          place[path[i]] = kNone;
        }
        path.resize(from);
        rings.push_back(std::move(ring));
      };
      std::uint32_t h = start;
      do {
        const std::uint32_t n = from_[h];
        if (place[n] != kNone) cut_off(place[n]);
        place[n] = static_cast<std::uint32_t>(path.size());
        path.push_back(n);
        h = next_[h];
      } while (h != start);
      cut_off(0);
      std::optional<std::size_t> shell;
      for (std::size_t r = 0; r < rings.size(); ++r)
        if (signed_area(rings[r].points) > 0) shell = r;
      if (!shell) {
        for (Ring& ring : rings) holes.push_back({std::move(ring), component[from_[start]]});
        continue;
      }
      Shell out;
      out.component = component[from_[start]];
      out.area = signed_area(rings[*shell].points);
      out.polygon.outer = std::move(rings[*shell]);
      for (std::size_t r = 0; r < rings.size(); ++r)
        if (r != *shell) out.polygon.holes.push_back(std::move(rings[r]));
      out.low = out.high = out.polygon.outer.points[0];
      for (const Point2 p : out.polygon.outer.points) {
        out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y)};
        out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y)};
      }
      shells.push_back(std::move(out));
    }
    // What hangs together by itself lies in the smallest face around it, or in none.
    for (Hole& hole : holes) {
      Shell* around = nullptr;
      const Point2 p = hole.ring.points[0];
      for (Shell& shell : shells) {
        if (shell.component == hole.component || (around != nullptr && shell.area >= around->area)) continue;
        if (p.x < shell.low.x || p.x > shell.high.x || p.y < shell.low.y || p.y > shell.high.y) continue;
        if (contains(shell.polygon.outer.points, p)) around = &shell;
      }
      if (around != nullptr) around->polygon.holes.push_back(std::move(hole.ring));
    }
    std::vector<Polygon> out;
    for (Shell& shell : shells) out.push_back(std::move(shell.polygon));
    return out;
  }

  std::vector<Point2> points_;  ///< sorted
  std::vector<Grid2> grid_;
  std::vector<std::uint32_t> from_, first_, around_, next_, cycle_, cycles_;
  std::vector<char> alive_;
};

void make_canonical(Ring& ring, bool counter_clockwise) {
  if ((signed_area(ring.points) > 0) != counter_clockwise) std::reverse(ring.points.begin(), ring.points.end());
  std::rotate(ring.points.begin(), std::min_element(ring.points.begin(), ring.points.end()), ring.points.end());
}

/// Faces in an order and with beginnings that depend on nothing but themselves.
std::vector<Polygon> in_order(std::vector<Polygon> faces) {
  for (Polygon& polygon : faces) {
    make_canonical(polygon.outer, true);
    for (Ring& hole : polygon.holes) make_canonical(hole, false);
    std::sort(polygon.holes.begin(), polygon.holes.end(),
              [](const Ring& a, const Ring& b) { return a.points < b.points; });
  }
  std::sort(faces.begin(), faces.end(),
            [](const Polygon& a, const Polygon& b) { return a.outer.points < b.outer.points; });
  return faces;
}

/// Tells the faces what lies under their edges.
class Attribution {
 public:
  Attribution(const std::vector<NodedEdge>& edges, std::span<const DividingLine> lines) : edges_(edges) {
    for (const DividingLine& line : lines)
      for (std::size_t i = 0; i < line.nodes.size() && i < line.points.size(); ++i)
        if (line.nodes[i] != 0) nodes_.emplace_back(model::snap(line.points[i]), line.nodes[i]);
    std::sort(nodes_.begin(), nodes_.end());
  }

  void attribute(Face& face) {
    borders_.clear();
    follow(face.polygon.outer, face);
    for (Ring& hole : face.polygon.holes) follow(hole, face);
    // A stable sort keeps the order along the rings, in which lengths are summed.
    std::stable_sort(borders_.begin(), borders_.end(),
                     [](const BorderLine& a, const BorderLine& b) { return a.id < b.id; });
    for (const BorderLine& border : borders_) {
      if (face.lines.empty() || face.lines.back().id != border.id) {
        face.lines.push_back(border);
        continue;
      }
      face.lines.back().left += border.left;
      face.lines.back().right += border.right;
    }
  }

 private:
  void follow(Ring& ring, Face& face) {
    ring.nodes.assign(ring.size(), 0);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 p = ring.points[i], q = ring.points[(i + 1) % ring.size()];
      // Of several nodes at one place the least.
      const auto node =
          std::lower_bound(nodes_.begin(), nodes_.end(), std::pair(p, std::numeric_limits<std::int64_t>::min()));
      if (node != nodes_.end() && node->first == p) ring.nodes[i] = node->second;
      const double length = distance(q, p);
      // The interior lies on the left of every ring edge: the same direction as the line's means left of the line.
      const bool forward = p < q;
      const Point2 a = std::min(p, q), b = std::max(p, q);
      FaceEdge edge;
      for (auto under = std::lower_bound(edges_.begin(), edges_.end(), NodedEdge{a, b, 0, false});
           under != edges_.end() && under->a == a && under->b == b; ++under) {
        const bool left = under->forward == forward;
        if (edge.line == kNoLine) edge = {under->line, left};  // edges are sorted: the first has the least id
        borders_.push_back({under->line, left ? length : 0, left ? 0 : length});
      }
      face.edges.push_back(edge);
    }
  }

  const std::vector<NodedEdge>& edges_;
  std::vector<std::pair<Point2, std::int64_t>> nodes_;  ///< sorted
  std::vector<BorderLine> borders_;
};

}  // namespace

std::vector<Face> faces_of_lines(std::span<const DividingLine> lines) {
  const std::vector<NodedEdge> edges = noded_edges(lines);
  std::vector<Face> faces;
  if (edges.empty()) return faces;
  Attribution attribution(edges, lines);
  for (Polygon& polygon : in_order(PlanarMap(edges).faces())) {
    Face face;
    face.polygon = std::move(polygon);
    attribution.attribute(face);
    faces.push_back(std::move(face));
  }
  return faces;
}

Point2 inner_point(const Polygon& polygon) {
  const Point2 origin = polygon.outer.points[0];
  const geos::Geometry g = geos::polygon_of(polygon, origin);
  if (!g) throw std::runtime_error("GEOS failed to make a polygon");
  const geos::Geometry point(GEOSPointOnSurface_r(geos::context(), g.get()));
  Point2 p = origin;
  double x = 0, y = 0;
  if (point && GEOSGeomGetX_r(geos::context(), point.get(), &x) == 1 &&
      GEOSGeomGetY_r(geos::context(), point.get(), &y) == 1)
    p = model::snap(Point2{origin.x + x, origin.y + y});
  return p;
}

}  // namespace blockrand::geometry
