// Footprints made valid, and the rule of outline and parts.
#pragma once

#include "pipeline/model/region.h"
#include "pipeline/repair/options.h"

namespace blockrand::repair {

/// Turns every building's rings as mapped into strictly simple polygons (`Building::outline`, `BuildingPart::plan`).
///
/// Without mapped parts a building gets one part per polygon of its outline. With mapped parts the outline is not built
/// (Simple 3D Buildings: parts describe the whole); what they leave of it is, when it is larger than
/// `parts_free_area` and wider than `parts_free_width` (part "….rest", PARTS_INCOMPLETE). When no part survives, the
/// outline is built.
/// A building without any polygon keeps no parts and has its `failure` set: TOO_FEW_POINTS or ZERO_AREA.
/// Everything that was mended is a row in `region.report`. Reads nothing but the building itself.
void repair(model::Region& region, const RepairOptions& options);

}  // namespace blockrand::repair
