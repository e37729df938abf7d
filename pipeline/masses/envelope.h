// The closed solid of a plan under a roof.
#pragma once

#include "pipeline/model/polygon.h"
#include "pipeline/model/solid.h"
#include "styles/roofs/roof.h"

namespace blockrand::masses {

/// Kind, material and colour of the faces of one mass.
struct EnvelopeMaterials {
  model::Face wall, roof, under;
};

/// Underside at z = `bottom`, a wall for every edge of the plan up to the roof, and the roof's surfaces. Points are
/// rounded to the grid, equal ones shared. The plan must be strictly simple; whether the solid is valid is for
/// geometry::check_solid to say.
model::Solid envelope(const model::Polygon& plan, double bottom, const roofs::Roof& roof,
                      const EnvelopeMaterials& materials);

}  // namespace blockrand::masses
