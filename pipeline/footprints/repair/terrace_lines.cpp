#include "pipeline/footprints/repair/terrace_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pipeline/footprints/repair/arcs.h"
#include "pipeline/footprints/repair/ring_frames.h"
#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::Point2;

class Reader {
 public:
  Reader(const TerraceGraph& graph, std::span<const std::uint32_t> rings) : graph_(graph), rings_(rings) {
    for (const std::uint32_t r : rings) {
      const std::uint32_t b = graph.rings[r].building;
      if (out_.buildings.empty() || out_.buildings.back() != b) out_.buildings.push_back(b);
    }
  }

  TerraceLines read() {
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
        const Point2 d = corner_evidence(b) - corner_evidence(a);
        const double ka = corner_weight(a), kb = corner_weight(b);
        l.length = length(d);
        l.along = unit(d);
        l.weight = ka * kb / (ka + kb) * l.length * l.length;
        continue;
      }
      fit_long_line(l);
    }
  }

  /// Principal axis of what is said of the line's corners, by weighted regressions across the axis found before.
  void fit_long_line(WallLine& l) {
    std::sort(l.corners.begin(), l.corners.end());
    l.corners.erase(std::unique(l.corners.begin(), l.corners.end()), l.corners.end());
    const Point2 origin = graph_.corners[l.corners.front()].start;
    const auto from_origin = [&](Point2 p) { return p - origin; };
    // The corner farthest from any other is an end; the one farthest from that is the other end.
    const auto farthest = [&](Point2 from) {
      Point2 best = from;
      double most = -1;
      for (const std::uint32_t c : l.corners) {
        const Point2 p = from_origin(graph_.corners[c].start), d = p - from;
        if (dot(d, d) > most) most = dot(d, d), best = p;
      }
      return best;
    };
    const Point2 a = farthest({0, 0}), b = farthest(a);
    l.length = length(b - a);
    l.along = unit(b - a);
    double k = 0;
    Point2 mean;
    for (const std::uint32_t c : l.corners) {
      const double w = corner_weight(graph_.corners[c]);
      const Point2 p = from_origin(corner_evidence(graph_.corners[c]));
      k += w, mean.x += w * p.x, mean.y += w * p.y;
    }
    mean = {mean.x / k, mean.y / k};
    for (int round = 0; round < 3; ++round) {
      double tt = 0, tr = 0;
      for (const std::uint32_t c : l.corners) {
        const double w = corner_weight(graph_.corners[c]);
        const Point2 d = from_origin(corner_evidence(graph_.corners[c])) - mean;
        const double t = dot(d, l.along);
        tt += w * t * t, tr += w * t * cross(l.along, d);
      }
      const double slope = tt > 0 ? tr / tt : 0;
      l.along = turned(l.along, slope);
      l.weight = tt;
    }
    std::sort(l.corners.begin(), l.corners.end(), [&](std::uint32_t p, std::uint32_t q) {
      const double tp = dot(from_origin(graph_.corners[p].start), l.along);
      const double tq = dot(from_origin(graph_.corners[q].start), l.along);
      return tp != tq ? tp < tq : p < q;
    });
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

  const TerraceGraph& graph_;
  std::span<const std::uint32_t> rings_;
  TerraceLines out_;
};

}  // namespace

TerraceLines terrace_lines(const TerraceGraph& graph, std::span<const std::uint32_t> rings) {
  return Reader(graph, rings).read();
}

std::vector<std::vector<std::uint32_t>> connected_rings(const TerraceGraph& graph, std::size_t buildings) {
  std::vector<std::uint32_t> parent(buildings), owner(graph.corners.size(), kNoFrame);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const TerraceRing& ring : graph.rings)
    for (const std::uint32_t c : ring.corners) {
      if (owner[c] == kNoFrame) owner[c] = ring.building;
      const std::uint32_t a = find(owner[c]), b = find(ring.building);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<std::vector<std::uint32_t>> out;
  std::vector<std::uint32_t> place(buildings, kNoFrame);
  for (std::uint32_t r = 0; r < graph.rings.size(); ++r) {
    const std::uint32_t root = find(graph.rings[r].building);
    if (place[root] == kNoFrame) {
      place[root] = static_cast<std::uint32_t>(out.size());
      out.emplace_back();
    }
    out[place[root]].push_back(r);
  }
  return out;
}

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
