// Which street a stretch of an outline faces.
#pragma once

#include <span>
#include <vector>

#include "pipeline/context/edge_samples.h"
#include "pipeline/model/building.h"

namespace blockrand::context {

/// The name of a class in outputs: `residential`, `living_street`, ...
std::string_view name(LineClass kind);

/// Fills street, name, class, distance, angle and visibility of a stretch from what its samples see.
///
/// The street is the one that takes most of the view (pieces of one name count together; for a front the view straight
/// ahead alone), of it the line nearest to the middle of the stretch; a stretch on a square belongs to it. Stretches
/// without samples that see a street keep none.
void face_street(const OutlineEdge& edge, std::span<const EdgeSample> samples, const BuildingView& view,
                 model::FacadeEdge& stretch);

}  // namespace blockrand::context
