#include "pipeline/geometry/fold_test.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "pipeline/geometry/fitted_frame.h"
#include "pipeline/geometry/normal_deviation.h"

namespace blockrand::geometry {

namespace {

using model::Point3;
using Vector = Eigen::Vector3d;
using Corners = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kBorder = 0xffffffff;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon() / 2;
/// Shewchuk 1997, "Adaptive precision floating-point arithmetic": bounds of the error of the two tests below, as a share of
/// the sums of their terms' sizes.
constexpr double kTurnError = (3 + 16 * kEpsilon) * kEpsilon, kCircleError = (10 + 96 * kEpsilon) * kEpsilon;

/// Points on one circle whose triangles are all looked at: pairs of rows of windows in the middle of a wall.
constexpr std::size_t kMostOnCircle = 16;

struct Flat {
  double x = 0, y = 0;
};

/// True where the three run counter-clockwise for sure.
bool surely_left(Flat a, Flat b, Flat c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  return left - right > kTurnError * (std::fabs(left) + std::fabs(right));
}

/// Whether d lies in the circle through a, b, c (counter-clockwise): 1 inside, -1 outside, 0 unknown.
int in_circle(Flat a, Flat b, Flat c, Flat d) {
  const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
  const double bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy, ab = ax * by, ba = bx * ay;
  const double la = ax * ax + ay * ay, lb = bx * bx + by * by, lc = cx * cx + cy * cy;
  const double value = la * (bc - cb) + lb * (ca - ac) + lc * (ab - ba);
  const double bound = kCircleError * ((std::fabs(bc) + std::fabs(cb)) * la + (std::fabs(ca) + std::fabs(ac)) * lb +
                                       (std::fabs(ab) + std::fabs(ba)) * lc);
  return value > bound ? 1 : value < -bound ? -1 : 0;
}

/// Triangles that know their neighbours, by half-edges 3 t + i from corner i to corner i + 1 of triangle t.
class FlippedTriangles {
 public:
  FlippedTriangles(std::span<const Point3> points, std::span<const Corners> triangles)
      : points_(points), triangles_(triangles.begin(), triangles.end()), twins_(3 * triangles.size(), kBorder) {}

  const std::vector<Corners>& triangles() const { return triangles_; }

  /// \return false where doubles cannot tell
  bool become_delaunay(const Frame& frame) {
    flat_.reserve(points_.size());
    for (const Point3& p : points_) {
      const Vector d = between(frame.origin, p);
      flat_.push_back({d.dot(frame.right), d.dot(frame.up)});
    }
    // Seen from behind, the same circles hold them.
    const bool behind = !triangles_.empty() && !surely_left(flat(0, 0), flat(0, 1), flat(0, 2));
    if (behind)
      for (Flat& p : flat_) p.x = -p.x;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (!surely_left(flat(t, 0), flat(t, 1), flat(t, 2))) return false;
    if (!find_twins()) return false;
    std::vector<std::uint32_t> open;
    for (std::uint32_t h = 0; h < twins_.size(); ++h)
      if (twins_[h] != kBorder && h < twins_[h]) open.push_back(h);
    std::size_t left = 100 * twins_.size() + 1000;  // far more flips than walls need
    while (!open.empty()) {
      const std::uint32_t h = open.back();
      open.pop_back();
      if (twins_[h] == kBorder) continue;
      if (left-- == 0) return false;
      const std::uint32_t a = corner(h), b = corner(next(h)), c = corner(before(h)), d = corner(before(twins_[h]));
      const int inside = in_circle(flat_[a], flat_[b], flat_[c], flat_[d]);
      if (inside <= 0) continue;
      flip(h);
      const std::uint32_t t = h / 3, s = twins_[diagonal_] / 3;
      for (std::uint32_t i = 0; i < 3; ++i)
        for (const std::uint32_t e : {3 * t + i, 3 * s + i})
          if (e != diagonal_ && e != twins_[diagonal_]) open.push_back(e);
    }
    return true;
  }

