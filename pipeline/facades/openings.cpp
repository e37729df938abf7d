#include "pipeline/facades/openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <utility>

#include "pipeline/facades/opening_blocks.h"
#include "pipeline/facades/outlines.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/fold_test.h"
#include "pipeline/geometry/grid_side.h"
#include "pipeline/geometry/normal_deviation.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/vector.h"

namespace blockrand::facades {
namespace {

using model::Point2;
using model::Point3;

/// Margin to the sides of a reveal: less than what stays of the wall, so that the wall beside does not count.
constexpr double kSideMargin = kOpeningClearance / 2;
/// Off the plane through three of its corners, a tunnel's quadrangle is cut in two. Rounding alone costs half of it.
constexpr double kPlaneTunnel = 0.002;
/// m from the border of a wall within which openings make it fold.
constexpr double kNearBorder = 0.5;
/// Points of two portals that shall be at one height.
constexpr double kSameHeight = 0.01;

class Cutter {
 public:
  Cutter(const model::Solid& solid, std::span<const WallFrame> walls, std::span<const WallOpening> all)
      : walls_(walls), all_(all), obstacles_(solid), cut_(walls.size()) {}

  OpeningRefusal try_opening(std::uint32_t index) {
    const WallOpening& o = all_[index];
    if (const auto bad = in_wall(o); bad != OpeningRefusal::none) return bad;
    if (o.kind != model::OpeningKind::passage) {
      const Block block = reveal_block(o);
      if (!block.valid() || obstacles_.blocked(block, walls_[o.wall].face, walls_[o.wall].face))
        return OpeningRefusal::wall_too_thin;
      return take(block, {index});
    }
    if (o.through >= all_.size()) return OpeningRefusal::passage_blocked;
    const WallOpening& other = all_[o.through];
    if (other.kind != o.kind || other.through != index || other.wall == o.wall ||
        other.outline.size() != o.outline.size())
      return OpeningRefusal::passage_blocked;
    if (const auto bad = in_wall(other); bad != OpeningRefusal::none) return bad;
    const std::optional<Block> tunnel = tunnel_block(o, other);
    for (const WallOpening* portal : {&o, &other}) {
      const Block before = reveal_block(*portal);
      if (!before.valid() || obstacles_.blocked(before, walls_[o.wall].face, walls_[other.wall].face))
        return OpeningRefusal::passage_blocked;
    }
    if (!tunnel || obstacles_.blocked(*tunnel, walls_[o.wall].face, walls_[other.wall].face) || !partners(o, other))
      return OpeningRefusal::passage_blocked;
    return take(*tunnel, {index, o.through});
  }

  /// For each point of the first portal the matching one of the second.
  std::optional<std::vector<std::size_t>> partners(const WallOpening& a, const WallOpening& b) const {
    const std::size_t n = a.outline.size();
    std::optional<std::vector<std::size_t>> best;
    double least = 0;
    for (std::size_t k = 0; k < n; ++k) {
      std::vector<std::size_t> match(n);
      double sum = 0;
      bool fits = true;
      for (std::size_t i = 0; i < n && fits; ++i) {
        match[i] = (k + n - i) % n;
        const Point3 p = walls_[a.wall].at(a.outline[i]), q = walls_[b.wall].at(b.outline[match[i]]);
        fits = std::fabs(p.z - q.z) <= kSameHeight;
        sum += distance(p.xy(), q.xy());
      }
      if (fits && (!best || sum < least)) {
        best = std::move(match);
        least = sum;
      }
    }
    return best;
  }

 private:
  OpeningRefusal take(const Block& block, std::initializer_list<std::uint32_t> openings) {
    if (block_cells_.any_near(block.box, block.low, block.high, 0,
                              [&](std::uint32_t b) { return blocks_[b].meets(block); }))
      return OpeningRefusal::meets_opening;
    block_cells_.add(block.box, block.low, block.high, static_cast<std::uint32_t>(blocks_.size()));
    blocks_.push_back(block);
    for (const std::uint32_t o : openings) cut_[all_[o].wall].add(box_of(all_[o].outline), 0, 0, o);
    return OpeningRefusal::none;
  }

