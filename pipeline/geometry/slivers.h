// Slivers: what a cut along a wall that is almost another wall leaves between the two.
#pragma once

#include <optional>
#include <vector>

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// m. A point this near to a wall lies on it: rounding moves it half a grid step each way.
inline constexpr double kOnWall = 1.5 / model::kGridStepsPerMetre;

/// Corners of a ring between legs that run back over each other: a single point, or an edge of at most `width` metres,
/// where the shorter leg is longer than `width` and ends within `width` of the longer one.
struct Sliver {
  std::size_t first = 0, last = 0;  ///< index of the tip's first and last point; equal for a pointed one
  double length = 0;                ///< m, of the shorter leg
  double width = 0;                 ///< m, from where the shorter leg starts to the longer one
  bool outward = true;              ///< made of inside; else a crack. For rings with their inside on the left
};
/// The sliver whose tip begins at point `first` of the ring.
std::optional<Sliver> sliver_from(const model::Ring& ring, std::size_t first, double width);

/// Cuts the outward slivers of all rings off, where the shorter leg starts: at that point, if it lies on the longer leg
/// (kOnWall), else straight across to the longer leg. What is cut off is all that changes, but for rounding the new
/// corner to the grid; other corners stay where they are. Cracks stay: to fill them could take ground from others.
/// Requires a strictly simple polygon, its outer ring counter-clockwise, its holes clockwise; it stays so: where it would
/// not, nothing is cut.
/// \return how many slivers were cut off
int cut_slivers(model::Polygon& polygon, double width);
int cut_slivers(std::vector<model::Polygon>& polygons, double width);

}  // namespace blockrand::geometry
