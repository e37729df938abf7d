#include "pipeline/footprints/repair/shared_walls.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "pipeline/footprints/repair/contacts.h"
#include "pipeline/footprints/repair/terrace_vertices.h"
#include "pipeline/footprints/repair/wall_lines.h"
#include "pipeline/model/vector.h"

namespace blockrand::repair {

namespace {

using model::Point2;

/// Standard deviations that two copies of a corner lie apart along a wall at the most: an error in a disc has a bound of
/// 2.83; the rest is for the estimate.
constexpr double kReachSigmas = 3.5;
/// m. Added to it: walls mapped to the centimetre still end some centimetres apart.
constexpr double kLeastReach = 0.03;
/// Of max_shift: what merging may use up; the rest is for lines and squaring.
constexpr double kMergeShare = 0.9;
/// m. A corner nearer to a wall's end than this is not put into the wall.
constexpr double kLeastPiece = 0.03;

/// Vertices that are one corner: rings of linked members, one ring for each corner.
class Groups {
 public:
  explicit Groups(std::uint32_t size) : leader_(size), next_(size) {
    std::iota(leader_.begin(), leader_.end(), 0);
    std::iota(next_.begin(), next_.end(), 0);
  }
  std::uint32_t leader(std::uint32_t v) const { return leader_[v]; }
  void members(std::uint32_t v, std::vector<std::uint32_t>& out) const {
    out.clear();
    std::uint32_t m = v;
    do {
      out.push_back(m);
      m = next_[m];
    } while (m != v);
  }
  void merge(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t lead = std::min(leader_[a], leader_[b]);
    std::swap(next_[a], next_[b]);
    for (std::uint32_t m = a;;) {
      leader_[m] = lead;
      m = next_[m];
      if (m == a) break;
    }
  }

 private:
  std::vector<std::uint32_t> leader_, next_;
};

class Builder {
 public:
  Builder(const TerraceRow& row, const RepairOptions& options)
      : row_(row), options_(options), vertices_(terrace_vertices(row, options.snap_reach)), groups_(vertices_.size()) {}

  TerraceGraph run() {
    const bool share = options_.share_walls && row_.buildings.size() > 1;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> feet;
    if (share) {
      join_same_points();
      contacts_ = find_contacts(vertices_, row_, options_);
      feet = join_ends();
    }
    make_corners();
    make_rings(feet);
    if (share) straighten_walls(graph_, options_.max_shift * kMergeShare);
    for (Corner& c : graph_.corners) c.position = c.start;
    return std::move(graph_);
  }

 private:
  void join_same_points() {
    std::vector<std::uint32_t> order(vertices_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tie(vertices_.point[a], a) < std::tie(vertices_.point[b], b);
    });
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size() && vertices_.point[order[i]] == vertices_.point[order[j]]; ++j)
        join(order[i], order[j]);
  }

  bool apart(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(contacts_.apart.begin(), contacts_.apart.end(),
                              std::pair(std::min(a, b), std::max(a, b)));
  }

  /// Makes one corner of both vertices' corners, unless a rule forbids it.
  bool join(std::uint32_t a, std::uint32_t b) {
    if (groups_.leader(a) == groups_.leader(b)) return true;
    groups_.members(a, left_);
    groups_.members(b, right_);
    for (const std::uint32_t m : left_)
      for (const std::uint32_t n : right_) {
        const auto &r = vertices_.ring(m), &s = vertices_.ring(n);
        if (r.building == s.building && (r.polygon == s.polygon || vertices_.point[m] != vertices_.point[n]))
          return false;
        if (!same_level(row_.buildings[r.building].level, row_.buildings[s.building].level) || apart(m, n))
          return false;
      }
    left_.insert(left_.end(), right_.begin(), right_.end());
    const Place place = place_of(left_);
    for (const std::uint32_t m : left_)
      if (distance(place.point, vertices_.point[m]) > options_.max_shift * kMergeShare ||
          (vertices_.fixed[m] && vertices_.point[m] != place.point))
        return false;
    groups_.merge(a, b);
    return true;
  }

