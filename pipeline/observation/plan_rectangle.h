// The rectangle that a region of an image fills, drawn to the edges beside it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/observation/outline_score.h"

namespace blockrand::observation {

/// A rectangle in plan.
struct PlanRectangle {
  model::Point2 centre;
  model::Point2 along{1, 0};             ///< unit vector of its longer side
  double half_long = 0, half_short = 0;  ///< m
  double area() const { return 4 * half_long * half_short; }
  /// Counter-clockwise.
  std::vector<model::Point2> corners() const;
  /// m: farthest from its middle.
  double radius() const;
};

/// The rectangle of least area around a region, without its spurs: lines of pixels at its ends that are much shorter than
/// the others. Nothing of less than three pixels' width. \param pixels  numbers of the patch, ascending
struct FilledRectangle {
  PlanRectangle rectangle;
  double filled = 0;  ///< share of the rectangle that the region fills, times the region's share within it
};
std::optional<FilledRectangle> rectangle_of(const Patch& patch, std::span<const std::uint32_t> pixels);

/// A rectangle on the edges of an image.
struct EdgedRectangle {
  PlanRectangle rectangle;
  double score = 0;   ///< score_outline() of its four sides, in [0, 1]
  double around = 0;  ///< mean of the scores of its sides within 1.5 m
};

/// Turns a rectangle by up to 8 degrees and moves each of its sides by up to 1.5 m to where the image shows an edge.
/// Nothing where the image ends. \param contrast  as score_outline() has it
std::optional<EdgedRectangle> fit_to_edges(const PlanRectangle& rectangle, const Patch& patch, double contrast);

}  // namespace blockrand::observation
