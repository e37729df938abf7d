// A wall of a solid as a flat drawing: what facades are laid out and cut in.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/model/solid.h"

namespace blockrand::facades {

/// An upright face in its own coordinates: u to the viewer's right seen from outside, v up; metres.
struct WallFrame {
  std::uint32_t face = 0;                         ///< of the solid
  model::Point2 start;                            ///< where u = 0: the left end of the wall, on the 1/1024 m grid
  model::Point2 along;                            ///< unit vector of u
  double base = 0;                                ///< height of v = 0: the lowest point of the face
  double length = 0, height = 0;                  ///< m, of the box around it: u and v run from 0 to these
  std::vector<std::vector<model::Point2>> loops;  ///< outer first, counter-clockwise; holes clockwise

  model::Point2 outward() const { return {along.y, -along.x}; }
  /// Not rounded. \param depth  m into the building
  model::Point3 at(model::Point2 p, double depth = 0) const {
    const model::Point2 out = outward();
    return {start.x + along.x * p.x - out.x * depth, start.y + along.y * p.x - out.y * depth, base + p.y};
  }
};

/// None for faces that are no walls, lean by more than kLeaningWall, or are shorter than kShortestWall.
std::optional<WallFrame> wall_frame(const model::Solid& solid, std::uint32_t face);

inline constexpr double kLeaningWall = 0.002;  ///< m across; points on the grid lie up to 0.0007 m off an upright plane
inline constexpr double kShortestWall = 0.02;  ///< m

}  // namespace blockrand::facades
