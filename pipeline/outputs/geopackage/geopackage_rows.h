// What the GeoPackage says of a tile's buildings, prepared away from the file.
#pragma once

#include "pipeline/layer_file/table.h"
#include "pipeline/model/region.h"

namespace blockrand::outputs {

using layer_file::Cell;
using layer_file::CellTable;

/// The rows of a tile.
struct GeoPackageRows {
  CellTable buildings, parts, wall_segments, surfaces;
};

/// Prepares the rows of the owned buildings of `region` that have at least one part, in their order; of parts and of
/// wall segments of the outline in the order of their buildings. Pure: safe on any thread, the same region gives the same rows. This is the expensive half
/// of the work, GeoPackageWriter::add the cheap one.
///
/// Parts have the ids of all other outputs: a part that has its building's id beside other parts becomes "<id>.1". The
/// footprint of a building is its outline, or the plans of its parts where it has none.
/// Surfaces are the faces of each body's solid of LoD2 (LoD1 where it has no other), a row for each class and colour.
/// \param lod  the level of detail that was asked for: decides a building's `state`, as in build.json
GeoPackageRows geopackage_rows(const model::Region& region, int lod);

}  // namespace blockrand::outputs
