#include "pipeline/context/wall_view.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/geometry/polygon_measures.h"
#include "pipeline/model/vector.h"

namespace blockrand::context {

namespace {

using model::Point2;

/// m. Segments are filed under cells this far around them: far above rounding.
constexpr double kSlack = 1.0 / model::kGridStepsPerMetre;

/// m². Of two ends on one side of a ray the product of the distances; far above the rounding of coordinates in the CRS.
constexpr double kClearlyBeside = 1e-6;

void add_walls(const model::Ring& ring, bool counter_clockwise, std::uint32_t footprint, std::vector<Wall>& out) {
  const std::size_t n = ring.size();
  const bool turn = (geometry::signed_area(ring.points) > 0) != counter_clockwise;
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = ring.points[i], b = ring.points[(i + 1) % n];
    if (a == b) continue;
    out.push_back(turn ? Wall{b, a, footprint} : Wall{a, b, footprint});
  }
}

std::int64_t cell_of(double metres, double size) { return static_cast<std::int64_t>(std::floor(metres / size)); }

}  // namespace

std::int64_t Scene::column(double x) const {
  return std::clamp(cell_of(x, kCell) - first_column_, std::int64_t{-1}, columns_);
}
std::int64_t Scene::row(double y) const { return std::clamp(cell_of(y, kCell) - first_row_, std::int64_t{-1}, rows_); }

template <class Visit>
void Scene::for_each_cell(Point2 a, Point2 b, Visit&& visit) const {
  if (b < a) std::swap(a, b);  // from west to east
  const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
  const std::int64_t first = std::max<std::int64_t>(column(a.x - kSlack), 0),
                     last = std::min(column(b.x + kSlack), columns_ - 1);
  for (std::int64_t c = first; c <= last; ++c) {
    const auto west_border = static_cast<double>(c + first_column_) * kCell;
    const double west = std::clamp(west_border - kSlack, a.x, b.x),
                 east = std::clamp(west_border + kCell + kSlack, a.x, b.x);
    const double from = b.x > a.x ? a.y + (west - a.x) * slope : a.y, to = b.x > a.x ? a.y + (east - a.x) * slope : b.y;
    const std::int64_t low = std::max<std::int64_t>(row(std::min(from, to) - kSlack), 0),
                       high = std::min(row(std::max(from, to) + kSlack), rows_ - 1);
    for (std::int64_t r = low; r <= high; ++r) visit(static_cast<std::size_t>(r * columns_ + c));
  }
}

Scene::Scene(std::span<const Footprint> footprints, std::span<const NetworkLine> lines, double margin) {
  for (std::uint32_t f = 0; f < footprints.size(); ++f) {
    sort_.push_back(footprints[f].canopy                                       ? Sort::canopy
                    : geometry::area(footprints[f].polygon) < kOutbuildingArea ? Sort::outbuilding
                                                                               : Sort::building);
    if (footprints[f].polygon.outer.size() < 3) continue;
    add_walls(footprints[f].polygon.outer, true, f, walls_);
    for (const model::Ring& hole : footprints[f].polygon.holes) add_walls(hole, false, f, walls_);
  }
  add_streets(lines);
  if (walls_.empty()) return;
  Point2 low = walls_[0].a, high = low;
  for (const Wall& w : walls_) {
    low = {std::min(low.x, w.a.x), std::min(low.y, w.a.y)};
    high = {std::max(high.x, w.a.x), std::max(high.y, w.a.y)};
  }
  first_column_ = cell_of(low.x - margin, kCell);
  first_row_ = cell_of(low.y - margin, kCell);
  columns_ = cell_of(high.x + margin, kCell) - first_column_ + 1;
  rows_ = cell_of(high.y + margin, kCell) - first_row_ + 1;

  const auto for_each_item = [&](auto&& visit) {
    for (std::uint32_t i = 0; i < walls_.size(); ++i) {
      const Wall& w = walls_[i];
      const Item item{w.a, w.b, i, w.footprint, sort_[w.footprint]};
      for_each_cell(w.a, w.b, [&](std::size_t cell) { visit(cell, item); });
    }
    for (std::uint32_t i = 0; i < streets_.size(); ++i) {
      const StreetPiece& s = streets_[i];
      const Item item{s.a, s.b, i, s.line, Sort::street};
      for_each_cell(s.a, s.b, [&](std::size_t cell) { visit(cell, item); });
    }
  };
  starts_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for_each_item([&](std::size_t cell, const Item&) { ++starts_[cell + 1]; });
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  items_.resize(starts_.back());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for_each_item([&](std::size_t cell, const Item& item) { items_[next[cell]++] = item; });
  for (std::vector<double>* ends : {&ax_, &ay_, &bx_, &by_}) ends->reserve(items_.size());
  for (const Item& item : items_) {
    ax_.push_back(item.a.x);
    ay_.push_back(item.a.y);
    bx_.push_back(item.b.x);
    by_.push_back(item.b.y);
  }
}

