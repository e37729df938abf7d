// Models by somebody else in the place of buildings: an override names them.
#pragma once

#include <memory>
#include <vector>

#include "pipeline/model/region.h"

namespace blockrand::masses {

/// A model, ready to stand for a building.
struct LandmarkModel {
  model::OsmId building;
  std::shared_ptr<const model::ReplacementModel> told;
  model::Solid surfaces;  ///< on the grid; z above the ground under the building. Closed where it is a valid solid
  model::SolidTriangles triangles;
  std::vector<bool> coloured;  ///< by face; the others look like the building
  std::size_t left_out = 0;    ///< faces whose rings cross or touch
  bool at_outline = false;     ///< x and y count from the middle of the outline, not from the CRS's origin
};

/// By building.
using LandmarkModels = std::vector<LandmarkModel>;

/// m: a model farther off the outline that it replaces is told (OVERRIDE_UNMATCHED) and replaces nothing.
inline constexpr double kFarthestModel = 2000;

/// Makes one body of each building that has a model, so that build_masses() gives it footprint and block. Its mapped parts are
/// represented by it.
void join_replaced(model::Region& region, const LandmarkModels& models);

/// After build_masses() to LoD2: the body's LoD2 is the model, its height the model's. Tells BUILDING_REPLACED, and
/// MODEL_NOT_CLOSED where the model is no valid solid.
void replace_buildings(model::Region& region, const LandmarkModels& models);

}  // namespace blockrand::masses
