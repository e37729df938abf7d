#include "pipeline/facades/opening_proof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/fold_test.h"
#include "pipeline/geometry/grid.h"

namespace blockrand::facades {
namespace {

using geometry::Grid2;
using geometry::Grid3;
using model::Point3;
using Triangle = std::array<std::uint32_t, 3>;

/// m across a wall that its corners may take up: more than rounding costs.
constexpr double kThickest = 4 / model::kGridStepsPerMetre;
/// Cosine of the angle between a reveal's direction and the wall's normal: rounding turns reveals of a centimetre by 4
/// degrees.
constexpr double kNearlyAcross = 0.9;

/// A direction of the plan in grid steps, into the building.
using Inward = std::array<std::int64_t, 2>;

/// A face that is not what it was: a wall with openings, or a face with points on its border.
struct ChangedFace {
  std::uint32_t face = 0;
  Point3 origin;
  double nx = 0, ny = 0, nz = 0;  ///< unit normal
  double low = 0, high = 0;       ///< m along the normal, of all its corners
  Grid3 least, most;
  std::vector<Inward> views;  ///< none where it has no openings
  double along_normal(const Point3& p) const {
    return (p.x - origin.x) * nx + (p.y - origin.y) * ny + (p.z - origin.z) * nz;
  }
};

class Proof {
 public:
  Proof(const OpenedSolid& opened, const model::SolidTriangles& triangles)
      : opened_(opened), solid_(opened.solid), triangles_(triangles) {}

