// Wires between mapped supports: power lines and aerialways.
#pragma once

#include <optional>
#include <vector>

#include "pipeline/surroundings/body_site.h"

namespace blockrand::surroundings {

/// m. A longer span has supports that nobody mapped.
inline constexpr double kMostSpan = 1500;

/// Whether a thing is a line of wires: power=line, minor_line; aerialway=* but pylons and stations.
bool has_wires(const SurroundingInputs& in, const Thing& thing);

/// rad from east: where a support's line leads, between its neighbours. Nothing for nodes that no line of wires has.
std::optional<double> wire_direction(const SurroundingInputs& in, const ClaimFinder& claims, std::int64_t node);

/// Wires between neighbouring supports of a line, as sagging pieces. They hang where the shapes of both supports hold them
/// (Catalogue::wires_of). An end of an aerialway without a pylon is a station.
///
/// A span is left out where a support is not mapped or not in the extract, is of a kind without wires, stands in a building, or where
/// wires would come near a roof. A line without any span is not modelled, and told so.
/// \param anywhere  the ground, wherever a line leads
std::optional<model::SurroundingBody> wire_bodies(const BodySite& site, const Thing& thing,
                                                  const GroundAtPlace& anywhere);

}  // namespace blockrand::surroundings
