// What a GLB tells people about each building part: the attribute profile `people`.
#pragma once

#include "pipeline/model/region.h"
#include "pipeline/outputs/gltf/property_table.h"

namespace blockrand::outputs {

/// One row per part of every owned building, in the order of the region. Columns, in the order in which viewers list them:
/// address, name, use, year, era, style with its confidence, storeys, heights, roof, walls; then `sources`, which says where
/// the values come from, `fallbacks`, level of detail and ids. Lengths to 0.1 m, angles to 1 degree, storeys to 0.1, the
/// confidence to 0.01. Columns have the names that building_table() gives them.
///
/// `sources` groups the columns by source, in the order of model::Source: "tag: use, storeys; neighbours: height". The source
/// of `built_roof` is that of the shape which was asked for and stands there as `roof_shape`.
/// \param evidence  also the column `evidence`, as building_table() has it
PropertyTable people_table(const model::Region& region, bool evidence);

}  // namespace blockrand::outputs
