// imagery.json: what the images of a build show. Written with it, and read where a tile of it is built alone.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/observation/imagery.h"

namespace blockrand::outputs {

/// \param footprints  whose numbers the receipts have
/// \param here        by number: whether a building is told
std::string imagery_json(const observation::ImageryObservations& observations,
                         const footprints::FootprintStore& footprints, const std::vector<bool>& here);

/// What a tile needs of an earlier build's images.
struct ReadImagery {
  bool applied = false;
  std::vector<observation::ImageReceipt> images;  ///< without what was measured of its lean and fit
  struct Building {
    model::OsmId id;
    observation::OutlineReceipt receipt;
    observation::RoofView roof;  ///< without its evidence
    observation::SeenHeight height;
  };
  std::vector<Building> buildings;
  std::vector<observation::UnmappedBuilding> unmapped;  ///< those that are told, without their evidence
};

/// \throws std::exception  it is no imagery.json of this version
ReadImagery read_imagery_json(const std::string& text);

}  // namespace blockrand::outputs
