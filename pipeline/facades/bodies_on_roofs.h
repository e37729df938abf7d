// What the stages share that put bodies on roofs.
#pragma once

#include <vector>

#include "pipeline/attributes/defaults.h"
#include "pipeline/model/region.h"

namespace blockrand::facades {

/// Built before 1919, as its style or its era says: chimneys for stoves, fire walls, roofs of tiles.
bool is_old(const model::Attributes& attributes);

/// Houses of people, and old houses of shops and offices; no churches, halls and sheds.
bool has_hearths(const model::Attributes& attributes, const attributes::Defaults& defaults);

/// m above the height reference.
struct HeightExtent {
  double low = 0, high = 0;
};
HeightExtent extent_of(const model::Solid& solid);
/// Of what was built; as its tags say where nothing was.
HeightExtent extent_of(const model::BuildingPart& part);

/// The largest body with LoD2 that is not half covered by higher ones of its building (own choice); null for canopies and
/// the like.
model::BuildingPart* main_body(model::Building& building);

/// What each edge of the plan that a body stands on is to its roof.
std::vector<model::RoofEdge> edges_of_plan(const model::Building& building, const model::BuildingPart& body,
                                           const model::Polygon& plan);

/// Whether the interior of `made` meets that of a body of the building, or of what stands on one.
/// \param but_for  a part that is not asked; may be null
bool meets_a_body(const model::Building& building, const model::RoofInstallation& made,
                  const model::BuildingPart* but_for = nullptr);

}  // namespace blockrand::facades
