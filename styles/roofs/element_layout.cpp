#include "styles/roofs/element_layout.h"

#include <algorithm>
#include <cmath>

#include "pipeline/base/portable_math.h"

namespace blockrand::roofs {

using model::Point2;

namespace {

/// m. What bisection leaves open; far below the grid, so that an element that fits to the millimetre finds its place.
constexpr double kFound = 1e-6;

using Outline = std::vector<Point2>;
using Intervals = std::vector<std::pair<double, double>>;

Outline moved(std::span<const Point2> outline, Point2 by) {
  Outline out(outline.begin(), outline.end());
  for (Point2& p : out) p = {p.x + by.x, p.y + by.y};
  return out;
}

double turn(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

double between_segments(Point2 a, Point2 b, Point2 c, Point2 d) {
  if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) return 0;
  return std::min({geometry::distance_to_segment(a, c, d), geometry::distance_to_segment(b, c, d),
                   geometry::distance_to_segment(c, a, b), geometry::distance_to_segment(d, a, b)});
}

/// From a ring's inside and border to a segment.
double distance(std::span<const Point2> ring, Point2 a, Point2 b) {
  if (geometry::contains(ring, a)) return 0;
  double least = 1e300;
  for (std::size_t i = 0; i < ring.size(); ++i)
    least = std::min(least, between_segments(ring[i], ring[(i + 1) % ring.size()], a, b));
  return least;
}

double distance(std::span<const Point2> a, std::span<const Point2> b) {
  if (geometry::contains(b, a[0])) return 0;
  double least = 1e300;
  for (std::size_t i = 0; i < b.size(); ++i) least = std::min(least, distance(a, b[i], b[(i + 1) % b.size()]));
  return least;
}

bool inside(const RoofSlope& plane, Point2 p) {
  bool in = geometry::contains(plane.loops[0], p);
  for (std::size_t i = 1; i < plane.loops.size(); ++i) in = in && !geometry::contains(plane.loops[i], p);
  return in;
}

/// A point inside of a convex outline.
Point2 middle_of(std::span<const Point2> outline) { return geometry::centroid(outline); }

/// Where `value` is below `limit`: the stretch between `low` and `high`, both of which it is not. Empty when nowhere.
/// \param value  convex, and changes by no more than its argument: a distance from something convex that is moved
template <class Function>
std::optional<std::pair<double, double>> below(double low, double high, double limit, const Function& value) {
  double a = low, b = high, in = (a + b) / 2;
  while (value(in) >= limit) {
    if (b - a < kFound / 4) return std::nullopt;
    const double m1 = a + (b - a) / 3, m2 = b - (b - a) / 3, v1 = value(m1), v2 = value(m2);
    if (std::min(v1, v2) - (b - a) >= limit) return std::nullopt;
    // On a level stretch all values are the least one, and any of them will do.
    if (v1 <= v2) b = m2;
    if (v2 <= v1) a = m1;
    in = v1 <= v2 ? m1 : m2;
  }
  const auto cross = [&](double out) {
    for (double inner = in; std::fabs(inner - out) > kFound / 16;) {
      const double m = (out + inner) / 2;
      if (m == out || m == inner) break;
      (value(m) < limit ? inner : out) = m;
    }
    return out;
  };
  return std::pair(cross(low), cross(high));
}

}  // namespace

double ElementDistances::from(BorderKind kind) const {
  switch (kind) {
    case BorderKind::eaves:
      return eaves;
    case BorderKind::side:
      return side;
    case BorderKind::top:
      return top;
    case BorderKind::fold:
      return fold;
    case BorderKind::element:
      return between;
  }
  return 0;
}

bool takes_elements(const RoofSlope& plane) {
  return plane.rise >= base::tan((kFlattestSlope - 0.01) * base::kRadiansPerDegree) &&
         plane.rise <= base::tan((kSteepestSlope + 0.01) * base::kRadiansPerDegree);
}

bool is_level_eaves(const RoofSlope& plane, const SlopeBorder& border, double up) {
  if (border.kind != BorderKind::eaves) return false;
  const Point2 a = plane.in_plane(border.start), b = plane.in_plane(border.end);
  return std::fabs(a.y - up) < kLevelLine && std::fabs(b.y - up) < kLevelLine && b.x > a.x;
}

bool fits(const RoofSlope& plane, std::span<const Point2> outline, const ElementDistances& distances, bool flush) {
  if (outline.size() < 3 || !inside(plane, middle_of(outline))) return false;
  const double up = geometry::extent_along(outline, {0, 1}).minimum;
  const auto along = geometry::extent_along(outline, {1, 0});
  bool stands = !flush;
  for (const SlopeBorder& border : plane.borders) {
    const Point2 a = plane.in_plane(border.start), b = plane.in_plane(border.end);
    if (flush && is_level_eaves(plane, border, up)) {
      stands = stands || (along.minimum >= a.x + kLeastPart && along.maximum <= b.x - kLeastPart);
      continue;
    }
    if (distance(outline, a, b) < distances.from(border.kind) - kDistanceSlack) return false;
  }
  return stands && std::all_of(plane.occupied.begin(), plane.occupied.end(), [&](const OccupiedPlace& place) {
           return distance(outline, place.outline) >= std::max(place.distance, 0.0) - kDistanceSlack;
         });
}

Intervals free_intervals(const RoofSlope& plane, const LayoutRequest& wanted_layout,
                         const ElementDistances& distances) {
  const auto own = geometry::extent_along(wanted_layout.outline, {1, 0});
  const auto heights = geometry::extent_along(wanted_layout.outline, {0, 1});
  const auto along = plane.along_extent(), up = plane.up_extent();
  if (own.maximum - own.minimum > along.maximum - along.minimum || heights.maximum + wanted_layout.up > up.maximum)
    return {};
  const double low = along.minimum - own.maximum - 1, high = along.maximum - own.minimum + 1;

  Intervals taken;
  const auto take = [&](double limit, std::span<const Point2> points, const auto& value) {
    const auto near = geometry::extent_along(points, {1, 0});
    const double reach = limit + kLeastPart;
    if (const auto stretch =
            below(near.minimum - own.maximum - reach, near.maximum - own.minimum + reach, limit - kFound, value))
      taken.push_back(*stretch);
  };
  // What lies near is moved instead of the outline.
  const auto seen = [&](Point2 p, double x) { return Point2{p.x - x, p.y - wanted_layout.up}; };
  const auto far = [&](double limit, std::span<const Point2> points) {
    const auto other = geometry::extent_along(points, {0, 1});
    return other.minimum - wanted_layout.up > heights.maximum + limit ||
           other.maximum - wanted_layout.up < heights.minimum - limit;
  };
  Intervals standing;  // of flush fronts
  for (const SlopeBorder& border : plane.borders) {
    const Point2 ends[] = {plane.in_plane(border.start), plane.in_plane(border.end)};
    if (wanted_layout.flush && is_level_eaves(plane, border, wanted_layout.up)) {
      standing.emplace_back(ends[0].x + kLeastPart - own.minimum, ends[1].x - kLeastPart - own.maximum);
      continue;
    }
    // Borders along the slope are as uneven as the grid: where that alone decides, it must not.
    const bool along_slope = border.kind == BorderKind::eaves || border.kind == BorderKind::top;
    const double limit = distances.from(border.kind) - (along_slope ? kDistanceSlack / 2 : 0);
    if (far(limit, ends)) continue;
    take(limit, ends, [&](double x) { return distance(wanted_layout.outline, seen(ends[0], x), seen(ends[1], x)); });
  }
  for (const OccupiedPlace& place : plane.occupied) {
    if (far(place.distance, place.outline)) continue;
    take(place.distance, place.outline, [&](double x) {
      return distance(moved(wanted_layout.outline, {x, wanted_layout.up}), place.outline);
    });
  }

  if (wanted_layout.flush) {
    // What lies between the eaves is taken.
    std::sort(standing.begin(), standing.end());
    double end = low;
    for (const auto& [first, last] : standing) {
      if (last < first) continue;
      if (first > end) taken.emplace_back(end, first);
      end = std::max(end, last);
    }
    taken.emplace_back(end, high);
  }
  std::sort(taken.begin(), taken.end());
  Intervals out;
  double from = low;
  const auto add = [&](double to) {
    // Between two taken stretches no border comes near: all of it lies inside or all outside.
    if (to >= from && inside(plane, middle_of(moved(wanted_layout.outline, {(from + to) / 2, wanted_layout.up}))))
      out.emplace_back(from, to);
  };
  for (const auto& [first, last] : taken) {
    add(first);
    from = std::max(from, last);
  }
  if (from < high) add(high);
  return out;
}

namespace {

/// The free place nearest to `wanted` within [low, high]; empty when there is none.
std::optional<double> nearest(const Intervals& free, double wanted, double low, double high) {
  std::optional<double> best;
  for (const auto& [first, last] : free) {
    const double a = std::max(first, low), b = std::min(last, high);
    if (a > b + kFound) continue;
    const double x = std::clamp(wanted, std::min(a, b), b);
    if (!best || std::fabs(x - wanted) < std::fabs(*best - wanted)) best = x;
  }
  return best;
}

/// The first free places from the left (or, mirrored, from the right) that lie `spacing` apart, at most `count`.
std::vector<double> packed(const Intervals& free, double spacing, std::size_t count) {
  std::vector<double> out;
  double next = -1e300;
  for (const auto& [first, last] : free)
    for (double x = std::max(first, next); x <= last + kFound && out.size() < count; x = next) {
      out.push_back(std::min(x, last));
      next = x + spacing;
    }
  return out;
}

Intervals mirrored(const Intervals& free) {
  Intervals out;
  for (auto s = free.rbegin(); s != free.rend(); ++s) out.emplace_back(-s->second, -s->first);
  return out;
}

/// m. More than any slope is long; beyond it, layouts of "as many as fit" stop.
constexpr std::size_t kMostPlaces = 10000;

std::vector<double> in_fields(const RoofSlope& plane, const Intervals& free, double spacing, std::size_t wanted) {
  const std::vector<double> earliest = packed(free, spacing, wanted);
  const std::size_t n = earliest.size();
  if (n == 0) return {};
  std::vector<double> latest = packed(mirrored(free), spacing, n);
  std::reverse(latest.begin(), latest.end());
  for (double& x : latest) x = -x;
  // Equal fields of the slope; its outer ones give way to what may not stand at their middles.
  const auto along = plane.along_extent();
  const double field = (along.maximum - along.minimum) / static_cast<double>(n);
  double first = std::max(along.minimum + field / 2, free.front().first);
  double last = std::min(along.maximum - field / 2, free.back().second);
  if (n == 1) first = last = (along.minimum + along.maximum) / 2;
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = n == 1 ? 0 : static_cast<double>(i) / static_cast<double>(n - 1);
    const double low = i == 0 ? earliest[0] : std::max(earliest[i], out.back() + spacing);
    out.push_back(nearest(free, first + (last - first) * share, low, latest[i]).value_or(latest[i]));
  }
  return out;
}

std::vector<double> on_axes(const RoofSlope& plane, const Intervals& free, double spacing, std::vector<double> axes,
                            std::size_t wanted) {
  std::sort(axes.begin(), axes.end());
  const auto is_free = [&](double x) { return nearest(free, x, x - kFound, x + kFound).has_value(); };
  const auto along = plane.along_extent();
  const double middle = (along.minimum + along.maximum) / 2;
  std::vector<double> best;
  double best_lean = 0;
  for (std::size_t stride = 1; stride <= axes.size(); ++stride)
    for (std::size_t start = 0; start < stride; ++start) {
      std::vector<double> chosen;
      for (std::size_t i = start; i < axes.size(); i += stride)
        if (is_free(axes[i]) && (chosen.empty() || axes[i] >= chosen.back() + spacing - kFound))
          chosen.push_back(axes[i]);
      while (chosen.size() > wanted) {
        // Thinned evenly: those nearest to equal shares of the row stay.
        std::vector<double> kept;
        for (std::size_t k = 0; k < wanted; ++k) kept.push_back(chosen[(2 * k + 1) * chosen.size() / (2 * wanted)]);
        chosen = std::move(kept);
      }
      double lean = 0;
      for (const double x : chosen) lean += x - middle;
      lean = std::fabs(lean);
      if (chosen.size() > best.size() || (chosen.size() == best.size() && lean < best_lean - 0.01)) {
        best = std::move(chosen);
        best_lean = lean;
      }
    }
  return best;
}

}  // namespace

