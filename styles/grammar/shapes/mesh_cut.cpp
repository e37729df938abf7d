#include "styles/grammar/shapes/mesh_cut.h"

#include <algorithm>
#include <cmath>

namespace blockrand::grammar {

namespace {

/// A corner of a cut loop: at a corner of the face (share 0), or on the edge that starts there.
struct CutCorner {
  std::uint32_t vertex = 0;
  std::uint32_t loop = 0, corner = 0;
  double share = 0;
  std::int32_t edge = -1;  ///< the outline's corner whose edge goes on from here; -1: a cut, or a hole's
  std::uint16_t tags = 0;
};
struct Chain {
  std::vector<CutCorner> corners;
  double start_at = 0, end_at = 0;  ///< along the cut
  bool closed = false;
};
struct CrossingPoint {
  std::uint32_t low = 0, high = 0, vertex = 0;
};

class Cutter {
 public:
  Cutter(Mesh& mesh, const Plane& plane) : mesh_(mesh), plane_(plane) {}

  bool run(bool cap) {
    const std::size_t n = mesh_.vertices.size();
    distance_.resize(n);
    bool any_out = false, any_in = false;
    for (std::size_t i = 0; i < n; ++i) {
      const double d = plane_.distance(mesh_.vertices[i]);
      distance_[i] = std::fabs(d) <= kInPlane ? 0 : d;
      any_out |= distance_[i] < 0;
      any_in |= distance_[i] > 0;
    }
    if (!any_out) return false;
    if (!any_in) {
      mesh_.faces.clear();
      mesh_.vertices.clear();
      for (UvSet& set : mesh_.uv) set.clear();
      return true;
    }
    // Of a solid that is inside out (negative sizes) the caps are, too.
    const double cap_side = cap && signed_volume(mesh_) < 0 ? 1 : -1;
    std::vector<MeshFace> old;
    old.swap(mesh_.faces);
    old_uv_.swap(mesh_.uv);
    mesh_.faces.reserve(old.size() + 1);
    for (std::size_t f = 0; f < old.size(); ++f) cut_face(old[f], f);
    const std::size_t before_caps = mesh_.faces.size();
    if (cap) {
      std::vector<LooseEdge> edges;
      for (const MeshFace& face : mesh_.faces)
        for (const Loop& loop : face.loops)
          for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::uint32_t a = loop[i].vertex, b = loop[i + 1 == loop.size() ? 0 : i + 1].vertex;
            if (distance_[a] == 0 && distance_[b] == 0)
              edges.push_back({b, a, 0, static_cast<std::uint32_t>(edges.size())});
          }
      for (MeshFace& face : faces_of_edges(mesh_.vertices, std::move(edges), plane_.normal * cap_side))
        mesh_.faces.push_back(std::move(face));
    }
    if (mesh_.faces.size() > before_caps)
      for (UvSet& set : mesh_.uv)
        if (!set.empty()) set.resize(mesh_.faces.size());
    drop_unused_vertices(mesh_);
    return true;
  }

 private:
  std::uint32_t crossing(std::uint32_t a, std::uint32_t b) {
    if (distance_[a] == 0) return a;
    if (distance_[b] == 0) return b;
    const std::uint32_t low = std::min(a, b), high = std::max(a, b);
    for (const CrossingPoint& c : crossings_)
      if (c.low == low && c.high == high) return c.vertex;
    const double dl = distance_[low], dh = distance_[high];
    const Vector3 p = mesh_.vertices[low], q = mesh_.vertices[high];
    const auto vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
    Vector3 at = p + (q - p) * (dl / (dl - dh));
    at = at - plane_.normal * plane_.distance(at);
    mesh_.vertices.push_back(at);
    distance_.push_back(0);
    crossings_.push_back({low, high, vertex});
    return vertex;
  }
  double share(std::uint32_t a, std::uint32_t b) const {
    return distance_[a] == distance_[b] ? 0 : distance_[a] / (distance_[a] - distance_[b]);
  }

