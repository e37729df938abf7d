// Roofs as what a bird sees: the highest of a building's planes over each point. Measures that are taken alike of any
// model's roofs. Shares no code with the builder of roofs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/model/point.h"
#include "pipeline/model/polygon.h"

namespace blockrand::compare {

/// Planes steeper than this are walls: tangent of 85 degrees. Steep sides of mansard roofs have up to 80.
inline constexpr double kSteepest = 11.4;
/// Tangent of 5 degrees: less steep is flat. Survey's flat roofs drain.
inline constexpr double kFlatSlope = 0.0875;

/// Planes seen from above.
class RoofSurfaces {
 public:
  struct Hit {
    double z = 0;          ///< m
    model::Point2 uphill;  ///< gradient of z: its length is the tangent of the slope
  };
  /// A flat face by its boundary rings, the outer one first, in any direction; walls are left out.
  void add(const std::vector<std::vector<model::Point3>>& rings);
  bool empty() const { return faces_.empty(); }
  std::optional<Hit> at(model::Point2 p) const;
  double highest() const { return highest_; }

 private:
  struct Face {
    std::vector<std::vector<model::Point2>> rings;
    model::Point2 minimum, maximum;
    model::Point3 centre;
    model::Point2 uphill;
  };
  std::vector<Face> faces_;
  double highest_ = -1e9;
};

/// m above the ground.
struct RoofHeights {
  double ridge = 0;  ///< highest point
  double eaves = 0;
  double mean = 0;   ///< over the part of the plan that the roof covers: volume over area
  double cover = 0;  ///< that part, share of the plan
};

/// Ridge: the highest corner of a roof face. Eaves: the outline is walked in steps of 0.5 m; a step counts where the
/// roof above it is flat (below 5 degrees) or rises inwards (within 45 degrees of square to the outline), so that
/// gables and the high side of lean-to roofs do not; its height is that of the plane 0.3 m inside, continued to the
/// outline, so that overhangs and walls a little beside the survey's do not matter; the median of the steps is the
/// eaves' height. Empty when the roof covers less than half of the outline or plan.
std::optional<RoofHeights> heights_of(const RoofSurfaces& roof, const std::vector<model::Polygon>& outline,
                                      double ground);

/// Points of a square grid of 0.5 m (coarser on plans over 1,000 m²: at most about 4,000 points) that lie in both
/// plans, 0.5 m and more from both outlines.
std::vector<model::Point2> common_grid(const std::vector<model::Polygon>& a, const std::vector<model::Polygon>& b);

/// Roof form as the planes show it, whatever it is called.
struct RoofPlanes {
  double seen = 0;                 ///< share of the points with a roof above them
  double sloped = 0;               ///< share of the points with a slope of 5 degrees and more
  double spread = 0;               ///< m, standard deviation of the height: error of the best horizontal roof
  std::vector<double> directions;  ///< degrees clockwise from north, down the slope: into which 8 % of the points slope
  bool two_pitches = false;        ///< each of the two main directions has pitches 15 degrees apart
  double pitch = 0;                ///< degrees, mean of the sloped points
};
RoofPlanes form_of(const RoofSurfaces& roof, std::span<const model::Point2> points);

}  // namespace blockrand::compare
