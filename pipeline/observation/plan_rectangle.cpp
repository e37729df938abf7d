#include "pipeline/observation/plan_rectangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace blockrand::observation {

namespace {

using model::Point2;

/// Of the line of pixels across a region than which longer ones have half of its pixels: a shorter line at its end is a spur.
constexpr double kSpur = 0.45;
constexpr double kFewestLines = 3;
/// Degrees: turns that are tried, and their number to each side.
constexpr double kTurnStep = 4;
constexpr int kTurns = 2;
/// m: how far a side is moved, and the step.
constexpr double kSideReach = 1.5, kSideStep = 0.25;
/// m: no rectangle is made narrower.
constexpr double kNarrowest = 1.5;

double cross(Point2 o, Point2 a, Point2 b) { return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x); }

/// Andrew, "Another efficient algorithm for convex hulls in two dimensions" (1979). \param points  sorted by y, then x
std::vector<Point2> hull_of(const std::vector<Point2>& points) {
  std::vector<Point2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Point2 p = side == 0 ? points[k] : points[points.size() - 1 - k];
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
  }
  return hull;
}

/// Direction of the side of the rectangle of least area around a convex ring; it lies on one of the ring's edges
/// (Freeman, Shapira, "Determining the minimum-area encasing rectangle for an arbitrary closed curve", 1975).
Point2 least_direction(const std::vector<Point2>& hull) {
  double least = 1e300;
  Point2 best{1, 0};
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point2 a = hull[i], b = hull[(i + 1) % hull.size()];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
    if (length <= 0) continue;
    const Point2 u{dx / length, dy / length};
    double low = 1e300, high = -1e300, deep = 0;
    for (const Point2 p : hull) {
      const double s = (p.x - a.x) * u.x + (p.y - a.y) * u.y, t = (p.y - a.y) * u.x - (p.x - a.x) * u.y;
      low = std::min(low, s), high = std::max(high, s), deep = std::max(deep, std::fabs(t));
    }
    if ((high - low) * deep < least) least = (high - low) * deep, best = u;
  }
  return best;
}

struct Span {
  double from = 0, to = 0;
};

/// Where a region lies along a direction, without its spurs. \param places  of its pixels along it, m
std::optional<Span> without_spurs(const std::vector<double>& places, double pixel) {
  const auto [low, high] = std::minmax_element(places.begin(), places.end());
  const double first = *low - pixel / 2;
  const auto bins = static_cast<std::size_t>((*high - first) / pixel) + 1;
  std::vector<std::uint32_t> count(bins, 0);
  for (const double p : places) ++count[std::min(bins - 1, static_cast<std::size_t>((p - first) / pixel))];
  std::vector<std::uint32_t> sorted = count;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  std::size_t longer = 0, pixels = 0;
  while (2 * (pixels + sorted[longer]) < places.size()) pixels += sorted[longer++];
  const double least = kSpur * sorted[longer];
  std::size_t from = 0, to = bins;
  while (from < to && count[from] < least) ++from;
  while (to > from && count[to - 1] < least) --to;
  if (static_cast<double>(to - from) < kFewestLines) return std::nullopt;
  return Span{first + static_cast<double>(from) * pixel, first + static_cast<double>(to) * pixel};
}

std::vector<WallPiece> pieces_of(Point2 a, Point2 b) {
  std::vector<WallPiece> pieces;
  const std::array<Point2, 2> line{a, b};
  const std::array<double, 2> weights{1, 0};
  add_pieces(line, weights, pieces);
  std::erase_if(pieces, [](const WallPiece& p) { return p.weight <= 0; });
  return pieces;
}

}  // namespace

