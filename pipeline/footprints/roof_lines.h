// Ridges, edges and apexes that mappers draw on roofs, given to the bodies on whose plans they lie.
#pragma once

#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"
#include "pipeline/model/roof_line.h"

namespace blockrand::footprints {

/// m. How far an outline may have moved from the nodes that a line had in common with it: repair moves walls by less.
inline constexpr double kRoofLineReach = 0.6;

/// The line as it lies on a repaired plan: points whose OSM node the plan has go where that went; other ends of lines
/// within kRoofLineReach of the boundary, and points as near outside, go onto it, to a corner where one is within half
/// of that. Empty when a point lies farther outside. \param inside  set when some of the line lies inside the plan, not
/// on its boundary
std::optional<model::RoofLine> fit_roof_line(const model::RoofLine& line, const model::Polygon& plan, bool& inside);

/// Gives each body the lines on its plan: a line lies on the smallest plan of its building that holds all of it, and
/// one that runs along boundaries on every plan that has such another line. Bodies on which no ridge lies get none.
void fit_roof_lines(model::Building& building, const std::vector<model::RoofLine>& near);

/// All such lines of an extract. Read-only after construction, safe to share between threads.
class RoofLineFinder {
 public:
  RoofLineFinder(const model::Extract& extract, const georef::Projection& projection);
  /// fit_roof_lines for every building of a region that has plans.
  void fit(model::Region& region) const;
  /// The lines that plans in `box` may get, by id.
  std::vector<model::RoofLine> near(const PlanBox& box) const;

 private:
  std::vector<model::RoofLine> lines_;  ///< by id
  BoxIndex boxes_;
};

}  // namespace blockrand::footprints
