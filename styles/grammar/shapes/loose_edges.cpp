// Faces out of loose edges: caps of cut solids, unions of neighbouring faces.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "pipeline/base/portable_math.h"
#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

struct FlatLoop {
  std::vector<std::uint32_t> edges;
  double area = 0;
};

double cross2(Vector2 a, Vector2 b) { return a.x * b.y - a.y * b.x; }

bool inside(const std::vector<Vector2>& ring, Vector2 p) {
  bool in = false;
  for (std::size_t i = 0, k = ring.size() - 1; i < ring.size(); k = i++) {
    const Vector2 a = ring[i], b = ring[k];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
  }
  return in;
}

/// What is left where opposite edges cancel, by their vertices.
std::vector<LooseEdge> without_opposites(std::vector<LooseEdge> edges) {
  std::sort(edges.begin(), edges.end(), [](const LooseEdge& a, const LooseEdge& b) {
    return std::tuple(std::min(a.from, a.to), std::max(a.from, a.to), a.from, a.order) <
           std::tuple(std::min(b.from, b.to), std::max(b.from, b.to), b.from, b.order);
  });
  std::vector<LooseEdge> kept;
  for (std::size_t i = 0; i < edges.size();) {
    const std::uint32_t low = std::min(edges[i].from, edges[i].to), high = std::max(edges[i].from, edges[i].to);
    std::vector<LooseEdge> up, down;
    for (; i < edges.size() && std::min(edges[i].from, edges[i].to) == low &&
           std::max(edges[i].from, edges[i].to) == high;
         ++i)
      if (low != high) (edges[i].from == low ? up : down).push_back(edges[i]);
    const std::size_t common = std::min(up.size(), down.size());
    kept.insert(kept.end(), up.begin() + static_cast<std::ptrdiff_t>(common), up.end());
    kept.insert(kept.end(), down.begin() + static_cast<std::ptrdiff_t>(common), down.end());
  }
  return kept;
}

}  // namespace

std::vector<MeshFace> faces_of_edges(const std::vector<Vector3>& vertices, std::vector<LooseEdge> edges,
                                     Vector3 normal) {
  std::vector<LooseEdge> kept = without_opposites(std::move(edges));
  if (kept.empty()) return {};
  std::sort(kept.begin(), kept.end(), [](const LooseEdge& a, const LooseEdge& b) {
    return std::tie(a.from, a.to, a.order) < std::tie(b.from, b.to, b.order);
  });
  const Frame plane = frame_with_z(vertices[kept[0].from], normal, vertices[kept[0].to] - vertices[kept[0].from]);
  const auto flat = [&](std::uint32_t v) {
    const Vector3 p = place_back(plane, vertices[v]);
    return Vector2{p.x, p.y};
  };
  const auto first_from = [&](std::uint32_t v) {
    return static_cast<std::size_t>(
        std::lower_bound(kept.begin(), kept.end(), v, [](const LooseEdge& e, std::uint32_t w) { return e.from < w; }) -
        kept.begin());
  };
  std::vector<bool> used(kept.size(), false);
  std::vector<FlatLoop> loops;
  for (std::size_t start = 0; start < kept.size(); ++start) {
    if (used[start]) continue;
    // Walks on; where several ways lead on, the sharpest left turn keeps what touches in a point apart. A way that
    // comes back to a vertex it has been at closes a loop there.
    std::vector<std::uint32_t> path;
    std::size_t at = start;
    while (true) {
      used[at] = true;
      path.push_back(static_cast<std::uint32_t>(at));
      const std::uint32_t v = kept[at].to;
      // A loop closed?
      std::size_t begin = path.size();
      for (std::size_t k = path.size(); k-- > 0;)
        if (kept[path[k]].from == v) {
          begin = k;
          break;
        }
      if (begin < path.size()) {
        FlatLoop loop;
        loop.edges.assign(path.begin() + static_cast<std::ptrdiff_t>(begin), path.end());
        path.resize(begin);
        loops.push_back(std::move(loop));
      }
      if (path.empty()) break;
      const LooseEdge& last = kept[path.back()];
      const Vector2 here = flat(last.to), came = flat(last.from);
      const Vector2 along{here.x - came.x, here.y - came.y};
      std::size_t best = kept.size();
      double best_turn = -10;
      const std::size_t first = first_from(last.to);
      const bool only = first + 1 >= kept.size() || kept[first + 1].from != last.to;
      for (std::size_t k = first; k < kept.size() && kept[k].from == last.to; ++k) {
        if (used[k]) continue;
        if (only) {
          best = k;
          break;
        }
        const Vector2 to = flat(kept[k].to), way{to.x - here.x, to.y - here.y};
        const double turned = base::atan2(cross2(along, way), along.x * way.x + along.y * way.y);
        if (turned > best_turn) best_turn = turned, best = k;
      }
      if (best == kept.size()) break;  // does not close
      at = best;
    }
  }
  std::vector<std::vector<Vector2>> rings;
  for (FlatLoop& loop : loops) {
    std::vector<Vector2> ring;
    for (const std::uint32_t e : loop.edges) ring.push_back(flat(kept[e].from));
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      loop.area += cross2({ring[i].x - ring[0].x, ring[i].y - ring[0].y},
                          {ring[i + 1].x - ring[0].x, ring[i + 1].y - ring[0].y}) /
                   2;
    rings.push_back(std::move(ring));
  }
  const auto corners = [&](const FlatLoop& loop) {
    std::size_t first = 0;
    for (std::size_t i = 1; i < loop.edges.size(); ++i)
      if (kept[loop.edges[i]].order < kept[loop.edges[first]].order) first = i;
    Loop out;
    for (std::size_t i = 0; i < loop.edges.size(); ++i) {
      const LooseEdge& e = kept[loop.edges[(first + i) % loop.edges.size()]];
      out.push_back({e.from, e.tags});
    }
    return out;
  };
  std::vector<MeshFace> faces;
  std::vector<std::size_t> face_loop;
  for (std::size_t l = 0; l < loops.size(); ++l)
    if (loops[l].area > 0 && loops[l].edges.size() >= 3) {
      faces.emplace_back();
      faces.back().loops.push_back(corners(loops[l]));
      face_loop.push_back(l);
    }
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (!(loops[l].area < 0) || loops[l].edges.size() < 3) continue;
    // Just beside the middle of the hole's first edge, on the filled side.
    const Vector2 a = rings[l][0], b = rings[l][1];
    const double long_side = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    const double step = 1e-6;
    const Vector2 p{(a.x + b.x) / 2 - (b.y - a.y) / long_side * step, (a.y + b.y) / 2 + (b.x - a.x) / long_side * step};
    std::size_t best = faces.size();
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (inside(rings[face_loop[f]], p) &&
          (best == faces.size() || loops[face_loop[f]].area < loops[face_loop[best]].area))
        best = f;
    if (best < faces.size()) faces[best].loops.push_back(corners(loops[l]));
  }
  return faces;
}

}  // namespace blockrand::grammar
