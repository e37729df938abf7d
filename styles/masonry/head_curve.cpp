// Heads of openings: which curve they follow, where joints of their arch point.
#include <algorithm>
#include <cmath>
#include <optional>

#include "styles/masonry/dressings.h"

namespace blockrand::masonry {
namespace {

/// m. Outlines of arches are made of straight pieces whose points lie on the grid.
constexpr double kOnCurve = 0.004;
/// m. Edges of jambs, sills and level heads.
constexpr double kLevel = 0.003;

/// m. Points nearer than that would be one on the grid.
constexpr double kSamePlace = 0.004;

double apart(Point2 a, Point2 b) { return std::hypot(b.x - a.x, b.y - a.y); }

/// The centre of the circle through the points, where they lie on one.
std::optional<Point2> centre_of(std::span<const Point2> points) {
  if (points.size() < 3) return std::nullopt;
  const Point2 a = points[0], b = points[points.size() / 3], c = points[points.size() * 2 / 3];
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y, d = 2 * (bx * cy - by * cx);
  if (std::fabs(d) < 1e-9) return std::nullopt;
  const double bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  const Point2 centre{a.x + (cy * bb - by * cc) / d, a.y + (bx * cc - cx * bb) / d};
  const double radius = apart(centre, a);
  for (const Point2& p : points)
    if (std::fabs(apart(centre, p) - radius) > kOnCurve) return std::nullopt;
  return centre;
}

Point2 unit(Point2 v) {
  const double length = std::hypot(v.x, v.y);
  return length > 0 ? Point2{v.x / length, v.y / length} : Point2{0, 1};
}

}  // namespace

OpeningShape shape_of(const Outline& opening) {
  OpeningShape out;
  out.box = box_of(opening);
  const std::size_t n = opening.size();
  std::size_t right = 0, left = 0;
  double foot = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 &p = opening[i], &q = opening[(i + 1) % n];
    const auto higher = [&](std::size_t best, bool on_edge) {
      return on_edge && (std::fabs(opening[best].x - p.x) > kLevel || p.y > opening[best].y);
    };
    if (higher(right, p.x > out.box.right - kLevel)) right = i;
    if (higher(left, p.x < out.box.left + kLevel)) left = i;
    if (p.y < out.box.low + kLevel && q.y < out.box.low + kLevel) foot += std::fabs(q.x - p.x);
  }
  out.flat_foot = foot > 0.6 * (out.box.right - out.box.left);
  for (std::size_t i = right;; i = (i + 1) % n) {
    out.head.push_back(opening[i]);
    if (i == left || out.head.size() > n) break;
  }
  out.straight = std::ranges::all_of(out.head, [&](const Point2& p) { return p.y > out.box.high - kLevel; });
  return out;
}

HeadCurve::HeadCurve(const Outline& points) : points_(points), along_{0} {
  for (std::size_t i = 1; i < points_.size(); ++i) along_.push_back(along_.back() + apart(points_[i - 1], points_[i]));
  const auto normal = [&](std::size_t i) {
    return unit({points_[i + 1].y - points_[i].y, points_[i].x - points_[i + 1].x});
  };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point2 before = normal(i == 0 ? 0 : i - 1), after = normal(i + 1 < points_.size() ? i : i - 1);
    outwards_.push_back(unit({before.x + after.x, before.y + after.y}));
  }
  if (const auto centre = centre_of(points_)) {
    arcs_.push_back({0, length(), *centre});
    return;
  }
  // A pointed arch: its highest point parts it.
  const auto top = std::ranges::max_element(points_, {}, &Point2::y) - points_.begin();
  const std::span all(points_);
  const auto first = centre_of(all.first(static_cast<std::size_t>(top) + 1)),
             second = centre_of(all.subspan(static_cast<std::size_t>(top)));
  if (!first || !second) return;
  arcs_.push_back({0, along_[static_cast<std::size_t>(top)], *first});
  arcs_.push_back({along_[static_cast<std::size_t>(top)], length(), *second});
}

Point2 HeadCurve::at(double s) const {
  for (std::size_t i = 1; i < points_.size(); ++i)
    if (s <= along_[i] || i + 1 == points_.size()) {
      const double piece = along_[i] - along_[i - 1], t = piece > 0 ? (s - along_[i - 1]) / piece : 0;
      return {points_[i - 1].x + (points_[i].x - points_[i - 1].x) * t,
              points_[i - 1].y + (points_[i].y - points_[i - 1].y) * t};
    }
  return points_.back();
}

Point2 HeadCurve::outward(double s) const {
  const Point2 p = at(s);
  for (const Arc& arc : arcs_)
    if (s <= arc.to || &arc == &arcs_.back()) {
      const Point2 out = unit({p.x - arc.centre.x, p.y - arc.centre.y});
      // Centres of heads that hang down lie above.
      const Point2 usual = outwards_[static_cast<std::size_t>(
          std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(along_, s) - along_.begin() - 1, 0,
                                     static_cast<std::ptrdiff_t>(outwards_.size()) - 1))];
      return out.x * usual.x + out.y * usual.y < 0 ? Point2{-out.x, -out.y} : out;
    }
  for (std::size_t i = 1; i < points_.size(); ++i)
    if (s <= along_[i] || i + 1 == points_.size()) {
      const double piece = along_[i] - along_[i - 1];
      const double t = piece > 0 ? std::clamp((s - along_[i - 1]) / piece, 0.0, 1.0) : 0;
      return unit(
          {outwards_[i - 1].x * (1 - t) + outwards_[i].x * t, outwards_[i - 1].y * (1 - t) + outwards_[i].y * t});
    }
  return {0, 1};
}

Outline HeadCurve::between(double from, double to) const {
  Outline out;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (along_[i] > from + kSamePlace && along_[i] < to - kSamePlace) out.push_back(points_[i]);
  return out;
}

}  // namespace blockrand::masonry
