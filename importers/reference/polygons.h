// A model's polygons as a whole. Internal to this folder.
#pragma once

#include <vector>

#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// Takes out the polygons that are marked, with every use of them, and geometries that become empty.
/// \param marked  as many as there are polygons
void drop_polygons(ReferenceModel& model, const std::vector<bool>& marked);

}  // namespace blockrand::importers::reference
