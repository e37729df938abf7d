// imagery.json: what the images of a build show. Written with it, and read where a tile of it is built alone.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pipeline/footprints/footprint_store.h"
#include "pipeline/observation/imagery.h"

namespace blockrand::outputs {

/// \param footprints  whose numbers the receipts have
std::string imagery_json(const observation::ImageryObservations& observations,
                         const footprints::FootprintStore& footprints);

/// What a tile needs of an earlier build's images.
struct ReadImagery {
  bool applied = false;
  std::vector<observation::ImageReceipt> images;  ///< path, date, licence, attribution, state and shift alone
  struct Building {
    model::OsmId id;
    observation::OutlineReceipt receipt;
    observation::RoofView roof;  ///< without its evidence
  };
  std::vector<Building> buildings;
};

/// \throws std::exception  it is no imagery.json of this version
ReadImagery read_imagery_json(const std::string& text);

}  // namespace blockrand::outputs
