// Measures and simple operations of rings and polygons. All lengths in metres, areas in square metres.
#pragma once

#include <span>

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// Positive for counter-clockwise rings. Exact to rounding: computed relative to the first point.
double signed_area(std::span<const model::Point2> ring);
double area(const model::Polygon& polygon);
double perimeter(std::span<const model::Point2> ring);
double perimeter(const model::Polygon& polygon);

/// Centre of mass of the outer ring; the mean of its points when it has no area.
model::Point2 centroid(std::span<const model::Point2> ring);

/// True when `p` is inside or on the boundary of the ring (any orientation).
bool contains(std::span<const model::Point2> ring, model::Point2 p);
/// Inside the outer ring and not strictly inside a hole.
bool contains(const model::Polygon& polygon, model::Point2 p);

/// Distance from p to the segment ab.
double distance_to_segment(model::Point2 p, model::Point2 a, model::Point2 b);

/// The ring turned so that its signed area is positive (or negative); nodes travel along.
void orient(model::Ring& ring, bool counter_clockwise);

/// Removes points that are nearer than `tolerance` to the line between the points kept around them; repeated until
/// nothing changes, smallest deviation first. At least three points stay.
void remove_collinear(model::Ring& ring, double tolerance);

/// Width of the rectangle that has the same area and perimeter: the typical width of a wing, also for L, U and ring
/// plans. For plans rounder than a square the square's width.
double equivalent_width(const model::Polygon& polygon);

/// Half the extent of the polygon across `direction` (a unit vector) and the mean position along it.
struct Extent {
  double minimum = 0, maximum = 0;
};
Extent extent_along(std::span<const model::Point2> ring, model::Point2 direction);

/// Unit vector along the longer side of the smallest-area bounding rectangle.
model::Point2 long_axis(std::span<const model::Point2> ring);

}  // namespace blockrand::geometry
