// The models that overrides name in the place of buildings: read before the extract, placed when the build's CRS is known.
#pragma once

#include <span>
#include <vector>

#include "importers/reference/reference_model.h"
#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/overrides.h"
#include "pipeline/georef/projection.h"
#include "pipeline/masses/replace_buildings.h"

namespace blockrand::run {

struct ReadLandmark {
  model::OsmId building;
  attributes::OverrideModel order;
  std::string told_from;  ///< "overrides.toml:12"
  importers::reference::ReferenceModel model;
  bool has_place = false;  ///< it says where on the Earth it lies; glTF is read in its own axes
};

/// \throws base::InputError  with the file that cannot be read, or that contradicts its order (a place for one that has its own)
std::vector<ReadLandmark> read_landmarks(const attributes::Overrides& overrides);

/// Their highest level of detail as surfaces in the build's CRS, the lowest point on the ground. A closed valid surface is a solid.
/// \throws base::UsageError  where no way leads from a model's CRS to the build's
masses::LandmarkModels place_landmarks(std::span<const ReadLandmark> landmarks, const georef::Projection& projection,
                                       const attributes::Defaults& defaults);

}  // namespace blockrand::run