  void emit(const MeshFace& face, std::size_t f, const std::vector<const std::vector<CutCorner>*>& loops) {
    MeshFace out;
    out.tags = face.tags;
    out.material = face.material;
    out.loops.reserve(loops.size());
    std::vector<std::size_t> firsts;
    for (const auto* loop : loops) {
      std::size_t first = 0;
      for (std::size_t i = 1; i < loop->size(); ++i) {
        const std::int32_t e = (*loop)[i].edge, best = (*loop)[first].edge;
        if (e >= 0 && (best < 0 || e < best)) first = i;
      }
      // Where the first edge is cut away, the edge of the cut stands for it: upper pieces of walls begin below.
      const std::size_t before = (first + loop->size() - 1) % loop->size();
      if ((*loop)[first].edge > 0 && (*loop)[before].edge < 0) first = before;
      Loop corners;
      corners.reserve(loop->size());
      for (std::size_t i = 0; i < loop->size(); ++i) {
        const CutCorner& c = (*loop)[(first + i) % loop->size()];
        corners.push_back({c.vertex, c.tags});
      }
      firsts.push_back(first);
      out.loops.push_back(std::move(corners));
    }
    for (std::size_t s = 0; s < old_uv_.size(); ++s) {
      if (old_uv_[s].empty()) continue;
      mesh_.uv[s].resize(mesh_.faces.size());
      std::vector<std::vector<Vector2>> uv;
      if (f < old_uv_[s].size() && !old_uv_[s][f].empty())
        for (std::size_t l = 0; l < loops.size(); ++l) {
          uv.emplace_back();
          for (std::size_t i = 0; i < loops[l]->size(); ++i) {
            const CutCorner& c = (*loops[l])[(firsts[l] + i) % loops[l]->size()];
            const auto& ring = old_uv_[s][f][c.loop];
            const Vector2 a = ring[c.corner], b = ring[(c.corner + 1) % ring.size()];
            uv.back().push_back({a.x + (b.x - a.x) * c.share, a.y + (b.y - a.y) * c.share});
          }
        }
      mesh_.uv[s].push_back(std::move(uv));
    }
    mesh_.faces.push_back(std::move(out));
  }

  void keep(const MeshFace& face, std::size_t f) {
    for (std::size_t s = 0; s < old_uv_.size(); ++s)
      if (!old_uv_[s].empty()) {
        mesh_.uv[s].resize(mesh_.faces.size());
        mesh_.uv[s].push_back(f < old_uv_[s].size() ? old_uv_[s][f] : UvSet::value_type{});
      }
    mesh_.faces.push_back(face);
  }

  void cut_face(const MeshFace& face, std::size_t f) {
    bool any_in = false, any_out = false;
    for (const Loop& loop : face.loops)
      for (const Corner c : loop) {
        any_in |= distance_[c.vertex] > 0;
        any_out |= distance_[c.vertex] < 0;
      }
    if (!any_in) return;
    if (!any_out) return keep(face, f);
    const Vector3 along = cross(plane_.normal, face_normal(mesh_, face));
    std::vector<Chain> chains;
    std::vector<std::vector<CutCorner>> whole;  // loops that are not cut
    for (std::uint32_t l = 0; l < face.loops.size(); ++l) chains_of(face.loops[l], l, along, chains, whole);
    if (chains.size() == 1 && whole.empty()) {
      tidy(chains[0].corners);
      if (chains[0].corners.size() >= 3) emit(face, f, {&chains[0].corners});
      return;
    }
    join(face, f, chains, whole);
  }

  /// The parts of a loop strictly on the kept side, with the points in the plane at their ends.
  void chains_of(const Loop& loop, std::uint32_t l, Vector3 along, std::vector<Chain>& chains,
                 std::vector<std::vector<CutCorner>>& whole) {
    const std::size_t n = loop.size();
    std::size_t start = n;
    for (std::size_t i = 0; i < n; ++i)
      if (distance_[loop[i].vertex] <= 0 && distance_[loop[(i + 1) % n].vertex] > 0) {
        start = i;
        break;
      }
    const auto edge_of = [&](std::size_t i) { return l == 0 ? static_cast<std::int32_t>(i) : -1; };
    if (start == n) {
      if (n == 0 || distance_[loop[0].vertex] <= 0) return;
      std::vector<CutCorner> corners;
      for (std::size_t i = 0; i < n; ++i)
        corners.push_back({loop[i].vertex, l, static_cast<std::uint32_t>(i), 0, edge_of(i), loop[i].edge_tags});
      whole.push_back(std::move(corners));
      return;
    }
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = (start + k) % n, j = (i + 1) % n;
      const std::uint32_t a = loop[i].vertex, b = loop[j].vertex;
      const auto ci = static_cast<std::uint32_t>(i);
      if (distance_[a] > 0) chains.back().corners.push_back({a, l, ci, 0, edge_of(i), loop[i].edge_tags});
      if (distance_[a] <= 0 && distance_[b] > 0) {
        chains.emplace_back();
        chains.back().corners.reserve(8);
        const std::uint32_t v = crossing(a, b);
        chains.back().corners.push_back({v, l, ci, share(a, b), edge_of(i), loop[i].edge_tags});
        chains.back().start_at = dot(along, mesh_.vertices[v]);
      } else if (distance_[a] > 0 && distance_[b] <= 0) {
        const std::uint32_t v = crossing(a, b);
        chains.back().corners.push_back({v, l, ci, share(a, b), -1, 0});
        chains.back().end_at = dot(along, mesh_.vertices[v]);
      }
    }
  }

