// Roofs from the lines that mappers draw: ridges, hips and valleys, apexes. docs/roofs.md, "Lines".
//
// Points of the plan and of the lines become one set of nodes, with a height for each. The lines and walls are the
// edges of a constrained triangulation; triangles that no line parts and that lie in one plane become one face.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/vector.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

using geometry::Triangle;
using model::Point2;
using model::Point3;
using model::Polygon;
using model::RoofLine;
using model::RoofLineKind;

namespace {

/// m. Nearer points are one, nearer points of a line or wall lie on it: twice what straightening a wall may move it.
constexpr double kSame = 0.02;
/// m. Triangles nearer to a plane lie in it: half of what the solid's checker allows.
constexpr double kPlane = 0.005;
/// Points whose heights are solved for: a roof has a dozen, a slip of the pen thousands.
constexpr std::size_t kMostUnknown = 200;

/// Where p lies along ab, 0 at a, 1 at b.
double share_of(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy);
}

using Pair = std::array<std::uint32_t, 2>;
Pair undirected(std::uint32_t a, std::uint32_t b) { return a < b ? Pair{a, b} : Pair{b, a}; }

class LinedRoof {
 public:
  LinedRoof(const Polygon& plan, RoofMeasures measures) : plan_(plan), measures_(measures) {}

