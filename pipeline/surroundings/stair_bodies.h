// Flights of steps.
#pragma once

#include <optional>

#include "pipeline/surroundings/body_site.h"

namespace blockrand::surroundings {

/// highway=steps as treads that rise along the way, where its rise is known:
///
/// * over terrain, by what the terrain rises between its ends. Treads are as long as the ground below them needs, so that they lie on it
///   and nowhere below it; `step_count` tells how many there are where it makes risers of 8 to 25 cm, else they are about 15 cm high;
/// * on level ground, by `step_count` or a number in `incline`, where the way leads to a building. A flight elsewhere would end in
///   the air: the ground above it is not known.
///
/// Nowhere steeper than 15 to 25 cm; none where the way rises and falls, within buildings, on carriageways, tracks or water.
/// \return nothing where no tread is made: the ground of the steps stays a surface
std::optional<model::SurroundingBody> stair_bodies(const BodySite& site, const Thing& thing);

}  // namespace blockrand::surroundings
