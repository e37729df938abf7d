// What the stages share that put bodies on roofs.
#pragma once

#include "pipeline/model/region.h"

namespace blockrand::facades {

/// Built before 1919, as its style or its era says: chimneys for stoves, fire walls, roofs of tiles.
bool is_old(const model::Attributes& attributes);

/// Whether the interior of `made` meets that of a body of the building, or of what stands on one.
/// \param but_for  a part that is not asked; may be null
bool meets_a_body(const model::Building& building, const model::RoofInstallation& made,
                  const model::BuildingPart* but_for = nullptr);

}  // namespace blockrand::facades
