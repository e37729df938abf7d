// The level of still water.
#pragma once

#include <optional>

#include "pipeline/surroundings/ground_claims.h"
#include "pipeline/surroundings/ground_height.h"

namespace blockrand::surroundings {

/// Whether an area of water is level: natural=water but of rivers, canals and streams, basins, reservoirs, docks, pools, fountains.
bool is_still_water(const TagOf& tag);

/// m: the height of the banks of a still water: the lowest decile of the terrain along its outline. The outline is known whole wherever a
/// part of it is asked for, so all squares have one level.
/// \return nothing without terrain, for water that is not still, and where half of the outline lies much higher than its lowest decile:
/// a river that nobody tagged as one, or terrain that does not fit
std::optional<double> bank_level(const ClaimFinder& claims, const Thing& thing, bool area, const HeightAt& terrain);

}  // namespace blockrand::surroundings
