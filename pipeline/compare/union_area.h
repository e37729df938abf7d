// How much of a plane several polygons cover together. Internal to this folder.
#pragma once

#include <span>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::compare {

/// Rings of one polygon in a plane, of any orientation: what an odd number of them encloses is inside. The last point
/// is not repeated.
using FlatPolygon = std::vector<std::vector<model::Point2>>;

/// A rectangle along the axes.
struct Box {
  double left = 0, right = 0, bottom = 0, top = 0;
  bool meets(const Box& other) const {
    return left <= other.right && other.left <= right && bottom <= other.top && other.bottom <= top;
  }
};
/// The box around the polygon; left > right without points.
Box box_of(const FlatPolygon& polygon);

/// Area of the union, each place counted once, in double precision and without a grid: geometry::unite rounds to
/// 1/1024 m, so that a wall in 500 triangles would have another area than the same wall in one piece.
///
/// Slabs between neighbouring x of corners and crossings, in which the covered length is linear in x, so that the
/// middle of a slab gives its area exactly. Crossings at angles that move less than 1e-10 m within a slab are passed
/// over. Cost O(slabs x edges in a slab x log), plus crossings.
double union_area(std::span<const FlatPolygon> polygons);

/// The same of what lies within `window`.
double union_area(std::span<const FlatPolygon> polygons, const Box& window);

}  // namespace blockrand::compare
