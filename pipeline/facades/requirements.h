// Whether houses keep what their presets promise: read off the finished LoD3, told house by house.
#pragma once

#include <span>

#include "pipeline/masses/built_mass.h"
#include "pipeline/model/region.h"
#include "styles/districts/presets.h"

namespace blockrand::facades {

/// Measures every house whose preset states requirements (districts::PresetRequirements) and reports each that is missed as
/// REQUIREMENT_MISSED: what, by how much, which preset; of each kind the worst, once. Windows are those of the main body's
/// fronts on streets; what has no windows, gable or dormer misses nothing but the gable that it should have. Distances from the
/// eaves are taken straight, which on a slope is along it. Houses that stay below LoD3 are left out.
/// \param built  of the tile, with the roofs that LoD3 has
void check_requirements(model::Region& region, const masses::BuiltMasses& built,
                        std::span<const districts::Preset> presets);

}  // namespace blockrand::facades