void Scene::add_streets(std::span<const NetworkLine> lines) {
  // How many pieces of streets end at a point: a street that ends where no other is has a dead end there.
  std::vector<Point2> ends;
  for (std::uint32_t l = 0; l < lines.size(); ++l) {
    const NetworkLine& line = lines[l];
    if (!is_street(line.kind) || line.tunnel) continue;
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Point2 a = line.points[i - 1], b = line.points[i];
      if (a == b) continue;
      const double length = distance(b, a);
      streets_.push_back({a, b, l, {(b.x - a.x) / length, (b.y - a.y) / length}, line.area});
      ends.push_back(a);
      ends.push_back(b);
    }
  }
  std::sort(ends.begin(), ends.end());
  const auto is_dead_end = [&](Point2 p) {
    const auto [first, last] = std::equal_range(ends.begin(), ends.end(), p);
    return last - first == 1;
  };
  const std::size_t pieces = streets_.size();
  for (std::size_t i = 0; i < pieces; ++i) {
    const StreetPiece piece = streets_[i];
    const Point2 across{-piece.along.y, piece.along.x};
    for (const Point2 end : {piece.a, piece.b})
      if (is_dead_end(end))
        streets_.push_back({{end.x - across.x * kDeadEndBar / 2, end.y - across.y * kDeadEndBar / 2},
                            {end.x + across.x * kDeadEndBar / 2, end.y + across.y * kDeadEndBar / 2},
                            piece.line,
                            across,
                            false});
  }
}

inline void Scene::test(const Item& item, Point2 from, Point2 d, double reach, Obstacles obstacles, Sight& sight,
                        std::uint32_t& street_line) {
  const double ax = item.a.x - from.x, ay = item.a.y - from.y, bx = item.b.x - from.x, by = item.b.y - from.y;
  const double sa = d.x * ay - d.y * ax, sb = d.x * by - d.y * bx;  // sides of the ends with respect to the ray
  if ((sa > 0) == (sb > 0)) return;
  if (item.sort == Sort::canopy || (item.sort == Sort::outbuilding && obstacles == Obstacles::buildings)) return;
  const double u = sa / (sa - sb), t = d.x * (ax + u * (bx - ax)) + d.y * (ay + u * (by - ay));
  if (t < 0 || t > reach) return;
  if (item.sort == Sort::street) {
    const auto key = std::pair(item.owner, item.index);
    if (t < sight.street || (t == sight.street && key < std::pair(street_line, sight.street_piece))) {
      sight.street = t;
      sight.street_piece = item.index;
      street_line = item.owner;
    }
    return;
  }
  const bool from_inside = sa < 0;  // a wall's inside is on its left: from there it runs from right to left
  if (t < kOnTheWall && !from_inside) return;
  // Of walls at one place the one met from inside, then that of the first footprint: no order of pieces shows.
  const bool nearer = t < sight.wall || (t == sight.wall && from_inside > sight.from_inside) ||
                      (t == sight.wall && from_inside == sight.from_inside && item.owner < sight.footprint);
  if (!nearer) return;
  sight.wall = t;
  sight.footprint = item.owner;
  sight.from_inside = from_inside;
}