  bool holds(bool passages_checked) {
    for (const model::Opening& o : opened_.openings)
      if (is_passage(o) && !passages_checked) return false;
    if (triangles_.first.size() != solid_.faces.size() + 1) return false;
    grid_.resize(solid_.vertices.size());
    for (std::size_t i = 0; i < grid_.size(); ++i) grid_[i] = geometry::to_grid(solid_.vertices[i]);
    if (doubled_border_point()) return false;
    changed_of_.assign(solid_.faces.size(), kNone);
    is_new_.assign(solid_.faces.size(), false);
    for (const model::Opening& o : opened_.openings) {
      if (!is_passage(o)) {
        is_new_[o.polygon] = true;
        for (std::uint32_t r = 0; r < o.reveal_count; ++r) is_new_[o.first_reveal + r] = true;
      }
      if (changed_of_[o.wall] != kNone) continue;
      if (!add_changed(o.wall) || !is_thin_wall(changed_.back())) return false;
      if (!std::binary_search(opened_.changed_borders.begin(), opened_.changed_borders.end(), o.wall) &&
          !std::binary_search(opened_.unfolded.begin(), opened_.unfolded.end(), o.wall) &&
          geometry::folds_more_than(solid_, solid_.faces[o.wall], triangles_of(o.wall),
                                    geometry::kBuilt.normal_deviation))
        return false;
    }
    for (const std::uint32_t f : opened_.changed_borders) {
      if (!geometry::sound_polygon(solid_, f, triangles_of(f), grid_, geometry::kBuilt)) return false;
      if (changed_of_[f] == kNone && !add_changed(f)) return false;
    }
    for (const model::Opening& o : opened_.openings) {
      if (is_passage(o)) continue;
      ChangedFace& wall = changed_[changed_of_[o.wall]];
      const auto in = inward(o, wall);
      if (!in || !turns_left(o.polygon, *in)) return false;
      if (std::find(wall.views.begin(), wall.views.end(), *in) == wall.views.end()) wall.views.push_back(*in);
    }
    for (const ChangedFace& wall : changed_)
      for (const Inward& in : wall.views)
        if (!turns_left(wall.face, in)) return false;
    index_others();
    for (const ChangedFace& face : changed_)
      if (meets_others(face)) return false;
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  static bool is_passage(const model::Opening& o) { return o.kind == model::OpeningKind::passage; }

  std::span<const Triangle> triangles_of(std::uint32_t face) const {
    return std::span(triangles_.triangles)
        .subspan(triangles_.first[face], triangles_.first[face + 1] - triangles_.first[face]);
  }

  /// Whether a point on a border lies where another vertex is.
  bool doubled_border_point() const {
    if (opened_.changed_borders.empty()) return false;
    std::vector<Grid3> added(grid_.begin() + opened_.first_border_point, grid_.end());
    std::sort(added.begin(), added.end());
    if (std::adjacent_find(added.begin(), added.end()) != added.end()) return true;
    return std::any_of(grid_.begin(), grid_.begin() + opened_.first_border_point,
                       [&](const Grid3& p) { return std::binary_search(added.begin(), added.end(), p); });
  }

  static bool is_thin_wall(const ChangedFace& wall) {
    return std::fabs(wall.nz) <= kMostLean * std::sqrt(wall.nx * wall.nx + wall.ny * wall.ny) &&
           wall.high - wall.low <= kThickest;
  }

  /// \return false where it has no area
  bool add_changed(std::uint32_t face) {
    ChangedFace wall;
    wall.face = face;
    const auto loops = solid_.loops_of(solid_.faces[face]);
    const auto outer = solid_.indices_of(loops[0]);
    wall.origin = solid_.vertices[outer[0]];
    wall.least = wall.most = grid_[outer[0]];
    for (std::size_t i = 0; i < outer.size(); ++i) {
      const Point3& p = solid_.vertices[outer[i]];
      const Point3& q = solid_.vertices[outer[i + 1 == outer.size() ? 0 : i + 1]];
      const double px = p.x - wall.origin.x, py = p.y - wall.origin.y, pz = p.z - wall.origin.z;
      const double qx = q.x - wall.origin.x, qy = q.y - wall.origin.y, qz = q.z - wall.origin.z;
      wall.nx += py * qz - pz * qy;
      wall.ny += pz * qx - px * qz;
      wall.nz += px * qy - py * qx;
      const Grid3& g = grid_[outer[i]];
      wall.least = {std::min(wall.least.x, g.x), std::min(wall.least.y, g.y), std::min(wall.least.z, g.z)};
      wall.most = {std::max(wall.most.x, g.x), std::max(wall.most.y, g.y), std::max(wall.most.z, g.z)};
    }
    const double size = std::sqrt(wall.nx * wall.nx + wall.ny * wall.ny + wall.nz * wall.nz);
    if (!(size > 0)) return false;
    wall.nx /= size;
    wall.ny /= size;
    wall.nz /= size;
    for (const auto& loop : loops)
      for (const std::uint32_t i : solid_.indices_of(loop)) {
        const double h = wall.along_normal(solid_.vertices[i]);
        wall.low = std::min(wall.low, h);
        wall.high = std::max(wall.high, h);
      }
    changed_of_[face] = static_cast<std::uint32_t>(changed_.size());
    changed_.push_back(std::move(wall));
    return true;
  }

  /// Which way the reveal goes; of flush openings the axis nearest to it.
  std::optional<Inward> inward(const model::Opening& o, const ChangedFace& wall) const {
    if (o.reveal_count == 0) {
      if (std::fabs(wall.nx) >= std::fabs(wall.ny)) return Inward{wall.nx > 0 ? -1 : 1, 0};
      return Inward{0, wall.ny > 0 ? -1 : 1};
    }
    const auto ring = solid_.indices_of(solid_.loops_of(solid_.faces[o.first_reveal])[0]);
    if (ring.size() != 4) return std::nullopt;
    const Grid3 in = grid_[ring[3]] - grid_[ring[0]];
    const double x = static_cast<double>(in.x), y = static_cast<double>(in.y), across = -(wall.nx * x + wall.ny * y);
    if (in.z != 0 || across * across < kNearlyAcross * kNearlyAcross * (x * x + y * y) || across <= 0)
      return std::nullopt;
    return Inward{in.x, in.y};
  }

  /// All triangles of a face are counter-clockwise, seen from outside along `in`.
  bool turns_left(std::uint32_t face, const Inward& in) const {
    const auto triangles = triangles_of(face);
    if (triangles.empty()) return false;
    const Grid3 o = grid_[triangles[0][0]];
    const auto seen = [&](std::uint32_t i) {
      const Grid3 p = grid_[i] - o;
      return Grid2{p.x * in[1] - p.y * in[0], p.z};
    };
    return std::all_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
      return geometry::orientation(seen(t[0]), seen(t[1]), seen(t[2])) > 0;
    });
  }

