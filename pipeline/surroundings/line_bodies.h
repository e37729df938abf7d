// Bodies along mapped lines: walls, fences, hedges, rails, decks of bridges.
#pragma once

#include <vector>

#include "pipeline/surroundings/body_site.h"

namespace blockrand::surroundings {

/// The bodies of a thing that is in the open, or of those of its segments whose middles the tile has; none for things that have none.
///
/// * barrier=*: a strip as high and wide as tags say, else as usual for its kind, which follows the ground; open where a gate or a
///   street is one of its points; none within buildings.
/// * highway=*: what is painted on it (street_markings.h), flights of steps (stair_bodies.h).
/// * railway=*: two rails of the gauge.
/// * bridge=* of streets and railways: a deck between the grounds at both ends of the run of bridges that it belongs to, raised as
///   far as its layer, what it crosses and a slope of 6 % (railways: 2.5 %) allow where the ground below is not low already; with its
///   strips, and railings.
/// * natural=cliff: cliff_bodies.h.
std::vector<model::SurroundingBody> line_bodies(const BodySite& site, const Thing& thing);

}  // namespace blockrand::surroundings