Layout lay_out(const RoofSlope& plane, const LayoutRequest& wanted_layout, const ElementDistances& distances) {
  Layout out;
  if (wanted_layout.outline.size() < 3) return out;
  const auto own = geometry::extent_along(wanted_layout.outline, {1, 0});
  const double spacing = own.maximum - own.minimum + distances.between;
  const Intervals free = free_intervals(plane, wanted_layout, distances);
  std::vector<double> axes = wanted_layout.axes;
  if (axes.empty() && wanted_layout.step > 0) {
    const auto along = plane.along_extent();
    const double length = along.maximum - along.minimum;
    const auto n = static_cast<std::size_t>(std::max(1.0, std::floor(length / wanted_layout.step)));
    for (std::size_t i = 0; i < n; ++i)
      axes.push_back((along.minimum + along.maximum) / 2 +
                     (static_cast<double>(i) - static_cast<double>(n - 1) / 2) * wanted_layout.step);
  }
  std::size_t wanted = kMostPlaces;
  if (wanted_layout.count)
    wanted = static_cast<std::size_t>(std::max(0, *wanted_layout.count));
  else if (!axes.empty())
    wanted = axes.size();
  out.along = axes.empty() ? in_fields(plane, free, spacing, wanted) : on_axes(plane, free, spacing, axes, wanted);
  if (wanted != kMostPlaces) out.did_not_fit = static_cast<int>(wanted - out.along.size());
  return out;
}

}  // namespace blockrand::roofs
