#include "styles/roofs/plan_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/grid.h"
#include "pipeline/geometry/solid_builder.h"
#include "pipeline/geometry/triangulate.h"

namespace blockrand::roofs {

using geometry::Grid2;
using geometry::Grid3;
using model::Point3;
using model::SurfaceKind;

namespace {

constexpr double kStep = 1 / model::kGridStepsPerMetre;
constexpr std::int64_t kSameSteps = 3;  ///< kSameHeight in whole steps
/// m. Faces are one when all corners lie this near to their plane: half of what geometry::check_solid allows.
constexpr double kOnePlane = 0.004;
/// m. A corner this near to the line of its neighbours bends nothing.
constexpr double kStraight = 1.01 * kStep;

struct Corner {
  Grid2 place;
  std::int64_t under = 0, top = 0;  ///< grid steps
  bool against_building = false;
};
using Cell = std::vector<std::vector<Corner>>;

/// A face as loops of grid points.
struct RawFace {
  SurfaceKind kind = SurfaceKind::wall;
  std::vector<std::vector<Grid3>> loops;
};

Point3 metres(Grid3 p) {
  return {static_cast<double>(p.x) * kStep, static_cast<double>(p.y) * kStep, static_cast<double>(p.z) * kStep};
}

/// Newell's normal of loops, twice the area long, about the first point.
std::array<double, 3> normal_of(const std::vector<std::vector<Grid3>>& loops) {
  std::array<double, 3> n{};
  const Grid3 o = loops[0][0];
  for (const auto& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Grid3 a = loop[i] - o, b = loop[(i + 1) % loop.size()] - o;
      n[0] += static_cast<double>(a.y) * static_cast<double>(b.z) - static_cast<double>(a.z) * static_cast<double>(b.y);
      n[1] += static_cast<double>(a.z) * static_cast<double>(b.x) - static_cast<double>(a.x) * static_cast<double>(b.z);
      n[2] += static_cast<double>(a.x) * static_cast<double>(b.y) - static_cast<double>(a.y) * static_cast<double>(b.x);
    }
  return n;
}

/// Largest distance of the loops' points from the plane through their mean, m.
double off_plane(const std::vector<std::vector<Grid3>>& loops, const std::array<double, 3>& n) {
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (length == 0) return 1e9;
  const Grid3 o = loops[0][0];
  double least = 1e18, most = -1e18;
  for (const auto& loop : loops)
    for (const Grid3 p : loop) {
      const Grid3 d = p - o;
      const double h =
          (n[0] * static_cast<double>(d.x) + n[1] * static_cast<double>(d.y) + n[2] * static_cast<double>(d.z)) /
          length;
      least = std::min(least, h);
      most = std::max(most, h);
    }
  return (most - least) / 2 * kStep;
}

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

using Side = std::pair<Grid2, Grid2>;
struct SideOf {
  std::uint32_t cell = 0, loop = 0, index = 0;
};

class Assembly {
 public:
  explicit Assembly(std::span<const PlanCell> cells) {
    std::map<Grid2, std::set<std::int64_t>> heights;
    for (const PlanCell& cell : cells)
      for (const auto& loop : cell.loops)
        for (const PlanCell::Corner& c : loop) {
          auto& at = heights[geometry::to_grid(c.place)];
          at.insert(geometry::to_grid(c.under));
          at.insert(geometry::to_grid(c.top));
        }
    // Heights that differ by rounding become the lowest of them.
    std::map<Grid2, std::map<std::int64_t, std::int64_t>> same;
    for (const auto& [place, values] : heights) {
      std::int64_t first = 0;
      bool any = false;
      for (const std::int64_t z : values) {
        if (!any || z - first > kSameSteps) first = z;
        any = true;
        same[place][z] = first;
      }
    }
    for (const PlanCell& cell : cells) {
      Cell made;
      for (const auto& loop : cell.loops) {
        std::vector<Corner> corners;
        for (const PlanCell::Corner& c : loop) {
          const Grid2 place = geometry::to_grid(c.place);
          const auto& at = same.at(place);
          if (!corners.empty() && corners.back().place == place) continue;
          corners.push_back(
              {place, at.at(geometry::to_grid(c.under)), at.at(geometry::to_grid(c.top)), c.against_building});
        }
        while (corners.size() > 1 && corners.back().place == corners.front().place) corners.pop_back();
        if (corners.size() >= 3)
          made.push_back(std::move(corners));
        else if (made.empty())
          break;  // without an outer loop there is nothing
      }
      cells_.push_back(std::move(made));
    }
    for (std::uint32_t c = 0; c < cells_.size(); ++c)
      for (std::uint32_t l = 0; l < cells_[c].size(); ++l)
        for (std::uint32_t i = 0; i < cells_[c][l].size(); ++i)
          sides_[{at(c, l, i).place, at(c, l, i + 1).place}] = {c, l, i};
  }

