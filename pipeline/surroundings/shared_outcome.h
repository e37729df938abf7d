// What an area of a build in areas says of an object around houses that other areas may see as well.
#pragma once

#include <cstdint>

#include "pipeline/model/osm_id.h"

namespace blockrand::surroundings {

struct SharedOutcome {
  model::OsmId object;
  std::uint8_t kind = 0;   ///< SurroundingKind
  std::uint8_t state = 0;  ///< SurroundingState, or kElsewhere
};

}  // namespace blockrand::surroundings
