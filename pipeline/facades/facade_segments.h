// Which wall segment of which wall faces what: facades are laid out wall segment by wall segment.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/facades/wall_frame.h"
#include "pipeline/model/building.h"

namespace blockrand::facades {

/// A piece of a wall with one situation, all wall segments of the outline with the same kind side by side taken together.
struct FacadeSegment {
  std::uint32_t wall = 0;   ///< index into the walls given
  double from = 0, to = 0;  ///< m along the wall
  model::WallSegmentKind kind = model::WallSegmentKind::unknown;
  std::vector<std::uint32_t> edges;  ///< indices into Building::edges, from left to right; none for `unknown`
  bool starts_wall = false, ends_wall = false;  ///< its ends are corners of the building
  /// Degrees that the walls of the body turn at its ends, positive at corners that stand out; 0 where the wall goes on,
  /// where no wall follows, or one with another base or other eaves.
  double turn_left = 0, turn_right = 0;
  std::optional<model::WallSegmentKind> kind_left,
      kind_right;  ///< of the wall segments beyond; none where no wall follows
  double length() const { return to - from; }
};

/// m. A wall and a wall segment of the outline that far apart are the same: walls may stand on a simplified plan.
inline constexpr double kSameWall = 0.3;
/// m. Shorter pieces are left out.
inline constexpr double kShortestFacadeSegment = 0.05;

/// Wall segments of all walls, by wall and from left to right; what no wall segment of the outline runs along (walls above lower
/// parts of the same building) is `unknown`.
std::vector<FacadeSegment> facade_segments(const model::Building& building, std::span<const WallFrame> walls);

}  // namespace blockrand::facades
