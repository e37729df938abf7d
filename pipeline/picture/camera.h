// From where a scene is seen.
#pragma once

#include <span>

#include "pipeline/picture/scene.h"

namespace blockrand::picture {

enum class Projection { perspective, orthographic };

/// A camera in the scene's coordinates. `right`, `up` and `forward` are unit vectors at right angles.
struct Camera {
  Projection projection = Projection::perspective;
  Point3 eye{0, -10, 5};
  Point3 right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};
  double field_of_view = 35;  ///< degrees from the lower to the upper edge of the picture (perspective)
  double height = 10;         ///< m from the lower to the upper edge (orthographic); pixels are square
  double near = 0.1;          ///< m. Nothing nearer to the eye is seen (perspective).
};

/// A perspective camera at `eye` that has `target` in the middle of the picture, upright. Looking straight down (or up),
/// north is up (or down).
/// \param field_of_view  degrees, upright, below 180
Camera look_at(Point3 eye, Point3 target, double field_of_view = 35);

/// Where a camera looks from: `azimuth` is the direction of the viewer as seen from the target, clockwise from north
/// (180: from the south); `elevation` is 0 level with the target and 90 straight above it. Degrees.
struct Direction {
  double azimuth = 215, elevation = 35;
};

/// The nearest perspective camera in that direction that sees all `points` with a margin.
/// \param aspect  width of the picture divided by its height
/// \param margin  share of the picture's half-width and half-height that stays free on each side
Camera fit_perspective(std::span<const Point3> points, Direction from, double aspect, double field_of_view = 35,
                       double margin = 0.04);

}  // namespace blockrand::picture
