// Built roofs as pipeline/compare measures them.
#pragma once

#include "pipeline/compare/roofs_from_above.h"
#include "pipeline/model/solid.h"
#include "styles/roofs/roof.h"

namespace blockrand::run::test {

using compare::common_directions;
using compare::common_grid;
using compare::kFlatSlope;
using compare::kSteepest;
using compare::RoofHeights;
using compare::RoofPlanes;
using compare::RoofSurfaces;
using compare::SurfaceError;

/// Roof faces of a built solid.
void add_roof_of(const model::Solid& solid, RoofSurfaces& out);
RoofSurfaces surfaces_of(const roofs::Roof& roof);

}  // namespace blockrand::run::test
