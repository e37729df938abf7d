// Parts of one building whose solids overlap.
#pragma once

#include "pipeline/model/region.h"

namespace blockrand::masses {

/// Tells each pair of parts of a building whose interiors meet at LoD1, 2 or 3 (geometry::kLeastCommonVolume):
/// a row OVERLAP_KEPT at the first, with the other and the volume. Repair cuts plans by
/// what tags say of heights and nodes them on the grid; what stays are parts within the roof of another, and corners
/// between two straightened walls that leave them no place. Nothing is changed. \param region  with masses
void tell_part_overlaps(model::Region& region);

}  // namespace blockrand::masses
