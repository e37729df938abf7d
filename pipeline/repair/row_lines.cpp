#include "pipeline/repair/row_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pipeline/repair/arcs.h"

namespace blockrand::repair {

namespace {

using model::Point2;

double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }
Point2 minus(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
double norm(Point2 a) { return std::sqrt(dot(a, a)); }
Point2 unit(Point2 a) {
  const double n = norm(a);
  return n > 0 ? Point2{a.x / n, a.y / n} : Point2{1, 0};
}

class Reader {
 public:
  Reader(const RowGraph& graph, std::span<const std::uint32_t> rings) : graph_(graph), rings_(rings) {
    for (const std::uint32_t r : rings) {
      const std::uint32_t b = graph.rings[r].building;
      if (out_.buildings.empty() || out_.buildings.back() != b) out_.buildings.push_back(b);
    }
  }

  RowLines read() {
    split_rings();
    join_shared();
    fit_lines();
    mark_curves();
    return std::move(out_);
  }

 private:
  void split_rings() {
    for (const std::uint32_t r : rings_) {
      const auto& wall = graph_.rings[r].wall;
      const auto n = static_cast<std::uint32_t>(wall.size());
      std::uint32_t start = n;
      for (std::uint32_t i = 0; i < n && start == n; ++i)
        if (wall[i] != wall[(i + n - 1) % n]) start = i;
      for (std::uint32_t i = 0; i < n;) {
        std::uint32_t j = i + 1;
        while (start < n && j < n && wall[(start + j) % n] == wall[(start + i) % n]) ++j;
        out_.walls.push_back({r, (start + i) % n, j - i, 0});
        i = j;
      }
    }
  }

  std::uint32_t corner(const RingWall& w, std::uint32_t k) const {
    const auto& corners = graph_.rings[w.ring].corners;
    return corners[(w.first + k) % corners.size()];
  }

  void join_shared() {
    std::vector<std::uint32_t> root(out_.walls.size());  // the least wall of the same line
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    if (rings_.size() > 1) {
      std::vector<std::array<std::uint32_t, 3>> edges;  // lower corner, higher corner, wall
      for (std::uint32_t w = 0; w < out_.walls.size(); ++w)
        for (std::uint32_t k = 0; k < out_.walls[w].count; ++k) {
          const std::uint32_t a = corner(out_.walls[w], k), b = corner(out_.walls[w], k + 1);
          edges.push_back({std::min(a, b), std::max(a, b), w});
        }
      std::sort(edges.begin(), edges.end());
      for (std::size_t e = 1; e < edges.size(); ++e)
        if (edges[e][0] == edges[e - 1][0] && edges[e][1] == edges[e - 1][1]) {
          const std::uint32_t a = find(edges[e - 1][2]), b = find(edges[e][2]);
          root[std::max(a, b)] = std::min(a, b);
        }
    }
    std::vector<std::uint32_t> line(out_.walls.size());
    std::uint32_t building = 0;
    for (std::uint32_t w = 0; w < out_.walls.size(); ++w) {
      while (out_.buildings[building] != graph_.rings[out_.walls[w].ring].building) ++building;
      const std::uint32_t least = find(w);
      if (least == w) {
        line[w] = static_cast<std::uint32_t>(out_.lines.size());
        out_.lines.emplace_back();
      }
      out_.walls[w].line = line[least];
      WallLine& l = out_.lines[line[least]];
      for (std::uint32_t k = 0; k <= out_.walls[w].count; ++k) l.corners.push_back(corner(out_.walls[w], k));
      l.buildings.push_back(building);
    }
  }

  void fit_lines() {
    for (WallLine& l : out_.lines) {
      std::sort(l.buildings.begin(), l.buildings.end());
      l.buildings.erase(std::unique(l.buildings.begin(), l.buildings.end()), l.buildings.end());
      if (l.corners.size() == 2) {
        const Corner &a = graph_.corners[l.corners[0]], &b = graph_.corners[l.corners[1]];
        const Point2 d = minus(corner_evidence(b), corner_evidence(a));
        const double ka = corner_weight(a), kb = corner_weight(b);
        l.length = norm(d);
        l.along = unit(d);
        l.weight = ka * kb / (ka + kb) * l.length * l.length;
        continue;
      }
      fit_long_line(l);
    }
  }

  /// Weighted regression across the chord between its outermost corners.
  void fit_long_line(WallLine& l) {
    std::sort(l.corners.begin(), l.corners.end());
    l.corners.erase(std::unique(l.corners.begin(), l.corners.end()), l.corners.end());
    const auto start = [&](std::uint32_t c) { return graph_.corners[c].start; };
    const auto farthest = [&](std::uint32_t from) {
      std::uint32_t best = from;
      double most = -1;
      for (const std::uint32_t c : l.corners) {
        const Point2 d = minus(start(c), start(from));
        if (dot(d, d) > most) most = dot(d, d), best = c;
      }
      return best;
    };
    const std::uint32_t a = farthest(l.corners.front()), b = farthest(a);
    const Point2 e = unit(minus(start(b), start(a)));
    const Point2 origin = start(a);
    std::sort(l.corners.begin(), l.corners.end(), [&](std::uint32_t p, std::uint32_t q) {
      const double tp = dot(minus(start(p), origin), e), tq = dot(minus(start(q), origin), e);
      return tp != tq ? tp < tq : p < q;
    });
    l.length = dot(minus(start(b), origin), e);
    double k = 0, t = 0, r = 0;
    for (const std::uint32_t c : l.corners) {
      const double w = corner_weight(graph_.corners[c]);
      const Point2 d = minus(corner_evidence(graph_.corners[c]), origin);
      k += w, t += w * dot(d, e), r += w * cross(e, d);
    }
    t /= k, r /= k;
    double tt = 0, tr = 0;
    for (const std::uint32_t c : l.corners) {
      const double w = corner_weight(graph_.corners[c]);
      const Point2 d = minus(corner_evidence(graph_.corners[c]), origin);
      tt += w * (dot(d, e) - t) * (dot(d, e) - t), tr += w * (dot(d, e) - t) * (cross(e, d) - r);
    }
    const double slope = tt > 0 ? tr / tt : 0;
    l.along = unit({e.x - slope * e.y, e.y + slope * e.x});
    l.weight = tt;
  }

  void mark_curves() {
    std::vector<Point2> points;
    for (std::size_t w = 0; w < out_.walls.size();) {
      std::size_t end = w;
      points.clear();
      for (; end < out_.walls.size() && out_.walls[end].ring == out_.walls[w].ring; ++end)
        points.push_back(graph_.corners[corner(out_.walls[end], 0)].start);
      for (const ArcRun& run : find_arc_runs(points))
        for (std::uint32_t k = 0; k < run.count; ++k)
          out_.lines[out_.walls[w + (run.first + k) % points.size()].line].free = true;
      w = end;
    }
  }

  const RowGraph& graph_;
  std::span<const std::uint32_t> rings_;
  RowLines out_;
};

}  // namespace

RowLines row_lines(const RowGraph& graph, std::span<const std::uint32_t> rings) { return Reader(graph, rings).read(); }

double corner_weight(const Corner& corner) {
  return corner.said.empty() ? 0.25 : static_cast<double>(corner.said.size());
}

Point2 corner_evidence(const Corner& corner) {
  if (corner.said.size() < 2) return corner.said.empty() ? corner.start : corner.said.front();
  Point2 mean;
  for (const Point2 p : corner.said) mean.x += p.x - corner.start.x, mean.y += p.y - corner.start.y;
  const double n = static_cast<double>(corner.said.size());
  return {corner.start.x + mean.x / n, corner.start.y + mean.y / n};
}

}  // namespace blockrand::repair
