// Frames: directions modulo a quarter turn, and which of them are one.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "pipeline/model/vector.h"

namespace blockrand::repair {

inline model::Point2 unit(model::Point2 a) {
  const double n = std::sqrt(dot(a, a));
  return n > 0 ? model::Point2{a.x / n, a.y / n} : model::Point2{1, 0};
}
/// The same direction modulo a quarter turn, with x > 0 and y >= 0.
model::Point2 first_quarter(model::Point2 u);
/// Sine of the angle from the nearer axis of `frame` to `v`, counter-clockwise; within +-sin 45 degrees. Unit vectors.
double turn_off(model::Point2 frame, model::Point2 v);
/// The vector turned by a small angle, of which `turn` is the tangent.
inline model::Point2 turned(model::Point2 u, double turn) { return unit({u.x - turn * u.y, u.y + turn * u.x}); }

struct Frame {
  std::uint32_t building = 0;
  model::Point2 axis;  ///< unit vector
  double weight = 0;   ///< m². Noise of s m at a corner turns it by s / sqrt(weight) radians
};

/// Which frames are one.
struct FrameGroups {
  std::vector<std::uint32_t> group;  ///< per frame: the least frame of its group
  std::vector<model::Point2> axes;   ///< per frame: where it is the least of its group, the group's axis
};

/// Merges frames as long as any two of `pairs` differ by no more than three standard deviations, the most alike first.
/// \param leader  per frame: the least one of those that are one already
/// \param pairs   frames of neighbours; only these are compared
/// \param noise   m, standard deviation of a corner's coordinate
FrameGroups group_frames(const std::vector<Frame>& frames, std::vector<std::uint32_t> leader,
                         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs, double noise);

}  // namespace blockrand::repair