  CellBodies take(const BodySurfaceKinds& looks) {
    std::vector<std::uint32_t> parent(cells_.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for (std::uint32_t c = 0; c < cells_.size(); ++c)
      for (std::uint32_t l = 0; l < cells_[c].size(); ++l)
        for (std::uint32_t i = 0; i < cells_[c][l].size(); ++i)
          if (const auto other = joined_neighbour(c, l, i)) {
            const std::uint32_t a = root(parent, c), b = root(parent, *other);
            parent[std::max(a, b)] = std::min(a, b);
          }
    std::map<std::uint32_t, std::vector<std::uint32_t>> bodies;
    for (std::uint32_t c = 0; c < cells_.size(); ++c) bodies[root(parent, c)].push_back(c);
    CellBodies out;
    for (const auto& [first, members] : bodies) {
      if (auto solid = body(members, looks)) {
        out.solids.push_back(std::move(*solid));
        continue;
      }
      for (const std::uint32_t c : members) {
        auto alone = members.size() > 1 ? body({c}, looks) : std::nullopt;
        if (alone)
          out.solids.push_back(std::move(*alone));
        else
          out.lost.push_back(c);
      }
    }
    std::sort(out.lost.begin(), out.lost.end());
    return out;
  }

 private:
  const Corner& at(std::uint32_t c, std::uint32_t l, std::uint32_t i) const {
    const auto& loop = cells_[c][l];
    return loop[i % loop.size()];
  }

  /// The cell on the other side of a side, where both have a common piece of it and may be one body.
  std::optional<std::uint32_t> joined_neighbour(std::uint32_t c, std::uint32_t l, std::uint32_t i) const {
    const Corner &p = at(c, l, i), &q = at(c, l, i + 1);
    const auto found = sides_.find({q.place, p.place});
    if (found == sides_.end() || found->second.cell == c) return std::nullopt;
    const Corner &s = at(found->second.cell, found->second.loop, found->second.index + 1),
                 &t = at(found->second.cell, found->second.loop, found->second.index);
    const auto crosses = [](std::int64_t a, std::int64_t b) { return (a < 0 && b > 0) || (a > 0 && b < 0); };
    if (crosses(p.top - s.top, q.top - t.top) || crosses(p.under - s.under, q.under - t.under)) return std::nullopt;
    const std::int64_t at_p = std::min(p.top, s.top) - std::max(p.under, s.under),
                       at_q = std::min(q.top, t.top) - std::max(q.under, t.under);
    if (at_p < 0 || at_q < 0 || (at_p == 0 && at_q == 0)) return std::nullopt;
    return found->second.cell;
  }

  /// The faces of the cells as one body.
  std::vector<RawFace> faces(const std::vector<std::uint32_t>& members, const BodySurfaceKinds& looks) const {
    std::map<Grid2, std::set<std::int64_t>> heights;
    for (const std::uint32_t c : members)
      for (const auto& loop : cells_[c])
        for (const Corner& k : loop) heights[k.place].insert({k.under, k.top});
    std::vector<RawFace> out;
    const auto upright = [&](std::vector<Grid3>& loop, Grid2 place, std::int64_t from, std::int64_t to) {
      const auto& all = heights.at(place);
      loop.push_back({place.x, place.y, from});
      if (from < to)
        for (auto z = all.upper_bound(from); z != all.end() && *z < to; ++z) loop.push_back({place.x, place.y, *z});
      else
        for (auto z = std::make_reverse_iterator(all.lower_bound(from)); z != all.rend() && *z > to; ++z)
          loop.push_back({place.x, place.y, *z});
      if (from != to) loop.push_back({place.x, place.y, to});
    };
    const auto side = [&](SurfaceKind kind, Grid2 p, std::int64_t p_under, std::int64_t p_top, Grid2 q,
                          std::int64_t q_under, std::int64_t q_top) {
      if (p_under == p_top && q_under == q_top) return;
      std::vector<Grid3> loop;
      upright(loop, q, q_under, q_top);
      upright(loop, p, p_top, p_under);
      out.push_back({kind, {std::move(loop)}});
    };
    for (const std::uint32_t c : members) {
      RawFace top{looks.top, {}}, under{looks.under, {}};
      for (const auto& loop : cells_[c]) {
        std::vector<Grid3> above, below;
        for (const Corner& k : loop) {
          above.push_back({k.place.x, k.place.y, k.top});
          below.push_back({k.place.x, k.place.y, k.under});
        }
        std::reverse(below.begin(), below.end());
        top.loops.push_back(std::move(above));
        under.loops.push_back(std::move(below));
      }
      out.push_back(std::move(top));
      out.push_back(std::move(under));
      for (std::uint32_t l = 0; l < cells_[c].size(); ++l)
        for (std::uint32_t i = 0; i < cells_[c][l].size(); ++i) {
          const Corner &p = at(c, l, i), &q = at(c, l, i + 1);
          const SurfaceKind kind = p.against_building ? SurfaceKind::closure : looks.side;
          const auto other = members.size() > 1 ? joined_neighbour(c, l, i) : std::nullopt;
          if (!other) {
            side(kind, p.place, p.under, p.top, q.place, q.under, q.top);
            continue;
          }
          const SideOf& o = sides_.at({q.place, p.place});
          const Corner &s = at(o.cell, o.loop, o.index + 1), &t = at(o.cell, o.loop, o.index);
          if (p.under < s.under || q.under < t.under) side(kind, p.place, p.under, s.under, q.place, q.under, t.under);
          if (p.top > s.top || q.top > t.top) side(kind, p.place, s.top, p.top, q.place, t.top, q.top);
        }
    }
    return out;
  }

  /// Faces in one plane that share an edge, as one.
  static std::vector<RawFace> merged(const std::vector<RawFace>& faces) {
    std::vector<std::uint32_t> parent(faces.size());
    std::iota(parent.begin(), parent.end(), 0u);
    std::vector<std::array<double, 3>> normals;
    std::map<std::pair<Grid3, Grid3>, std::uint32_t> face_at;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      normals.push_back(normal_of(faces[f].loops));
      for (const auto& loop : faces[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i) face_at[{loop[i], loop[(i + 1) % loop.size()]}] = f;
    }
    const auto parallel = [&](std::uint32_t f, std::uint32_t g) {
      const auto &a = normals[f], &b = normals[g];
      const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      const double lengths = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
      constexpr double kSameDirection = 0.9998;  // squared cosine of 0.8 degrees; off_plane() has the last word
      return dot > 0 && dot * dot > kSameDirection * lengths;
    };
    for (const auto& [edge, f] : face_at) {
      const auto twin = face_at.find({edge.second, edge.first});
      if (twin == face_at.end() || faces[f].kind != faces[twin->second].kind || !parallel(f, twin->second)) continue;
      const std::uint32_t a = root(parent, f), b = root(parent, twin->second);
      if (a == b) continue;
      parent[std::max(a, b)] = std::min(a, b);
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
    for (std::uint32_t f = 0; f < faces.size(); ++f) groups[root(parent, f)].push_back(f);
    std::vector<RawFace> out;
    for (const auto& [first, members] : groups) {
      if (auto face = members.size() > 1 ? boundary(faces, members) : std::nullopt)
        out.push_back(std::move(*face));
      else
        for (const std::uint32_t f : members) out.push_back(faces[f]);
    }
    drop_straight_corners(out);
    return out;
  }

  /// What encloses several faces; empty when that touches itself or is not plane.
  static std::optional<RawFace> boundary(const std::vector<RawFace>& faces, const std::vector<std::uint32_t>& members) {
    std::set<std::pair<Grid3, Grid3>> edges;
    for (const std::uint32_t f : members)
      for (const auto& loop : faces[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const Grid3 a = loop[i], b = loop[(i + 1) % loop.size()];
          if (edges.erase({b, a}) == 0) edges.insert({a, b});
        }
    std::map<Grid3, Grid3> next;
    for (const auto& [a, b] : edges)
      if (!next.emplace(a, b).second) return std::nullopt;
    RawFace out{faces[members[0]].kind, {}};
    while (!next.empty()) {
      std::vector<Grid3> loop;
      const Grid3 start = next.begin()->first;
      for (Grid3 p = start;;) {
        const auto found = next.find(p);
        if (found == next.end()) return std::nullopt;
        loop.push_back(p);
        p = found->second;
        next.erase(found);
        if (p == start) break;
      }
      out.loops.push_back(std::move(loop));
    }
    const auto n = normal_of(out.loops);
    if (off_plane(out.loops, n) > kOnePlane) return std::nullopt;
    // The outer loop is the one that runs round the way of all together; there is one.
    std::size_t outer = out.loops.size();
    for (std::size_t l = 0; l < out.loops.size(); ++l) {
      const auto m = normal_of({out.loops[l]});
      if (m[0] * n[0] + m[1] * n[1] + m[2] * n[2] <= 0) continue;
      if (outer != out.loops.size()) return std::nullopt;
      outer = l;
    }
    if (outer == out.loops.size()) return std::nullopt;
    std::swap(out.loops[0], out.loops[outer]);
    return out;
  }

  /// Takes out corners that two faces have, both straight on.
  static void drop_straight_corners(std::vector<RawFace>& faces) {
    std::map<Grid3, int> uses, straight;
    const auto bends = [](Grid3 a, Grid3 b, Grid3 c) {
      const Point3 u = metres(b - a), v = metres(c - a);
      const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
      if (length == 0) return true;
      const double along = (u.x * v.x + u.y * v.y + u.z * v.z) / length;
      if (along <= 0 || along >= length) return true;
      const double off = std::sqrt(std::max(0.0, u.x * u.x + u.y * u.y + u.z * u.z - along * along));
      return off > kStraight;
    };
    for (const RawFace& face : faces)
      for (const auto& loop : face.loops)
        for (std::size_t i = 0, n = loop.size(); i < n; ++i) {
          ++uses[loop[i]];
          if (!bends(loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n])) ++straight[loop[i]];
        }
    std::set<Grid3> dropped;
    for (const auto& [p, count] : straight)
      if (count == 2 && uses.at(p) == 2) dropped.insert(p);
    for (RawFace& face : faces)
      for (auto& loop : face.loops)
        if (std::count_if(loop.begin(), loop.end(), [&](Grid3 p) { return !dropped.contains(p); }) >= 3)
          std::erase_if(loop, [&](Grid3 p) { return dropped.contains(p); });
  }

  static std::optional<model::Solid> checked(const std::vector<RawFace>& faces) {
    geometry::SolidBuilder builder;
    for (const RawFace& face : faces) {
      std::vector<std::vector<Point3>> loops;
      for (const auto& loop : face.loops) {
        loops.emplace_back();
        for (const Grid3 p : loop) loops.back().push_back(metres(p));
      }
      model::Face looks;
      looks.kind = face.kind;
      builder.add_face(loops, looks);
    }
    model::Solid solid = builder.take();
    const auto triangles = geometry::triangulate(solid);
    if (!triangles || !geometry::check_solid(solid, *triangles, geometry::kBuilt).valid()) return std::nullopt;
    return solid;
  }

  std::optional<model::Solid> body(const std::vector<std::uint32_t>& members, const BodySurfaceKinds& looks) const {
    for (const std::uint32_t c : members)
      if (cells_[c].empty()) return std::nullopt;
    const auto plain = faces(members, looks);
    if (auto solid = checked(merged(plain))) return solid;
    return checked(plain);
  }

  std::vector<Cell> cells_;
  std::map<Side, SideOf> sides_;
};

}  // namespace

CellBodies bodies_of_cells(std::span<const PlanCell> cells, const BodySurfaceKinds& looks) {
  return Assembly(cells).take(looks);
}

}  // namespace blockrand::roofs