  static void tidy(std::vector<CutCorner>& corners) {
    // A chain that comes back to the point where it began has that point once, with the edge that goes on.
    if (corners.size() > 1 && corners.front().vertex == corners.back().vertex) corners.pop_back();
  }

  void join(const MeshFace& face, std::size_t f, std::vector<Chain>& chains,
            std::vector<std::vector<CutCorner>>& whole) {
    struct End {
      double at;
      std::uint32_t vertex, chain;
      bool leaves;  // the chain ends here
    };
    std::vector<End> ends;
    for (std::uint32_t c = 0; c < chains.size(); ++c) {
      ends.push_back({chains[c].end_at, chains[c].corners.back().vertex, c, true});
      ends.push_back({chains[c].start_at, chains[c].corners.front().vertex, c, false});
    }
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
      return a.at != b.at ? a.at < b.at : a.vertex != b.vertex ? a.vertex < b.vertex : a.chain < b.chain;
    });
    // Between a leaving and the next entering the cut runs inside the face. In one point the order is open: what is
    // due comes first.
    std::vector<std::uint32_t> next(chains.size(), 0xffffffff);
    std::vector<bool> taken(ends.size(), false);
    bool due = true;
    std::uint32_t from = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      std::size_t pick = ends.size(), any = ends.size();
      for (std::size_t i = 0; i < ends.size(); ++i) {
        if (taken[i]) continue;
        if (any == ends.size()) any = i;
        if (ends[i].at > ends[any].at + kInPlane && pick != ends.size()) break;
        if (ends[i].leaves == due) {
          pick = i;
          break;
        }
      }
      if (pick == ends.size()) break;
      taken[pick] = true;
      if (due)
        from = ends[pick].chain;
      else
        next[from] = ends[pick].chain;
      due = !due;
    }
    std::vector<std::vector<CutCorner>> loops;
    std::vector<bool> used(chains.size(), false);
    for (std::uint32_t c = 0; c < chains.size(); ++c) {
      if (used[c]) continue;
      std::vector<CutCorner> loop;
      for (std::uint32_t at = c; at != 0xffffffff && !used[at]; at = next[at]) {
        used[at] = true;
        auto& corners = chains[at].corners;
        if (!loop.empty() && loop.back().vertex == corners.front().vertex) loop.pop_back();
        loop.insert(loop.end(), corners.begin(), corners.end());
      }
      tidy(loop);
      if (loop.size() >= 3) loops.push_back(std::move(loop));
    }
    for (auto& w : whole) loops.push_back(std::move(w));
    emit_nested(face, f, loops);
  }

  void emit_nested(const MeshFace& face, std::size_t f, const std::vector<std::vector<CutCorner>>& loops) {
    const Vector3 normal = face_normal(mesh_, face);
    const Frame flat = frame_with_z(mesh_.vertices[loops.empty() ? 0 : loops[0][0].vertex], normal, {1, 0, 0});
    std::vector<std::vector<const std::vector<CutCorner>*>> out;
    std::vector<const std::vector<CutCorner>*> holes;
    for (const auto& loop : loops) {
      Loop corners;
      for (const CutCorner& c : loop) corners.push_back({c.vertex, 0});
      if (dot(area_vector(mesh_, corners), normal) > 0)
        out.push_back({&loop});
      else
        holes.push_back(&loop);
    }
    for (const auto* hole : holes) {
      const Vector3 p = place_back(flat, mesh_.vertices[(*hole)[0].vertex]);
      std::size_t best = out.size();
      for (std::size_t o = 0; o < out.size() && out.size() > 1; ++o) {
        bool in = false;
        const auto& ring = *out[o][0];
        for (std::size_t i = 0, k = ring.size() - 1; i < ring.size(); k = i++) {
          const Vector3 a = place_back(flat, mesh_.vertices[ring[i].vertex]);
          const Vector3 b = place_back(flat, mesh_.vertices[ring[k].vertex]);
          if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
        }
        if (in) best = o;
      }
      if (best == out.size() && !out.empty()) best = 0;
      if (best < out.size()) out[best].push_back(hole);
    }
    for (const auto& group : out) emit(face, f, group);
  }

  Mesh& mesh_;
  const Plane& plane_;
  std::vector<double> distance_;
  std::vector<CrossingPoint> crossings_;
  std::array<UvSet, kUvSetCount> old_uv_;
};

}  // namespace

bool cut_mesh(Mesh& mesh, const Plane& plane, bool cap) { return Cutter(mesh, plane).run(cap); }

}  // namespace blockrand::grammar
