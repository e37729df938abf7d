// Small plane geometry of this room: convex polygons, clipping. Internal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/base/random.h"
#include "pipeline/model/point.h"

namespace blockrand::masonry {

using model::Point2;
using Outline = std::vector<Point2>;

struct Box {
  double left = 1e300, low = 1e300, right = -1e300, high = -1e300;
  bool meets(const Box& o, double by = 0) const {
    return left < o.right + by && o.left < right + by && low < o.high + by && o.low < high + by;
  }
};
Box box_of(std::span<const Point2> points);

double area_of(std::span<const Point2> points);
/// Smallest extent across any edge: how narrow a convex polygon is. Of others that of their hull at least in the edges' directions.
double narrowest(std::span<const Point2> points);
bool is_convex(std::span<const Point2> points, double tolerance);
Outline rectangle_outline(double left, double low, double right, double high);

/// The part of a convex polygon where (p - at) . normal <= 0.
Outline cut_half_plane(const Outline& convex, Point2 at, Point2 normal);
/// A convex polygon with all edges moved inwards; empty where nothing is left.
Outline inset_convex(const Outline& convex, double by);

/// Without points nearer than 3 mm to the one before.
Outline without_short_edges(const Outline& outline);

/// What is left of a polygon, by pieces of at least `least` m2, largest first.
std::vector<Outline> cut_away(const Outline& from, std::span<const Outline> away, double least);
/// Parts of `from` that lie within `limits`.
std::vector<Outline> cut_to(const Outline& from, const Outline& limits, double least);

inline double unit_of(std::uint64_t seed, std::uint64_t number, std::uint64_t draw) {
  return static_cast<double>(base::mix64(base::mix64(seed ^ base::mix64(number)) + draw) >> 11) * 0x1.0p-53;
}

}  // namespace blockrand::masonry
