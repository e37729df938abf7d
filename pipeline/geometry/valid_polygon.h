// Validity and Boolean operations of polygons, on the 1/1024 m grid. GEOS does the hard work; what leaves this file is
// strictly simple: no ring touches itself or another ring, so that walls raised on it form a manifold.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "pipeline/geometry/footprint_overlap.h"
#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// True when no two edges of the rings cross, overlap or touch except neighbours at their common point, each ring has at
/// least three points and an area, and every hole lies inside the outer ring and in no other hole. Exact.
bool strictly_simple(const model::Polygon& polygon);

/// True when no corner of a ring lies within kOnWall (slivers.h) of another ring: rounding to floats, as in GLB, would let
/// the two cross.
bool rings_apart(const model::Polygon& polygon);
/// Where they are not apart: edges of two rings one of which ends that near to the other. At most `most` of them.
std::vector<std::pair<EdgeOf, EdgeOf>> almost_touching_edges(const model::Polygon& polygon, std::size_t most = 1000);

/// How rings were turned into polygons.
struct ValidPolygons {
  std::vector<model::Polygon> polygons;  ///< strictly simple, outer counter-clockwise, largest first
  bool changed = false;                  ///< something had to be mended (orientation does not count)
  bool separated = false;                ///< rings that touched were moved apart
  std::vector<model::Polygon> squares;   ///< that were added to move them apart, in part outside; they may overlap
  double dropped_area = 0;               ///< m² of pieces below `min_area`, or that could not be made simple
};

/// Makes polygons of rings as mapped. Each outer ring takes the inner rings that follow it (`inner[i]`).
/// GEOS's MakeValid with the STRUCTURE method decides what is inside; the result is rounded to the grid, and where rings
/// still touch or are not apart (rings_apart), a square of `clearance` metres joins the touching corners so that a wall of
/// that width stands between. Points that survive keep their node ids.
ValidPolygons make_valid(std::span<const model::Ring> rings, const std::vector<bool>& inner, double min_area,
                         double clearance);

/// The outlines of what a ring encloses, as strictly simple polygons; they may overlap where one lies in a court of
/// another. For rings that cross themselves very often (even_odd.h): MakeValid runs once, and of what it makes the courts,
/// which touch each other everywhere, are filled before anything is moved apart.
ValidPolygons outlines_of(const model::Ring& ring, double min_area, double clearance);

/// a minus b, as strictly simple polygons of at least min_area.
ValidPolygons difference(std::span<const model::Polygon> a, std::span<const model::Polygon> b, double min_area,
                         double clearance);

/// The union of valid polygons that may overlap and touch, as strictly simple polygons of at least min_area.
ValidPolygons unite(std::span<const model::Polygon> polygons, double min_area, double clearance);

/// Area common to a and b in m². Both must be valid.
double common_area(std::span<const model::Polygon> a, std::span<const model::Polygon> b);

}  // namespace blockrand::geometry