  /// Corners that lie on one circle as far as doubles can tell, four at least in each set: windows in the middle of a
  /// wall, piers between windows. Any triangulation of such a set is Delaunay.
  std::vector<std::vector<std::uint32_t>> circles() const {
    std::vector<std::uint32_t> parent(triangles_.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t t) {
      while (parent[t] != t) t = parent[t] = parent[parent[t]];
      return t;
    };
    bool any = false;
    for (std::uint32_t h = 0; h < twins_.size(); ++h) {
      if (twins_[h] == kBorder || twins_[h] < h) continue;
      const std::uint32_t a = corner(h), b = corner(next(h)), c = corner(before(h)), d = corner(before(twins_[h]));
      if (in_circle(flat_[a], flat_[b], flat_[c], flat_[d]) != 0) continue;
      parent[root(h / 3)] = root(twins_[h] / 3);
      any = true;
    }
    std::vector<std::vector<std::uint32_t>> out;
    if (!any) return out;
    std::vector<std::vector<std::uint32_t>> of_root(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      of_root[root(t)].insert(of_root[root(t)].end(), triangles_[t].begin(), triangles_[t].end());
    for (auto& corners : of_root) {
      if (corners.size() <= 3) continue;
      std::sort(corners.begin(), corners.end());
      corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
      out.push_back(std::move(corners));
    }
    return out;
  }

 private:
  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t before(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  std::uint32_t corner(std::uint32_t h) const { return triangles_[h / 3][h % 3]; }
  Flat flat(std::uint32_t t, std::uint32_t i) const { return flat_[triangles_[t][i]]; }
  void join(std::uint32_t h, std::uint32_t twin) {
    twins_[h] = twin;
    if (twin != kBorder) twins_[twin] = h;
  }

  /// \return false where an edge has more than two sides
  bool find_twins() {
    // Half-edges by their lower corner, as many as each has.
    std::vector<std::uint32_t> first(points_.size() + 1, 0), of_low(twins_.size());
    const auto low = [&](std::uint32_t h) { return std::min(corner(h), corner(next(h))); };
    const auto high = [&](std::uint32_t h) { return std::max(corner(h), corner(next(h))); };
    for (std::uint32_t h = 0; h < twins_.size(); ++h) ++first[low(h) + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<std::uint32_t> end(first.begin(), first.end() - 1);
    for (std::uint32_t h = 0; h < twins_.size(); ++h) {
      for (std::uint32_t k = first[low(h)]; k < end[low(h)]; ++k) {
        const std::uint32_t other = of_low[k];
        if (high(other) != high(h)) continue;
        if (twins_[other] != kBorder) return false;
        join(h, other);
        break;
      }
      of_low[end[low(h)]++] = h;
    }
    return true;
  }

  /// (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c).
  void flip(std::uint32_t h) {
    const std::uint32_t g = twins_[h], t = h / 3, s = g / 3;
    const std::uint32_t a = corner(h), b = corner(next(h)), c = corner(before(h)), d = corner(before(g));
    const std::uint32_t bc = twins_[next(h)], ca = twins_[before(h)], ad = twins_[next(g)], db = twins_[before(g)];
    triangles_[t] = {a, d, c};
    triangles_[s] = {d, b, c};
    join(3 * t, ad);
    join(3 * t + 2, ca);
    join(3 * s, db);
    join(3 * s + 1, bc);
    diagonal_ = 3 * t + 1;
    join(diagonal_, 3 * s + 2);
  }

  std::span<const Point3> points_;
  std::vector<Flat> flat_;
  std::vector<Corners> triangles_;
  std::vector<std::uint32_t> twins_;  ///< by half-edge; kBorder: an edge of the polygon
  std::uint32_t diagonal_ = 0;        ///< of the last flip: a half-edge
};

}  // namespace

std::optional<bool> surely_folds(std::span<const Point3> points, std::span<const Corners> triangles, double limit) {
  if (triangles.empty()) return std::nullopt;
  FlippedTriangles flipped(points, triangles);
  if (!flipped.become_delaunay(fitted_frame(points))) return std::nullopt;
  const auto doubled = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) -> Vector {
    return between(points[a], points[b]).cross(between(points[a], points[c]));
  };
  std::vector<Vector> normals;
  normals.reserve(triangles.size());
  Vector sum = Vector::Zero();  // the same for all triangulations
  for (const auto& [a, b, c] : flipped.triangles()) {
    const Vector n = doubled(a, b, c);
    if (!(n.norm() > 0)) return std::nullopt;
    sum += n;
    normals.push_back(n.normalized());
  }
  if (!(sum.norm() > 0)) return std::nullopt;
  const Vector mean = sum.normalized();
  // Two triangles that lean by a and b lie at most a + b apart, in whatever triangulation.
  double most = 0;
  for (const Vector& n : normals) most = std::max(most, (n - mean).squaredNorm());
  const auto circles = flipped.circles();
  for (const auto& circle : circles) {
    if (circle.size() > kMostOnCircle) return std::nullopt;
    for (std::size_t i = 0; i < circle.size(); ++i)
      for (std::size_t j = i + 1; j < circle.size(); ++j)
        for (std::size_t k = j + 1; k < circle.size(); ++k) {
          const Vector n = doubled(circle[i], circle[j], circle[k]);
          if (!(n.norm() > 0)) return std::nullopt;
          const Vector to = n.normalized();
          most = std::max(most, std::min((to - mean).squaredNorm(), (to + mean).squaredNorm()));
        }
  }
  if (2 * angle_between(std::sqrt(most)) < limit - kSureAngle) return false;
  if (!circles.empty()) return std::nullopt;
  std::vector<std::pair<double, std::size_t>> leaning;
  for (std::size_t i = 0; i < normals.size(); ++i) leaning.emplace_back(angle_between((normals[i] - mean).norm()), i);
  std::sort(leaning.begin(), leaning.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  double angle = 0;
  for (std::size_t i = 0; i < leaning.size() && 2 * leaning[i].first > angle; ++i)
    for (std::size_t j = i + 1; j < leaning.size() && leaning[i].first + leaning[j].first > angle; ++j)
      angle = std::max(angle, angle_between((normals[leaning[i].second] - normals[leaning[j].second]).norm()));
  if (std::fabs(angle - limit) < kSureAngle) return std::nullopt;
  return angle > limit;
}

bool folds_more_than(const model::Solid& solid, const model::Face& face, std::span<const Corners> triangles,
                     double limit) {
  const auto loops = solid.loops_of(face);
  if (loops.size() == 1 && loops[0].count == 3) return 0 > limit;
  if (is_flat(solid, face)) return 0 > limit;
  if (!triangles.empty()) {
    // The face's own points, numbered as its loops run.
    thread_local std::vector<std::uint32_t> number_of;  // by vertex; only what this face has set is read
    if (number_of.size() < solid.vertices.size()) number_of.resize(solid.vertices.size());
    std::vector<Point3> points;
    for (const auto& loop : loops)
      for (const std::uint32_t i : solid.indices_of(loop)) {
        number_of[i] = static_cast<std::uint32_t>(points.size());
        points.push_back(solid.vertices[i]);
      }
    std::vector<Corners> own;
    own.reserve(triangles.size());
    for (const auto& [a, b, c] : triangles) own.push_back({number_of[a], number_of[b], number_of[c]});
    if (const auto sure = surely_folds(points, own, limit)) return *sure;
  }
  return normal_deviation(solid, face) > limit;
}

}  // namespace blockrand::geometry
