// Walls of several pieces lie in one line.
#pragma once

#include "pipeline/footprints/repair/terrace_row.h"

namespace blockrand::repair {

/// Moves `Corner::start` so that the pieces of each wall (TerraceRing::wall) lie in one line: first the wall's ends go across
/// the wall to where a least squares line through all that was said puts them, then what stands between them goes to the
/// line. Fixed corners stay. No corner is moved to where it would be farther than `bound` metres from what a footprint
/// said; such walls keep a bend.
void straighten_walls(TerraceGraph& graph, double bound);

}  // namespace blockrand::repair
