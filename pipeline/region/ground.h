// The ground under buildings: how deep their bases lie, and where they are entered.
#pragma once

#include <optional>

#include "importers/elevation/terrain.h"
#include "pipeline/generate/resolve.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/building.h"

namespace blockrand::region {

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
  generate::BuildingGround under(const model::Building& building) const;

 private:
  const importers::elevation::Terrain* terrain_;
  std::optional<double> height_;
  const georef::Projection& projection_;
};

}  // namespace blockrand::region
