// What images show of roofs, handed to the buildings of a tile.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/model/region.h"
#include "pipeline/observation/imagery.h"

namespace blockrand::observation {

/// Fills Building::seen_roof. \param numbers  of the region's buildings, in their order
void put_seen_roofs(model::Region& region, std::span<const std::uint32_t> numbers, const ImageryObservations& seen);

}  // namespace blockrand::observation
