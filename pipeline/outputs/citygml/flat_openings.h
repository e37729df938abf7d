// Openings for a leaner CityGML: windows and doors in the plane of their walls, reveals as numbers.
#pragma once

#include <vector>

#include "pipeline/model/facade.h"

namespace blockrand::outputs {

/// A LoD3 solid whose windows and doors close their holes flush.
struct FlatOpenings {
  model::Detail detail;       ///< solid and openings alone: no reveals but the tunnels of passages
  std::vector<double> depth;  ///< m by opening: how far behind its wall it really lies; 0 for passages
};

/// Moves the polygons of windows and doors out to their walls, where they fill the holes point for point, and leaves
/// their reveals out. A valid solid stays valid: seen along the normal of a wall, what was apart stays apart.
FlatOpenings flat_openings(const model::Detail& detail);

/// The depth that most openings of each face have, by face; 0 where most are flush or there are none. Of equally many
/// the least.
std::vector<double> usual_depths(const FlatOpenings& flat);

}  // namespace blockrand::outputs