std::vector<Point2> PlanRectangle::corners() const {
  std::vector<Point2> out;
  for (const auto& [u, v] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
    out.push_back({centre.x + u * half_long * along.x - v * half_short * along.y,
                   centre.y + u * half_long * along.y + v * half_short * along.x});
  return out;
}

double PlanRectangle::radius() const { return std::sqrt(half_long * half_long + half_short * half_short); }

std::optional<FilledRectangle> rectangle_of(const Patch& patch, std::span<const std::uint32_t> pixels) {
  if (pixels.empty()) return std::nullopt;
  const auto width = static_cast<std::uint32_t>(patch.width);
  const auto place = [&](std::uint32_t i) {
    return Point2{patch.west + (i % width + 0.5) * patch.size, patch.north - (i / width + 0.5) * patch.size};
  };
  // The ends of its lines of pixels have its hull.
  std::vector<Point2> ends;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const bool first = k == 0 || pixels[k - 1] / width != pixels[k] / width,
               last = k + 1 == pixels.size() || pixels[k + 1] / width != pixels[k] / width;
    if (first || last) ends.push_back(place(pixels[k]));
  }
  std::sort(ends.begin(), ends.end(), [](Point2 a, Point2 b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  if (ends.size() < 3) return std::nullopt;
  const std::vector<Point2> hull = hull_of(ends);
  if (hull.size() < 3) return std::nullopt;
  const Point2 u = least_direction(hull), origin = place(pixels.front());
  std::vector<double> s, t;
  for (const std::uint32_t i : pixels) {
    const Point2 p = place(i);
    s.push_back((p.x - origin.x) * u.x + (p.y - origin.y) * u.y);
    t.push_back((p.y - origin.y) * u.x - (p.x - origin.x) * u.y);
  }
  const std::optional<Span> a = without_spurs(s, patch.size), b = without_spurs(t, patch.size);
  if (!a || !b) return std::nullopt;
  std::size_t inside = 0;
  for (std::size_t k = 0; k < s.size(); ++k)
    inside += s[k] >= a->from && s[k] <= a->to && t[k] >= b->from && t[k] <= b->to;
  FilledRectangle out;
  const double middle_s = (a->from + a->to) / 2, middle_t = (b->from + b->to) / 2;
  PlanRectangle& r = out.rectangle;
  r.centre = {origin.x + middle_s * u.x - middle_t * u.y, origin.y + middle_s * u.y + middle_t * u.x};
  r.along = u, r.half_long = (a->to - a->from) / 2, r.half_short = (b->to - b->from) / 2;
  if (r.half_short > r.half_long) {
    std::swap(r.half_short, r.half_long);
    r.along = {-u.y, u.x};
  }
  const double within = static_cast<double>(inside);
  out.filled = std::min(1.0, within * patch.size * patch.size / r.area()) * within / static_cast<double>(pixels.size());
  return out;
}

std::optional<EdgedRectangle> fit_to_edges(const PlanRectangle& rectangle, const Patch& patch, double contrast) {
  PlanRectangle r = rectangle;
  // Its direction, wherever within half a metre it lies.
  double best = -1;
  for (int k = -kTurns; k <= kTurns; ++k) {
    PlanRectangle turned = rectangle;
    const base::SinCos a = base::sin_cos(k * kTurnStep * base::kRadiansPerDegree);
    turned.along = {rectangle.along.x * a.cos - rectangle.along.y * a.sin,
                    rectangle.along.x * a.sin + rectangle.along.y * a.cos};
    const std::vector<Point2> ring = turned.corners();
    const std::array<double, 4> weights{1, 1, 1, 1};
    std::vector<WallPiece> pieces;
    add_pieces(ring, weights, pieces);
    const ScoreMap map = score_outline(pieces, patch, {0.5, 1}, turned.centre, {}, contrast);
    if (map.missing > 0 || map.weight <= 0) return std::nullopt;
    const double score = static_cast<double>(*std::max_element(map.score.begin(), map.score.end()));
    // Nearly as good is no reason to turn it.
    if (score > best + (k == 0 ? -0.01 : 0.01)) best = score, r = turned;
  }
  EdgedRectangle out;
  const std::vector<Point2> ring = r.corners();
  std::array<double, 4> moved{};
  double length = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % 4];
    const std::vector<WallPiece> pieces = pieces_of(a, b);
    const Displacements grid{kSideStep, static_cast<int>(std::lround(kSideReach / kSideStep))};
    const ScoreMap map = score_outline(pieces, patch, grid, r.centre, {}, contrast);
    if (map.missing > 0 || map.weight <= 0) return std::nullopt;
    const Point2 outward{pieces.front().along.y, -pieces.front().along.x};
    double side = -1, sum = 0;
    for (int k = -grid.half; k <= grid.half; ++k) {
      const double at = k * kSideStep, score = map.at(outward.x * at, outward.y * at);
      sum += score;
      if (score > side) side = score, moved[i] = at;
    }
    out.score += side * map.weight, out.around += sum / grid.side() * map.weight, length += map.weight;
  }
  out.score /= length, out.around /= length;
  // The sides run along, across, along, across; counter-clockwise from the one on the right of `along`.
  const double south = r.half_short + moved[0], east = r.half_long + moved[1], north = r.half_short + moved[2],
               west = r.half_long + moved[3];
  const double u = (east - west) / 2, v = (north - south) / 2;
  r.centre = {r.centre.x + u * r.along.x - v * r.along.y, r.centre.y + u * r.along.y + v * r.along.x};
  r.half_long = (east + west) / 2, r.half_short = (south + north) / 2;
  if (r.half_short * 2 < kNarrowest || r.half_long * 2 < kNarrowest) return std::nullopt;
  if (r.half_short > r.half_long) std::swap(r.half_short, r.half_long), r.along = {-r.along.y, r.along.x};
  out.rectangle = r;
  return out;
}

}  // namespace blockrand::observation
