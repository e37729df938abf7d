// Mass models: the solids of a part at LoD1 and LoD2, checked, with a ladder of simpler ones behind each.
#pragma once

#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/options.h"
#include "pipeline/masses/built_mass.h"
#include "pipeline/model/region.h"

namespace blockrand::masses {

/// Builds `lod1` and `lod2` (up to the asked level) of every part of the region's owned buildings.
///
/// LoD1 is the plan extruded to half the roof's height: the block of the same volume. LoD2 has the roof whose ridges are
/// drawn on the plan, or the asked one between its neighbours; what does not fit or fails the solid check is built simpler:
/// with slopes for every bay, on a plan simplified by `simplify_tolerance`, without regard to the row (ROOF_ROW_IGNORED),
/// hipped, flat, flat on the simplified plan, LoD1 alone. Each step but the first is
/// noted in `BuildingPart::fallbacks` and in the region's report. A part without any solid keeps lod 0 (its footprint)
/// or, with no plan, -1.
/// Every solid that leaves is valid in the sense of geometry::check_solid.
/// \return plan and roof of every `lod2`, those of the step that was taken
BuiltMasses build_masses(model::Region& region, const attributes::Defaults& defaults,
                         const attributes::GenerateOptions& options, int lod);

}  // namespace blockrand::masses
