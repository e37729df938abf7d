// Cliffs and earth banks.
#pragma once

#include <optional>

#include "pipeline/surroundings/body_site.h"

namespace blockrand::surroundings {

/// natural=cliff, natural=earth_bank: an upright face along the line, which has the lower ground on its right, as high as `height` tells,
/// else 2 m. What the terrain falls across the line counts: only the rest of the height stands above it, half a metre at least.
/// None within buildings, on carriageways, tracks or steps.
std::optional<model::SurroundingBody> cliff_bodies(const BodySite& site, const Thing& thing);

}  // namespace blockrand::surroundings
