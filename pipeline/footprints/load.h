// From the extract's raw rings to a tile's buildings in the build CRS.
#pragma once

#include <vector>

#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"

namespace blockrand::footprints {

/// The buildings of a shard with their rings projected and rounded to the 1/1024 m grid. A part that stands alone is a
/// building of its own with its rings as outline; several without outline are a building without rings that has the id
/// and tags, but not the attributes, of the first. Notes ANTIMERIDIAN.
model::Region load_region(const model::Extract& extract, const Shard& shard, const georef::Projection& projection);

/// The middle of each building in the build CRS: where the data is (context::coverage_of).
std::vector<model::Point2> building_places(const model::Extract& extract, const georef::Projection& projection);

}  // namespace blockrand::footprints