  OpeningRefusal in_wall(const WallOpening& o) const {
    if (o.wall >= walls_.size() || o.outline.size() < 3 || !(o.reveal >= 0)) return OpeningRefusal::bad_outline;
    for (const Point2& p : o.outline)
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) return OpeningRefusal::bad_outline;
    const Box2 box = box_of(o.outline);
    if (!(box.right - box.left >= kLeastOpening && box.high - box.low >= kLeastOpening))
      return OpeningRefusal::bad_outline;
    if (!(geometry::signed_area(o.outline) > 0) || !is_simple_by(kLeastFeature, o.outline))
      return OpeningRefusal::bad_outline;
    const WallFrame& wall = walls_[o.wall];
    for (std::size_t l = 0; l < wall.loops.size(); ++l) {
      if (rings_nearer_than(kOpeningClearance, o.outline, box, wall.loops[l])) return OpeningRefusal::beyond_wall;
      if (surely_inside(wall.loops[l], o.outline[0]) != (l == 0)) return OpeningRefusal::beyond_wall;
      // A hole of the wall inside the opening.
      if (l > 0 && surely_inside(o.outline, wall.loops[l][0])) return OpeningRefusal::beyond_wall;
    }
    const auto meets = [&](std::uint32_t cut) {
      const auto& other = all_[cut].outline;
      if (box_of(other).apart(box, kOpeningClearance)) return false;
      return rings_nearer_than(kOpeningClearance, o.outline, box, other) || surely_inside(other, o.outline[0]) ||
             surely_inside(o.outline, other[0]);
    };
    return cut_[o.wall].any_near(box, 0, 0, 2 * kOpeningClearance, meets) ? OpeningRefusal::meets_opening
                                                                          : OpeningRefusal::none;
  }

  /// From a little before the wall to behind the reveal: an opening that looks into a slit would meet the wall across.
  Block reveal_block(const WallOpening& o) const {
    const WallFrame& wall = walls_[o.wall];
    const Box2 box = box_of(o.outline);
    const double front = -kOpeningClearance, depth = o.reveal + kLeastBehind;
    const double left = box.left - kSideMargin, right = box.right + kSideMargin;
    const auto at = [&](double u, double d) { return wall.at({u, 0}, d).xy(); };
    return {{at(left, depth), at(left, front), at(right, front), at(right, depth)},
            wall.base + box.low - kSideMargin,
            wall.base + box.high + kSideMargin};
  }

  std::optional<Block> tunnel_block(const WallOpening& a, const WallOpening& b) const {
    const WallFrame &from = walls_[a.wall], &to = walls_[b.wall];
    const Box2 near = box_of(a.outline), far = box_of(b.outline);
    const auto at = [](const WallFrame& wall, double u) { return wall.at({u, 0}).xy(); };
    // Seen along the tunnel both portals must be wide enough: its sides then never cross.
    const Point2 a0 = at(from, near.left), a1 = at(from, near.right), b0 = at(to, far.right), b1 = at(to, far.left);
    const double ax = (b0.x + b1.x - a0.x - a1.x) / 2, ay = (b0.y + b1.y - a0.y - a1.y) / 2,
                 length = std::sqrt(ax * ax + ay * ay);
    const auto across = [&](Point2 p, Point2 q) { return ((q.x - p.x) * -ay + (q.y - p.y) * ax) / -length; };
    if (!(across(a0, a1) >= kLeastPassage && across(b0, b1) >= kLeastPassage)) return std::nullopt;
    const Block block{{at(to, far.right + kSideMargin), at(from, near.left - kSideMargin),
                       at(from, near.right + kSideMargin), at(to, far.left - kSideMargin)},
                      from.base + near.low - kSideMargin,
                      from.base + near.high + kSideMargin};
    if (!block.valid()) return std::nullopt;
    return block;
  }

  std::span<const WallFrame> walls_;
  std::span<const WallOpening> all_;
  Obstacles obstacles_;
  std::vector<Block> blocks_;
  GrowingCells block_cells_;
  std::vector<GrowingCells> cut_;  ///< by wall
};

/// Puts the solid together anew, loop by loop: walls get more loops than they had.
class Assembly {
 public:
  Assembly(const model::Solid& solid, std::span<const WallFrame> walls, CornerRounding rounding)
      : solid_(solid), walls_(walls), rounding_(rounding), holes_(solid.faces.size()) {
    out_.vertices = solid.vertices;
  }

