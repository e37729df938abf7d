// Slips of the mouse: repeated points and spikes.
#pragma once

#include "pipeline/model/polygon.h"
#include "pipeline/repair/options.h"

namespace blockrand::repair {

struct RingCleaning {
  int duplicates = 0;  ///< points removed because they repeat their predecessor
  int spikes = 0;      ///< tips removed
};

/// Removes points nearer than `duplicate_distance` to their predecessor, and tips: corners where the ring turns back so
/// that the shorter leg's end lies within `spike_width` of the longer leg. Repeats until nothing changes. A ring may end
/// with fewer than three points; it has no area then. The result does not depend on where the ring starts unless
/// several spikes share a point.
RingCleaning clean_ring(model::Ring& ring, const RepairOptions& options);

}  // namespace blockrand::repair
