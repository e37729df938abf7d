// What is painted on streets: lines between lanes, crossings, stop lines.
#pragma once

#include <optional>

#include "pipeline/surroundings/body_site.h"

namespace blockrand::surroundings {

/// * Lines between lanes where `lanes` or the class tells of two, away from junctions and crossings.
/// * Crossings that are marked.
/// * Stop lines of highway=stop, highway=traffic_signals; broken ones of highway=give_way. They lie at their node, before a
///   marked crossing that is there, across the lanes of the direction that `direction` or `traffic_signals:direction` tells;
///   where no tag tells, of that to the nearest junction. Of signals at the node of a junction itself: where each of its ways comes to it.
/// \return nothing where nothing is painted
std::optional<model::SurroundingBody> street_markings(const BodySite& site, const Thing& thing);

}  // namespace blockrand::surroundings
