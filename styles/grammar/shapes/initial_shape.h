// The shape that a derivation starts from.
#pragma once

#include <span>
#include <vector>

#include "styles/grammar/shapes/shape.h"

namespace blockrand::grammar {

/// One polygon of an initial shape, in world coordinates (x east, y up, z south; metres). The outline runs
/// counter-clockwise seen from where it faces (from above for footprints) and begins with the first edge, which is the
/// front; holes run the other way (those that do not are turned).
struct InitialPolygon {
  std::vector<Vector3> outline;
  std::vector<std::vector<Vector3>> holes;
};

/// Points nearer than this are one point, in metres: a tenth of a grid step, far below what a survey can tell.
inline constexpr double kSamePoint = 1e-4;

/// Makes the initial shape (docs/rule_language.md §0, §4.1,2): object coordinates with the origin at the first point of
/// the first edge, x along it, y along the normal of the first face; the pivot at the object's origin; the scope is the
/// bounding box in that frame, not turned. Edges without length are dropped and the first edge stays first. Polygons
/// with less than three points or without area are dropped; the result may be empty, with size 0. Vertices at the same
/// place are shared.
///
/// \param street_widths  for street.* selectors: metres by edge of the first polygon's outline (0 or less: no street);
/// empty when not known
Shape initial_shape(std::span<const InitialPolygon> polygons, std::vector<double> street_widths = {});

/// One polygon without holes.
Shape initial_shape(std::vector<Vector3> outline);

}  // namespace blockrand::grammar