  /// The box around something.
  struct Span {
    Grid3 least, most;
    bool apart(const Span& other) const {
      return most.x < other.least.x || least.x > other.most.x || most.y < other.least.y || least.y > other.most.y ||
             most.z < other.least.z || least.z > other.most.z;
    }
  };
  Span span_of(const Triangle& t) const {
    const Grid3 &a = grid_[t[0]], &b = grid_[t[1]], &c = grid_[t[2]];
    return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
            {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}};
  }

  /// Triangles of all faces but reveals and openings: a block with thousands of courts has walls everywhere.
  void index_others() {
    std::vector<geometry::PlanBox> boxes;
    for (std::uint32_t f = 0; f < solid_.faces.size(); ++f) {
      if (is_new_[f]) continue;
      for (const Triangle& t : triangles_of(f)) {
        geometry::PlanBox box;
        for (const std::uint32_t i : t) box.include(solid_.vertices[i].xy());
        boxes.push_back(box);
        others_.push_back({t, f});
      }
    }
    // Houses have few faces: looking at each is faster than an index of them.
    if (boxes.size() * changed_.size() > kMostPairs)
      index_ = geometry::BoxIndex(std::move(boxes));
    else
      boxes_ = std::move(boxes);
  }

  /// Calls `visit` with the numbers in others_ whose boxes come near.
  template <class Visit>
  void for_each_near(const geometry::PlanBox& box, Visit&& visit) const {
    for (std::uint32_t n = 0; n < boxes_.size(); ++n)
      if (boxes_[n].near(box, kSure)) visit(n);
    if (boxes_.empty())
      for (const std::uint32_t n : index_.near(box, kSure)) visit(n);
  }

  /// Whether a triangle of a changed face conflicts with one of another face that is no reveal.
  bool meets_others(const ChangedFace& wall) {
    near_.clear();
    geometry::PlanBox box;
    for (const std::uint32_t i : solid_.indices_of(solid_.loops_of(solid_.faces[wall.face])[0]))
      box.include(solid_.vertices[i].xy());
    for_each_near(box, [&](std::uint32_t n) {
      const auto& [t, f] = others_[n];
      if (f == wall.face || (changed_of_[f] != kNone && f < wall.face)) return;
      const Span span = span_of(t);
      if (span.apart({wall.least, wall.most})) return;
      int before = 0, behind = 0;
      for (const std::uint32_t i : t) {
        const double h = wall.along_normal(solid_.vertices[i]);
        before += h > wall.high + kSure;
        behind += h < wall.low - kSure;
      }
      if (before < 3 && behind < 3) near_.push_back({t, span});
    });
    for (const Triangle& mine : triangles_of(wall.face)) {
      const Span span = span_of(mine);
      for (const auto& [t, of_other] : near_)
        if (!span.apart(of_other) && geometry::triangles_conflict(grid_, mine, t)) return true;
    }
    return false;
  }

  /// Boxes looked at without an index: below this a tree costs more than it saves.
  static constexpr std::size_t kMostPairs = 20000;
  /// m; more than doubles are wrong by.
  static constexpr double kSure = 1e-6;

  const OpenedSolid& opened_;
  const model::Solid& solid_;
  const model::SolidTriangles& triangles_;
  std::vector<Grid3> grid_;
  std::vector<ChangedFace> changed_;
  std::vector<std::uint32_t> changed_of_;                   ///< by face: into changed_
  std::vector<bool> is_new_;                                ///< by face: a reveal, or an opening's polygon
  std::vector<std::pair<Triangle, std::uint32_t>> others_;  ///< with their faces
  geometry::BoxIndex index_;                                ///< of others_
  std::vector<geometry::PlanBox> boxes_;                    ///< the same boxes, where there is no index
  std::vector<std::pair<Triangle, Span>> near_;
};

}  // namespace

bool proved_valid(const OpenedSolid& opened, const model::SolidTriangles& triangles, bool passages_checked) {
  return Proof(opened, triangles).holds(passages_checked);
}

}  // namespace blockrand::facades
