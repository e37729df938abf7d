// From a skeleton's exact faces to surfaces that stay valid when their corners are rounded to the grid.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/geometry/weighted_skeleton.h"
#include "pipeline/model/point.h"
#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// Surfaces over a plan. Edges are numbered as the plan's.
struct RoofSurfaces {
  struct Surface {
    std::uint32_t edge = 0;  ///< WeightedSkeletonFace::edge
    std::uint32_t level = 0;
    bool upright = false;
    std::vector<std::vector<model::Point3>> loops;  ///< counter-clockwise from outside, holes follow; z above the eaves
  };
  std::vector<Surface> surfaces;
  /// For each plan edge what its wall ends with above, from the edge's start to its end; two points for most.
  std::vector<std::vector<model::Point3>> wall_tops;
};

/// Rounds a skeleton to the grid and takes out what would not survive that: nodes nearer than kMergedNodes are one, a
/// node nearer than kNarrowestFace to another border of its face is put on that border, and what has no area after that
/// is left out. Nothing moves by more than a few millimetres, corners of the plan not at all; neighbouring surfaces
/// keep the same points on both sides.
///
/// \param height_scale  heights are multiplied by this
/// \param coarseness    both distances are multiplied by this: for a second try where the solid fails its check
RoofSurfaces roof_surfaces(const model::Polygon& plan, const WeightedSkeleton& skeleton, double height_scale,
                           double coarseness = 1);

/// m. Simultaneous events of walls that are rounded come as several nodes a few millimetres apart. Merging them leaves
/// faces plane within the checker's 0.01 m.
inline constexpr double kMergedNodes = 0.005;
/// m. Rounding moves a node by 0.7 mm; the checker refuses tips narrower than 2 mm.
inline constexpr double kNarrowestFace = 0.0035;

}  // namespace blockrand::geometry