  struct Place {
    Point2 point;
    bool fixed;
  };
  /// Mean of the places that the members are drawn at, each once, or where a fixed one is. Sorts the members by point and
  /// sums in that order, so that it depends on nothing else.
  Place place_of(std::vector<std::uint32_t>& members) const {
    std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tie(vertices_.point[a], a) < std::tie(vertices_.point[b], b);
    });
    for (const std::uint32_t m : members)
      if (vertices_.fixed[m]) return {vertices_.point[m], true};
    const Point2 first = vertices_.point[members.front()];
    double x = 0, y = 0, n = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const Point2 p = vertices_.point[members[i]];
      if (i > 0 && p == vertices_.point[members[i - 1]]) continue;
      x += p.x - first.x;
      y += p.y - first.y;
      ++n;
    }
    return {{first.x + x / n, first.y + y / n}, false};
  }

  /// Joins corners at the ends of contacts; returns (vertex, edge) where a wall ends in the middle of another.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> join_ends() {
    struct Pair {
      double distance;
      Point2 least, most;
      std::uint32_t a, b;         ///< vertices
      std::uint32_t inner, edge;  ///< what ends in the middle of what, where they cannot be one
      bool operator<(const Pair& o) const {
        return std::tie(distance, least, most, a, b) < std::tie(o.distance, o.least, o.most, o.a, o.b);
      }
    };
    std::vector<Pair> pairs;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> feet;
    for (const Contact& w : contacts_.walls) {
      const double noise = std::max(contacts_.noise[vertices_.building(w.e)], contacts_.noise[vertices_.building(w.f)]);
      const double reach = std::min(options_.snap_reach, kReachSigmas * noise + kLeastReach);
      for (const Contact::End& end : {w.low, w.high}) {
        const Point2 p = vertices_.point[end.of_e], q = vertices_.point[end.of_f];
        const std::uint32_t inner = end.e_inside ? end.of_e : end.of_f, edge = end.e_inside ? w.f : w.e;
        if (std::fabs(end.along) <= reach)
          pairs.push_back({.distance = distance(p, q),
                           .least = std::min(p, q),
                           .most = std::max(p, q),
                           .a = end.of_e,
                           .b = end.of_f,
                           .inner = inner,
                           .edge = edge});
        else
          feet.emplace_back(inner, edge);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const Pair& p : pairs)
      if (!join(p.a, p.b)) feet.emplace_back(p.inner, p.edge);
    return feet;
  }

  void make_corners() {
    corner_of_.assign(vertices_.size(), model::kNoIndex);
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (corner_of_[v] != model::kNoIndex) continue;
      groups_.members(v, left_);
      const Place place = place_of(left_);
      Corner corner;
      corner.start = place.point;
      corner.fixed = place.fixed;
      corner.said.reserve(left_.size());
      for (const std::uint32_t m : left_) {
        corner_of_[m] = static_cast<std::uint32_t>(graph_.corners.size());
        if (corner.said.empty() || corner.said.back() != vertices_.point[m]) corner.said.push_back(vertices_.point[m]);
        const std::int64_t node = vertices_.node[m];
        if (node != 0 && (corner.node == 0 || node < corner.node)) corner.node = node;
      }
      graph_.corners.push_back(std::move(corner));
    }
  }

  struct Foot {
    std::uint32_t polygon, edge, corner;  ///< polygon: index of its first ring
    double along, across;                 ///< m, from the edge's first corner; off its line
  };

  bool in_polygon(std::uint32_t first_ring, std::uint32_t corner) const {
    const auto& first = vertices_.rings[first_ring];
    for (std::uint32_t r = first_ring; r < vertices_.rings.size(); ++r) {
      const auto& ring = vertices_.rings[r];
      if (ring.building != first.building || ring.polygon != first.polygon) break;
      for (std::uint32_t v = ring.first; v < ring.first + ring.count; ++v)
        if (corner_of_[v] == corner) return true;
    }
    return false;
  }

  std::vector<Foot> find_feet(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) const {
    std::vector<Foot> feet;
    for (const auto& [vertex, edge] : pairs) {
      const std::uint32_t corner = corner_of_[vertex], polygon = vertices_.ring_of[edge] - vertices_.ring(edge).ring;
      if (in_polygon(polygon, corner)) continue;
      const Point2 p = graph_.corners[corner].start;
      const Point2 a = graph_.corners[corner_of_[edge]].start,
                   b = graph_.corners[corner_of_[vertices_.next(edge)]].start;
      const double length = distance(a, b);
      if (length <= 2 * kLeastPiece) continue;
      const double x = (b.x - a.x) / length, y = (b.y - a.y) / length;
      const double along = (p.x - a.x) * x + (p.y - a.y) * y, across = std::fabs((p.x - a.x) * y - (p.y - a.y) * x);
      if (along < kLeastPiece || along > length - kLeastPiece || across > options_.snap_reach) continue;
      feet.push_back({polygon, edge, corner, along, across});
    }
    // One corner stands once in a polygon, on the wall that it is nearest to.
    std::sort(feet.begin(), feet.end(), [](const Foot& a, const Foot& b) {
      return std::tie(a.polygon, a.corner, a.across, a.edge) < std::tie(b.polygon, b.corner, b.across, b.edge);
    });
    feet.erase(std::unique(feet.begin(), feet.end(),
                           [](const Foot& a, const Foot& b) { return a.polygon == b.polygon && a.corner == b.corner; }),
               feet.end());
    std::sort(feet.begin(), feet.end(), [&](const Foot& a, const Foot& b) {
      return std::tie(a.edge, a.along, graph_.corners[a.corner].start, a.corner) <
             std::tie(b.edge, b.along, graph_.corners[b.corner].start, b.corner);
    });
    return feet;
  }

  void make_rings(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    const std::vector<Foot> feet = find_feet(pairs);
    auto foot = feet.begin();
    for (const auto& r : vertices_.rings) {
      TerraceRing ring{r.building, r.polygon, r.ring, {}, {}};
      for (std::uint32_t i = 0; i < r.count; ++i) {
        ring.corners.push_back(corner_of_[r.first + i]);
        ring.wall.push_back(i);
        for (; foot != feet.end() && foot->edge == r.first + i; ++foot) {
          ring.corners.push_back(foot->corner);
          ring.wall.push_back(i);
        }
      }
      graph_.rings.push_back(std::move(ring));
    }
  }

  const TerraceRow& row_;
  const RepairOptions& options_;
  TerraceVertices vertices_;
  Groups groups_;
  Contacts contacts_;
  std::vector<std::uint32_t> left_, right_;
  std::vector<std::uint32_t> corner_of_;  ///< by vertex
  TerraceGraph graph_;
};

}  // namespace

TerraceGraph build_terrace_graph(const TerraceRow& row, const RepairOptions& options) {
  return Builder(row, options).run();
}

}  // namespace blockrand::repair
