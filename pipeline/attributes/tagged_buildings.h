// Who speaks for untagged neighbours: the tagged buildings of an extract.
#pragma once

#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"

namespace blockrand::attributes {

/// The buildings whose storeys or roof are mapped, in the extract's order: who speaks for its neighbours.
std::vector<context::TaggedBuilding> tagged_buildings(const model::Extract& extract, const Defaults& defaults,
                                                      const georef::Projection& projection);

}  // namespace blockrand::attributes
