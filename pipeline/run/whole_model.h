// The tiles of a build as one region, for files of the whole build.
#pragma once

#include "pipeline/model/region.h"

namespace blockrand::run {

/// Appends a tile: buildings, elements and, where it is asked for, evidence, whose numbers then count from the whole's
/// beginning. Call in tile order.
void append_region(model::Region& whole, model::Region&& tile, bool with_evidence);

}  // namespace blockrand::run
