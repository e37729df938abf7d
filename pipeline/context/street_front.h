// Which street a wall segment of an outline faces.
#pragma once

#include <span>
#include <vector>

#include "pipeline/context/wall_samples.h"
#include "pipeline/model/building.h"

namespace blockrand::context {

/// The name of a class in outputs: `residential`, `living_street`, ...
std::string_view name(LineClass kind);

/// Fills street, name, class, distance, angle and visibility of a wall segment from what its samples see.
///
/// The street is the one that takes most of the view (pieces of one name count together; for a front the view straight
/// ahead alone), of it the line nearest to the middle of the wall segment; a wall segment on a square belongs to it. Wall segments
/// without samples that see a street keep none.
void face_street(const OutlineEdge& edge, std::span<const WallSample> samples, const BuildingView& view,
                 model::WallSegment& wall_segment);

}  // namespace blockrand::context
