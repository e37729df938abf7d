// From the extract's raw rings to a tile's buildings in the build CRS.
#pragma once

#include <vector>

#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/generate/defaults.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"
#include "pipeline/region/shard.h"

namespace blockrand::region {

/// The buildings of a shard with their rings projected and rounded to the 1/1024 m grid. A part that stands alone is a
/// building of its own with its rings as outline; several without outline are a building without rings that has the id
/// and tags, but not the attributes, of the first. Notes ANTIMERIDIAN.
model::Region load_region(const model::Extract& extract, const Shard& shard, const georef::Projection& projection);

/// The buildings whose storeys or roof are mapped, in the extract's order: who speaks for its neighbours.
std::vector<context::TaggedBuilding> tagged_buildings(const model::Extract& extract, const generate::Defaults& defaults,
                                                      const georef::Projection& projection);

/// The middle of each building in the build CRS: where the data is (context::coverage_of).
std::vector<model::Point2> building_places(const model::Extract& extract, const georef::Projection& projection);

}  // namespace blockrand::region
