// The ground under buildings: how deep their bases lie, and where they are entered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/georef/projection.h"
#include "pipeline/model/building.h"

namespace blockrand::importers::elevation {
class Terrain;
}

namespace blockrand::context {

/// The ground under one building. Heights in metres; those of the terrain are 0 or more, above `lowest`.
struct BuildingGround {
  model::Sourced<double> lowest;  ///< above the build's height reference: the base of all its bodies
  double rise = 0;                ///< the highest ground under the building
  double entrance = 0;            ///< ground where the building is entered, at most `rise`
  std::string entrance_reason;    ///< what that is, for the evidence
  std::vector<double> part_rise;  ///< as `rise`, under each of Building::parts; empty: as `rise`
};

/// Whether a body with these tags begins at the ground: no min_height, no skipped storeys.
bool stands_on_ground(const model::MappedAttributes& tags);

/// Safe for const use from any thread; what it refers to outlives it.
class Ground {
 public:
  /// \param terrain  null for none  \param height  m, where there is no terrain; nothing: 0
  Ground(const importers::elevation::Terrain* terrain, std::optional<double> height,
         const georef::Projection& projection)
      : terrain_(terrain), height_(height), projection_(projection) {}

  /// Needs outline, plans of the parts and situation. The lowest ground is that under the outline and under the plans
  /// of all parts that stand on the ground, which may stick out of it (PARTS_OUTSIDE). The entrance is the highest
  /// mapped one on the main fronts; else the highest ground along them; without fronts along the outline. Depends on
  /// the building and the terrain alone.
  BuildingGround under(const model::Building& building) const;

 private:
  const importers::elevation::Terrain* terrain_;
  std::optional<double> height_;
  const georef::Projection& projection_;
};

}  // namespace blockrand::context