  std::vector<std::uint32_t> add_points(const WallFrame& wall, std::span<const Point2> outline) {
    std::vector<std::uint32_t> at;
    for (const Point2& p : outline) at.push_back(add(on_grid(wall, p)));
    return at;
  }
  Point3 on_grid(const WallFrame& wall, Point2 p) const {
    Point3 out = model::snap(wall.at(p));
    if (rounding_ == CornerRounding::nearest) return out;
    const Point2 behind =
        geometry::grid_point_on_left(wall.at(p).xy(), wall.start, model::snap(wall.at({wall.length, 0})).xy());
    return {behind.x, behind.y, out.z};
  }
  std::uint32_t add(Point3 p) {
    out_.vertices.push_back(p);
    return static_cast<std::uint32_t>(out_.vertices.size()) - 1;
  }
  /// \param ring  as the opening's outline runs: counter-clockwise seen from outside
  void add_hole(std::uint32_t face, std::vector<std::uint32_t> ring) {
    std::reverse(ring.begin(), ring.end());
    holes_[face].push_back(std::move(ring));
  }
  std::uint32_t add_face(std::vector<std::uint32_t> ring, model::Face looks) {
    added_.push_back({std::move(ring), looks});
    return static_cast<std::uint32_t>(solid_.faces.size() + added_.size()) - 1;
  }
  const Point3& point(std::uint32_t i) const { return out_.vertices[i]; }
  const model::Face& face(std::uint32_t wall) const { return solid_.faces[walls_[wall].face]; }

  /// Writes the solid, and what is known of its faces.
  void take(OpenedSolid& out) {
    std::vector<bool> unfolded(solid_.faces.size(), false);
    std::vector<std::vector<geometry::Triangle>> triangles(solid_.faces.size());
    out.first_border_point = static_cast<std::uint32_t>(out_.vertices.size());
    for (std::uint32_t f = 0; f < solid_.faces.size(); ++f) {
      if (holes_[f].empty()) continue;
      unfolded[f] = !folds(f, triangles[f]);
      if (!unfolded[f]) add_feet(f);
    }
    for (std::uint32_t f = 0; f < solid_.faces.size(); ++f) {
      model::Face face = solid_.faces[f];
      const auto loops = solid_.loops_of(face);
      face.first_loop = static_cast<std::uint32_t>(out_.loops.size());
      bool changed = false;
      for (const auto& loop : loops) changed = add_loop(solid_.indices_of(loop)) || changed;
      for (const auto& hole : holes_[f]) add_loop(hole);
      face.loop_count = static_cast<std::uint32_t>(out_.loops.size()) - face.first_loop;
      out_.faces.push_back(face);
      if (changed) {
        out.changed_borders.push_back(f);
        continue;
      }
      if (unfolded[f]) out.unfolded.push_back(f);
      if (!triangles[f].empty()) out.triangles.emplace_back(f, std::move(triangles[f]));
    }
    for (const auto& [ring, looks] : added_) {
      model::Face face = looks;
      face.first_loop = static_cast<std::uint32_t>(out_.loops.size());
      face.loop_count = 1;
      add_loop(ring);
      out_.faces.push_back(face);
    }
    out.solid = std::move(out_);
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< the smaller index first

  /// \return whether it got points
  bool add_loop(std::span<const std::uint32_t> ring) {
    const auto first = static_cast<std::uint32_t>(out_.indices.size());
    bool changed = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::uint32_t from = ring[i], to = ring[i + 1 == ring.size() ? 0 : i + 1];
      out_.indices.push_back(from);
      if (feet_.empty()) continue;
      const auto feet = feet_.find(std::minmax(from, to));
      if (feet == feet_.end()) continue;
      changed = changed || !feet->second.empty();
      if (from < to)
        out_.indices.insert(out_.indices.end(), feet->second.begin(), feet->second.end());
      else
        out_.indices.insert(out_.indices.end(), feet->second.rbegin(), feet->second.rend());
    }
    out_.loops.push_back({first, static_cast<std::uint32_t>(out_.indices.size()) - first});
    return changed;
  }

