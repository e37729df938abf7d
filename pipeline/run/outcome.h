// What becomes of each object of a tile (ARCHITECTURE.md, law 1).
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/extract.h"
#include "pipeline/model/region.h"

namespace blockrand::run {

/// What becomes of one object.
struct Outcome {
  std::uint32_t index = 0;  ///< into Extract::buildings
  model::ObjectState state = model::ObjectState::modelled;
  model::IssueCode code = model::IssueCode::none;
  model::OsmId related;
  int lod = -1;
};

struct Outcomes {
  std::vector<Outcome> list;
  bool below_quality = false;  ///< one is simpler than asked, or has no solid
};

/// Decides about every object of the region after its masses were built: modelled when one of its bodies has a solid (a
/// plan, where only footprints were asked for), an outline represented by its parts, else reported.
/// \param asked  level of detail
Outcomes decide_outcomes(const model::Region& region, int asked);

}  // namespace blockrand::run
