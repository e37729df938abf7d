// The walls of one building, each shifted along its normal to where the image shows its edge.
//
// A rigid movement brings an outline to its place (row_match.h); what was drawn too wide or too narrow stays so. Here each
// wall is looked for by itself, within a bound, along its normal alone, and new corners are where the lines of the shifted
// walls meet: least-squares or snake methods (Kass, Witkin and Terzopoulos, Snakes, 1988) bend outlines, this one does not.
#pragma once

#include <vector>

#include "pipeline/geometry/box_index.h"
#include "pipeline/observation/image_windows.h"
#include "pipeline/observation/imagery.h"
#include "pipeline/observation/wall_shifts.h"

namespace blockrand::observation {

/// m: how far a wall may be shifted unless a user says otherwise, and the most that may be said.
inline constexpr double kRefineWithin = 1.0, kMostRefineWithin = 2.0;

/// One building, as the image is searched for its walls.
struct RefinedBuilding {
  Rings rings;                           ///< where it stands by what was decided of its row
  std::vector<std::vector<char>> fixed;  ///< as find_walls() has it
  model::Point2 seen;                    ///< m: how far the image shows its roof from its plan
  model::Point2 lean;                    ///< m: of that, from its ground: without the image's own shift
  model::Point2 doubt;  ///< m: by how much another height, as likely as not, would show it farther along the lean
};

/// What the image shows of a building's walls within `bound` m of where they stand. \returns  `left_alone` with a reason, or `refined`
/// with `to`, confidence and evidence; `from` is the caller's to set.
/// Deterministic. Cost: a few thousand pixels for ten metres of wall.
RefinedOutline refine_edges(const RefinedBuilding& building, const ImageWindows& windows, double bound);

}  // namespace blockrand::observation
