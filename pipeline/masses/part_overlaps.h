// Parts of one building whose solids overlap.
#pragma once

#include "pipeline/model/region.h"

namespace blockrand::masses {

/// Tells each pair of parts of a building whose solids overlap by more than 1 cm and 0.01 m³
/// (geometry/solid_overlap.h): a row OVERLAP_KEPT at the first, with the other and the volume. Repair cuts plans by
/// what tags say of heights; what stays are roofs that a dormer is mapped into, slabs whose underside nobody tagged,
/// and heights that contradict each other. Nothing is changed. \param region  with masses
void tell_part_overlaps(model::Region& region);

}  // namespace blockrand::masses
