// Polygons in a plane: what frames, panes and sections are made of before they get a depth.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::elements {

/// A polygon without holes, counter-clockwise, metres; the last point is not repeated.
using Outline = std::vector<model::Point2>;

/// m. Points nearer to one another are one point: half a step of what outputs can tell apart, and far above rounding.
inline constexpr double kSamePoint = 0.0005;

/// m², positive for counter-clockwise polygons.
double signed_area(std::span<const model::Point2> polygon);

/// Smallest and largest coordinates.
struct Bounds2 {
  model::Point2 least, most;
  double width() const { return most.x - least.x; }
  double height() const { return most.y - least.y; }
};
Bounds2 bounds_of(std::span<const model::Point2> polygon);

/// True when no two edges cross or touch but at the corner that they share. O(n²).
bool is_simple(std::span<const model::Point2> polygon);

/// The part of a convex polygon where x * normal.x + y * normal.y <= limit; empty when nothing with an area is left.
Outline clipped(const Outline& convex, model::Point2 normal, double limit);

/// The part of a convex polygon with `from <= x <= to` (or y).
Outline between_x(const Outline& convex, double from, double to);
Outline between_y(const Outline& convex, double from, double to);

/// What is left of a convex polygon when every edge moves inwards by `distance` metres; short edges vanish. Empty when
/// nothing is left.
Outline inset(const Outline& convex, double distance);

/// A polygon with holes cut into convex faces: indices into `points`, counter-clockwise. Only the corners of the loops
/// are used. Empty optional when the loops cross or touch.
std::optional<std::vector<std::vector<std::uint32_t>>> convex_faces(std::span<const model::Point2> points,
                                                                    std::span<const std::vector<std::uint32_t>> loops);

}  // namespace blockrand::elements