  /// \param triangles  gets those of the wall, where it has some
  bool folds(std::uint32_t face, std::vector<geometry::Triangle>& triangles) const {
    std::vector<std::vector<Point3>> rings;
    std::vector<Point3> points;
    std::vector<geometry::Grid3> grid;
    std::vector<std::uint32_t> number;
    std::vector<std::vector<std::uint32_t>> loops;
    const auto add_ring = [&](std::span<const std::uint32_t> ring) {
      auto& of_ring = rings.emplace_back();
      auto& loop = loops.emplace_back();
      for (const std::uint32_t i : ring) {
        loop.push_back(static_cast<std::uint32_t>(points.size()));
        number.push_back(i);
        of_ring.push_back(out_.vertices[i]);
        points.push_back(out_.vertices[i]);
        grid.push_back(geometry::to_grid(out_.vertices[i]));
      }
    };
    for (const auto& loop : solid_.loops_of(solid_.faces[face])) add_ring(solid_.indices_of(loop));
    for (const auto& hole : holes_[face]) add_ring(hole);
    if (auto made = geometry::triangulate(std::span<const geometry::Grid3>(grid), loops)) {
      const auto sure = geometry::surely_folds(points, *made, geometry::kBuilt.normal_deviation);
      for (geometry::Triangle& t : *made)
        for (std::uint32_t& i : t) i = number[i];
      triangles = std::move(*made);
      if (sure) return *sure;
    }
    const auto found = geometry::normal_deviation(rings);
    return found && found->angle > geometry::kBuilt.normal_deviation;
  }

  /// Between openings and the border of a wall, at thresholds above all, stay strips of a few centimetres. Triangles as
  /// long as the wall fold there by what rounding moves a corner; points on the border next to the corners of openings
  /// keep them short.
  void add_feet(std::uint32_t face) {
    for (const auto& loop : solid_.loops_of(solid_.faces[face])) {
      const auto ring = solid_.indices_of(loop);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Edge edge = std::minmax(ring[i], ring[(i + 1) % ring.size()]);
        const Point3 a = out_.vertices[edge.first], b = out_.vertices[edge.second];
        const bool level = a.z == b.z, upright = a.x == b.x && a.y == b.y;
        if (level == upright || feet_.count(edge)) continue;
        const Point3 way{b.x - a.x, b.y - a.y, b.z - a.z};
        const double length = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
        std::vector<std::pair<double, Point3>> feet;
        for (const auto& hole : holes_[face])
          for (const std::uint32_t k : hole) {
            const Point3 p = out_.vertices[k];
            const double along = ((p.x - a.x) * way.x + (p.y - a.y) * way.y + (p.z - a.z) * way.z) / length;
            const double off = level ? std::fabs(p.z - a.z) : distance(p.xy(), a.xy());
            if (along > kOpeningClearance / 2 && along < length - kOpeningClearance / 2 && off <= kNearBorder)
              feet.emplace_back(along, level ? Point3{p.x, p.y, a.z} : Point3{a.x, a.y, p.z});
          }
        std::sort(feet.begin(), feet.end());
        double last = 0;
        for (const auto& [along, at] : feet) {
          if (along - last < kOpeningClearance / 2) continue;
          feet_[edge].push_back(add(at));
          last = along;
        }
      }
    }
  }

  const model::Solid& solid_;
  std::span<const WallFrame> walls_;
  CornerRounding rounding_;
  model::Solid out_;
  std::vector<std::vector<std::vector<std::uint32_t>>> holes_;
  std::vector<std::pair<std::vector<std::uint32_t>, model::Face>> added_;
  std::map<Edge, std::vector<std::uint32_t>> feet_;  ///< points put on an edge, from its first end on
};

/// m that `d` lies off the plane of the other three.
double off_plane(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  return length > 0 ? std::fabs(nx * (d.x - a.x) + ny * (d.y - a.y) + nz * (d.z - a.z)) / length : 0;
}

model::SurfaceKind tunnel_kind(const Point3& a, const Point3& b, const Point3& c) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  // Steeper than 45 degrees is a side.
  if (nz * nz <= nx * nx + ny * ny) return model::SurfaceKind::wall;
  return nz > 0 ? model::SurfaceKind::outer_floor : model::SurfaceKind::outer_ceiling;
}

}  // namespace