  std::optional<Roof> build(std::span<const RoofLine> lines) {
    place_corners();
    std::vector<std::vector<std::uint32_t>> chains;
    for (const RoofLine& line : lines) {
      chains.emplace_back();
      for (const Point2 p : line.points) {
        const auto node = place(p);
        if (!node) return std::nullopt;
        if (chains.back().empty() || chains.back().back() != *node) chains.back().push_back(*node);
      }
    }
    link_walls();
    bool ridged = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      ridged = ridged || (lines[i].kind == RoofLineKind::ridge && chains[i].size() >= 2);
      if (!draw(lines[i].kind, chains[i])) return std::nullopt;
    }
    if (!ridged || !find_heights()) return std::nullopt;
    std::vector<geometry::Grid2> flat;
    for (const Node& n : nodes_) flat.push_back(geometry::to_grid(n.point));
    std::vector<Pair> segments(segments_.begin(), segments_.end());
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) segments.push_back({i, i});
    auto triangles = geometry::triangulate_with_lines(flat, loops_, segments);
    if (!triangles) return std::nullopt;
    Roof roof;
    add_faces(std::move(*triangles), roof);
    add_walls(roof);
    return roof;
  }

 private:
  struct Node {
    Point2 point;
    bool wall = false;
    bool known = false;
    double z = 0;  ///< m above the eaves
  };
  struct Edge {
    std::uint32_t from, to;
    std::vector<std::uint32_t> between;  ///< nodes of lines on it, in order once linked
  };

  void place_corners() {
    const auto add = [&](const model::Ring& ring) {
      const auto first = static_cast<std::uint32_t>(nodes_.size()), n = static_cast<std::uint32_t>(ring.size());
      for (std::uint32_t i = 0; i < n; ++i) {
        nodes_.push_back({ring.points[i], true, false, 0});
        edges_.push_back({first + i, first + (i + 1) % n, {}});
      }
      ring_starts_.push_back(first);
    };
    add(plan_.outer);
    for (const model::Ring& hole : plan_.holes) add(hole);
  }

  /// The node of a line's point; empty outside the plan.
  std::optional<std::uint32_t> place(Point2 p) {
    std::uint32_t nearest = 0;
    for (std::uint32_t i = 1; i < nodes_.size(); ++i)
      if (distance(nodes_[i].point, p) < distance(nodes_[nearest].point, p)) nearest = i;
    if (distance(nodes_[nearest].point, p) <= kSame) return nearest;
    const auto added = static_cast<std::uint32_t>(nodes_.size());
    for (Edge& edge : edges_) {
      const Point2 a = nodes_[edge.from].point, b = nodes_[edge.to].point;
      if (geometry::distance_to_segment(p, a, b) > kSame) continue;
      const double t = share_of(p, a, b);
      nodes_.push_back({model::snap(Point2{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}), true, false, 0});
      edge.between.push_back(added);
      return added;
    }
    if (!geometry::contains(plan_, p)) return std::nullopt;
    nodes_.push_back({p, false, false, 0});
    return added;
  }

  void link_walls() {
    for (Edge& edge : edges_) {
      const Point2 a = nodes_[edge.from].point, b = nodes_[edge.to].point;
      std::sort(edge.between.begin(), edge.between.end(), [&](std::uint32_t l, std::uint32_t r) {
        return share_of(nodes_[l].point, a, b) < share_of(nodes_[r].point, a, b);
      });
    }
    for (std::size_t r = 0; r < ring_starts_.size(); ++r) {
      const std::size_t end = r + 1 < ring_starts_.size() ? ring_starts_[r + 1] : edges_.size();
      loops_.emplace_back();
      for (std::size_t e = ring_starts_[r]; e < end; ++e) {
        loops_.back().push_back(edges_[e].from);
        loops_.back().insert(loops_.back().end(), edges_[e].between.begin(), edges_[e].between.end());
      }
      const auto& loop = loops_.back();
      for (std::size_t k = 0; k < loop.size(); ++k) walls_.insert(undirected(loop[k], loop[(k + 1) % loop.size()]));
    }
  }

  /// Segments of a line, cut at nodes that lie on them. False when one leaves the plan.
  bool draw(RoofLineKind kind, const std::vector<std::uint32_t>& chain) {
    const auto raise = [&](std::uint32_t node) {
      if (kind == RoofLineKind::edge) return;
      nodes_[node].known = true;
      nodes_[node].z = measures_.height;
    };
    for (const std::uint32_t node : chain) raise(node);
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
      const Point2 a = nodes_[chain[k]].point, b = nodes_[chain[k + 1]].point;
      std::vector<std::pair<double, std::uint32_t>> on;
      for (std::uint32_t i = 0; i < nodes_.size(); ++i)
        if (i != chain[k] && i != chain[k + 1] && geometry::distance_to_segment(nodes_[i].point, a, b) <= kSame)
          on.emplace_back(share_of(nodes_[i].point, a, b), i);
      std::sort(on.begin(), on.end());
      on.emplace_back(1, chain[k + 1]);
      std::uint32_t from = chain[k];
      for (const auto& [share, to] : on) {
        raise(to);
        const Point2 p = nodes_[from].point, q = nodes_[to].point;
        if (!walls_.contains(undirected(from, to))) {
          if (nodes_[from].wall && nodes_[to].wall && !geometry::contains(plan_, {(p.x + q.x) / 2, (p.y + q.y) / 2}))
            return false;
          segments_.insert(undirected(from, to));
        }
        from = to;
      }
    }
    return true;
  }

  /// Ridges and apexes are at the roof's height, walls elsewhere at the eaves; what edges join between them lies at the
  /// mean of its neighbours along the edges, the near ones weighing more. False when some hang in the air.
  bool find_heights() {
    std::vector<std::int32_t> row(nodes_.size(), -1);
    std::vector<std::uint32_t> unknown;
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].known) continue;
      if (nodes_[i].wall) {
        nodes_[i].known = true;
        continue;
      }
      row[i] = static_cast<std::int32_t>(unknown.size());
      unknown.push_back(i);
    }
    const std::size_t n = unknown.size();
    if (n > kMostUnknown) return false;
    std::vector<std::vector<double>> m(n, std::vector<double>(n + 1, 0.0));
    for (const auto& [a, b] : segments_) {
      const double weight = 1 / distance(nodes_[a].point, nodes_[b].point);
      for (const auto& [i, other] : {std::pair(a, b), std::pair(b, a)}) {
        if (row[i] < 0) continue;
        auto& equation = m[static_cast<std::size_t>(row[i])];
        equation[static_cast<std::size_t>(row[i])] += weight;
        if (row[other] >= 0)
          equation[static_cast<std::size_t>(row[other])] -= weight;
        else
          equation[n] += weight * nodes_[other].z;
      }
    }
    // A weighted Laplacian with some fixed nodes: elimination needs no pivoting, and a pivot vanishes where a group of
    // nodes is joined to nothing known.
    for (std::size_t k = 0; k < n; ++k) {
      constexpr double kNothing = 1e-9;  // 1/m; the longest line weighs 1e-4
      if (m[k][k] < kNothing) return false;
      for (std::size_t i = k + 1; i < n; ++i) {
        const double factor = m[i][k] / m[k][k];
        if (factor == 0) continue;
        for (std::size_t j = k; j <= n; ++j) m[i][j] -= factor * m[k][j];
      }
    }
    for (std::size_t k = n; k-- > 0;) {
      double sum = m[k][n];
      for (std::size_t j = k + 1; j < n; ++j) sum -= m[k][j] * nodes_[unknown[j]].z;
      nodes_[unknown[k]].z = sum / m[k][k];
    }
    for (Node& node : nodes_) node.z = model::snap(measures_.eaves + node.z) - measures_.eaves;
    return true;
  }

  Point3 raised(std::uint32_t node) const {
    return {nodes_[node].point.x, nodes_[node].point.y, measures_.eaves + nodes_[node].z};
  }

  /// Triangles in one plane with no line between them, as faces.
  void add_faces(std::vector<Triangle> triangles, Roof& roof) const {
    for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    raise_flat(triangles);
    const auto twice_area = [&](const Triangle& t) {
      const Point2 a = nodes_[t[0]].point, b = nodes_[t[1]].point, c = nodes_[t[2]].point;
      return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    std::map<Pair, std::uint32_t> beside;  // directed edge: the triangle on its left
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) beside[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    std::vector<std::uint32_t> order(triangles.size());
    for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return twice_area(triangles[a]) > twice_area(triangles[b]);
    });
    std::vector<bool> taken(triangles.size(), false);
    for (const std::uint32_t seed : order) {
      if (taken[seed]) continue;
      std::vector<std::uint32_t> group{seed};
      taken[seed] = true;
      for (std::size_t g = 0; g < group.size(); ++g)
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t a = triangles[group[g]][k], b = triangles[group[g]][(k + 1) % 3];
          const auto other = beside.find({b, a});
          if (other == beside.end() || taken[other->second] || segments_.contains(undirected(a, b))) continue;
          if (!in_plane(triangles[seed], triangles[other->second])) continue;
          taken[other->second] = true;
          group.push_back(other->second);
        }
      std::vector<Triangle> members;
      for (const std::uint32_t g : group) members.push_back(triangles[g]);
      if (auto loops = border(members)) {
        add_face(*loops, roof);
      } else {
        for (const Triangle& t : members) add_face({{t[0], t[1], t[2]}}, roof);
      }
    }
  }

  /// A triangle at eaves height that no line bounds against a sloped one joins that slope: the diagonal that they share
  /// is replaced by the other one, as long as fewer flat triangles come of it.
  void raise_flat(std::vector<Triangle>& triangles) const {
    const auto flat = [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(), [&](std::uint32_t i) { return nodes_[i].z == 0; });
    };
    std::map<Pair, std::uint32_t> beside;
    const auto enter = [&](std::uint32_t t) {
      for (int k = 0; k < 3; ++k) beside[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    };
    for (std::uint32_t t = 0; t < triangles.size(); ++t) enter(t);
    for (bool changed = true; changed;) {
      changed = false;
      for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3 && flat(triangles[t]); ++k) {
          const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3], c = triangles[t][(k + 2) % 3];
          const auto other = beside.find({b, a});
          if (other == beside.end() || segments_.contains(undirected(a, b)) || flat(triangles[other->second])) continue;
          const std::uint32_t o = other->second;
          const Triangle& opposite = triangles[o];
          const std::uint32_t d =
              *std::find_if(opposite.begin(), opposite.end(), [&](std::uint32_t i) { return i != a && i != b; });
          if (nodes_[d].z == 0 || !leaves_room(a, d, c) || !leaves_room(d, b, c)) continue;
          beside.erase({a, b});
          beside.erase({b, a});
          triangles[t] = {a, d, c};
          triangles[o] = {d, b, c};
          enter(t);
          enter(o);
          changed = true;
        }
    }
  }

  /// True for counter-clockwise triangles that are nowhere narrower than kSame.
  bool leaves_room(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    const Point2 a = nodes_[i].point, b = nodes_[j].point, c = nodes_[k].point;
    const double twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return twice_area > kSame * std::max({distance(a, b), distance(b, c), distance(c, a)});
  }

  bool in_plane(const Triangle& plane, const Triangle& other) const {
    const Point3 a = raised(plane[0]), b = raised(plane[1]), c = raised(plane[2]);
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
    return std::all_of(other.begin(), other.end(), [&](std::uint32_t i) {
      const Point3 p = raised(i);
      return std::fabs(nx * (p.x - a.x) + ny * (p.y - a.y) + nz * (p.z - a.z)) <= kPlane * length;
    });
  }

  /// The loops around a group of triangles, the outer one first; empty when they touch themselves.
  std::optional<std::vector<std::vector<std::uint32_t>>> border(const std::vector<Triangle>& group) const {
    std::set<Pair> edges;
    for (const Triangle& t : group)
      for (int k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
    std::map<std::uint32_t, std::uint32_t> next;
    for (const auto& [a, b] : edges)
      if (!edges.contains({b, a}) && !next.emplace(a, b).second) return std::nullopt;
    std::vector<std::vector<std::uint32_t>> loops;
    std::size_t outer = 0, outers = 0;
    while (!next.empty()) {
      std::vector<std::uint32_t> loop;
      std::vector<Point2> flat;
      const std::uint32_t first = next.begin()->first;
      std::uint32_t at = first;
      do {
        const auto step = next.find(at);
        if (step == next.end()) return std::nullopt;
        loop.push_back(at);
        flat.push_back(nodes_[at].point);
        at = step->second;
        next.erase(step);
      } while (at != first);
      if (geometry::signed_area(flat) > 0) {
        outer = loops.size();
        ++outers;
      }
      loops.push_back(std::move(loop));
    }
    if (outers != 1) return std::nullopt;
    std::swap(loops[0], loops[outer]);
    return loops;
  }

  void add_face(const std::vector<std::vector<std::uint32_t>>& loops, Roof& roof) const {
    Roof::Surface surface;
    for (const auto& loop : loops) {
      surface.loops.emplace_back();
      for (std::size_t k = 0; k < loop.size(); ++k) {
        surface.loops.back().push_back(raised(loop[k]));
        const std::int32_t edge = eaves_edge(loop[k], loop[(k + 1) % loop.size()]);
        if (edge >= 0 && (surface.edge < 0 || edge < surface.edge)) surface.edge = edge;
      }
    }
    roof.surfaces.push_back(std::move(surface));
  }

  /// The plan's edge that runs from a to b at eaves height; -1 for none.
  std::int32_t eaves_edge(std::uint32_t a, std::uint32_t b) const {
    if (nodes_[a].z != 0 || nodes_[b].z != 0 || !walls_.contains(undirected(a, b))) return -1;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const Edge& edge = edges_[e];
      const auto on = [&](std::uint32_t i) {
        return i == edge.from || i == edge.to ||
               std::find(edge.between.begin(), edge.between.end(), i) != edge.between.end();
      };
      if (on(a) && on(b)) return static_cast<std::int32_t>(e);
    }
    return -1;
  }

  void add_walls(Roof& roof) const {
    for (const Edge& edge : edges_) {
      std::vector<Point3> top{raised(edge.to)};
      for (auto i = edge.between.rbegin(); i != edge.between.rend(); ++i) top.push_back(raised(*i));
      top.push_back(raised(edge.from));
      roof.wall_tops.push_back(std::move(top));
    }
  }

  const Polygon& plan_;
  const RoofMeasures measures_;
  std::vector<Node> nodes_;  ///< the plan's corners first
  std::vector<Edge> edges_;
  std::vector<std::size_t> ring_starts_;  ///< edges
  std::vector<std::vector<std::uint32_t>> loops_;
  std::set<Pair> walls_, segments_;
};

}  // namespace

std::optional<Roof> lined_roof(const Polygon& plan, RoofMeasures measures, std::span<const RoofLine> lines) {
  if (plan.outer.size() < 3 || measures.height <= 0) return std::nullopt;
  return LinedRoof(plan, measures).build(lines);
}

}  // namespace blockrand::roofs