Sight Scene::look(Point2 from, Point2 d, double reach, Obstacles obstacles) const {
  Sight sight;
  std::uint32_t street_line = kNothing;
  if (items_.empty()) return sight;
  // Cells along the ray (Amanatides and Woo 1987).
  std::int64_t c = cell_of(from.x, kCell) - first_column_, r = cell_of(from.y, kCell) - first_row_;
  const int step_c = d.x > 0 ? 1 : -1, step_r = d.y > 0 ? 1 : -1;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const auto border = [](std::int64_t cell, int step) {
    return static_cast<double>(cell + (step > 0 ? 1 : 0)) * kCell;
  };
  double to_c = d.x != 0 ? (border(c + first_column_, step_c) - from.x) / d.x : kNever;
  double to_r = d.y != 0 ? (border(r + first_row_, step_r) - from.y) / d.y : kNever;
  const double per_c = d.x != 0 ? kCell / std::fabs(d.x) : kNever, per_r = d.y != 0 ? kCell / std::fabs(d.y) : kNever;
  const double beside = d.x * from.y - d.y * from.x;
  double entered = 0;
  while (entered <= reach + kSlack && entered <= sight.wall + kSlack) {
    if (c >= 0 && c < columns_ && r >= 0 && r < rows_) {
      const auto cell = static_cast<std::size_t>(r * columns_ + c);
      const std::uint32_t end = starts_[cell + 1];
      for (std::uint32_t begin = starts_[cell]; begin < end; begin += kAtOnce) {
        // Most items of a cell lie on one side of the ray: told of several at once, without a branch on each.
        const std::uint32_t count = std::min(kAtOnce, end - begin);
        double sides[kAtOnce];
        for (std::uint32_t k = 0; k < count; ++k) {
          const std::uint32_t i = begin + k;
          const double sa = d.x * ay_[i] - d.y * ax_[i] - beside, sb = d.x * by_[i] - d.y * bx_[i] - beside;
          sides[k] = sa * sb;
        }
        for (std::uint32_t k = 0; k < count; ++k)
          if (!(sides[k] > kClearlyBeside)) test(items_[begin + k], from, d, reach, obstacles, sight, street_line);
      }
    }
    if (to_c < to_r) {
      entered = to_c;
      to_c += per_c;
      c += step_c;
    } else {
      entered = to_r;
      to_r += per_r;
      r += step_r;
    }
  }
  if (sight.street > sight.wall) {
    sight.street = kNever;
    sight.street_piece = kNothing;
  }
  return sight;
}

void Scene::walls_near(Point2 minimum, Point2 maximum, std::vector<std::uint32_t>& out) const {
  out.clear();
  if (items_.empty()) return;
  const std::int64_t first = std::max<std::int64_t>(column(minimum.x), 0),
                     last = std::min(column(maximum.x), columns_ - 1), low = std::max<std::int64_t>(row(minimum.y), 0),
                     high = std::min(row(maximum.y), rows_ - 1);
  for (std::int64_t r = low; r <= high; ++r)
    for (std::int64_t c = first; c <= last; ++c) {
      const auto cell = static_cast<std::size_t>(r * columns_ + c);
      for (std::uint32_t i = starts_[cell]; i < starts_[cell + 1] && items_[i].sort != Sort::street; ++i)
        out.push_back(items_[i].index);
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

std::array<Point2, kFanRays> fan_around(Point2 normal) {
  static const std::array<Point2, kFanRays> turns = [] {
    constexpr double kStep = 13.5;  // degrees
    std::array<Point2, kFanRays> out;
    for (int i = 0; i < kFanRays; ++i) {
      const base::SinCos t = base::sin_cos((i - kFanRays / 2) * kStep * base::kRadiansPerDegree);
      out[static_cast<std::size_t>(i)] = {t.cos, t.sin};
    }
    return out;
  }();
  std::array<Point2, kFanRays> out;
  for (std::size_t i = 0; i < kFanRays; ++i)
    out[i] = {normal.x * turns[i].x - normal.y * turns[i].y, normal.y * turns[i].x + normal.x * turns[i].y};
  return out;
}

}  // namespace blockrand::context