OpenedSolid cut_openings(const model::Solid& solid, std::span<const WallFrame> walls,
                         std::span<const WallOpening> openings, CornerRounding rounding) {
  OpenedSolid out;
  Cutter cutter(solid, walls, openings);
  Assembly assembly(solid, walls, rounding);
  out.refusals.assign(openings.size(), OpeningRefusal::none);
  for (std::uint32_t i = 0; i < openings.size(); ++i) {
    const WallOpening& o = openings[i];
    const bool passage = o.kind == model::OpeningKind::passage;
    // The second portal of a passage shares the first one's fate.
    if (passage && o.through < i && openings[o.through].through == i && openings[o.through].kind == o.kind) {
      out.refusals[i] = out.refusals[o.through];
      continue;
    }
    out.refusals[i] = cutter.try_opening(i);
    if (out.refusals[i] != OpeningRefusal::none) continue;
    const WallFrame& wall = walls[o.wall];
    model::Face looks = assembly.face(o.wall);
    model::Opening opening;
    opening.kind = o.kind;
    opening.wall = wall.face;
    opening.storey = o.storey;
    const std::vector<std::uint32_t> portal = assembly.add_points(wall, o.outline);
    const std::size_t n = portal.size();
    assembly.add_hole(wall.face, portal);
    if (!passage) {
      std::vector<std::uint32_t> end = portal;
      if (o.reveal >= kLeastReveal) {
        const Point2 outward = wall.outward();
        const Point2 in = model::snap(Point2{-outward.x * o.reveal, -outward.y * o.reveal});
        for (std::size_t k = 0; k < n; ++k) {
          const Point3 p = assembly.point(portal[k]);
          end[k] = assembly.add({p.x + in.x, p.y + in.y, p.z});
        }
        looks.kind = model::SurfaceKind::wall;
        for (std::size_t k = 0; k < n; ++k) {
          const std::size_t next = (k + 1) % n;
          const std::uint32_t face = assembly.add_face({portal[k], portal[next], end[next], end[k]}, looks);
          if (k == 0) opening.first_reveal = face;
        }
        opening.reveal_count = static_cast<std::uint32_t>(n);
      }
      looks.kind = o.kind == model::OpeningKind::window ? model::SurfaceKind::window : model::SurfaceKind::door;
      opening.polygon = assembly.add_face(end, looks);
      out.openings.push_back(opening);
      out.given.push_back(i);
      continue;
    }
    const WallOpening& other = openings[o.through];
    const WallFrame& far_wall = walls[other.wall];
    const auto match = cutter.partners(o, other);
    std::vector<std::uint32_t> end(n), far_ring(n);
    for (std::size_t k = 0; k < n; ++k) {
      Point3 p = assembly.on_grid(far_wall, other.outline[(*match)[k]]);
      p.z = assembly.point(portal[k]).z;  // one level, to the last bit
      end[k] = assembly.add(p);
      far_ring[(*match)[k]] = end[k];
    }
    assembly.add_hole(far_wall.face, far_ring);
    opening.polygon = far_wall.face;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = (k + 1) % n;
      const std::uint32_t a = portal[k], b = portal[next], c = end[next], d = end[k];
      looks.kind = tunnel_kind(assembly.point(a), assembly.point(b), assembly.point(c));
      std::uint32_t face = 0;
      if (off_plane(assembly.point(a), assembly.point(b), assembly.point(c), assembly.point(d)) <= kPlaneTunnel) {
        face = assembly.add_face({a, b, c, d}, looks);
        ++opening.reveal_count;
      } else {
        face = assembly.add_face({a, b, c}, looks);
        assembly.add_face({a, c, d}, looks);
        opening.reveal_count += 2;
      }
      if (k == 0) opening.first_reveal = face;
    }
    out.openings.push_back(opening);
    out.given.push_back(i);
    model::Opening second = opening;
    second.wall = far_wall.face;
    second.polygon = wall.face;
    second.reveal_count = 0;
    second.storey = other.storey;
    out.openings.push_back(second);
    out.given.push_back(o.through);
  }
  assembly.take(out);
  return out;
}

}  // namespace blockrand::facades
