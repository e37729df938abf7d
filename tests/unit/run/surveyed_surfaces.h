// Built roofs as pipeline/compare measures them, and how far they are from surveyed ones.
#pragma once

#include <span>
#include <vector>

#include "pipeline/compare/roofs_from_above.h"
#include "pipeline/model/solid.h"
#include "styles/roofs/roof.h"

namespace blockrand::run::test {

using compare::common_grid;
using compare::kFlatSlope;
using compare::kSteepest;
using compare::RoofHeights;
using compare::RoofPlanes;
using compare::RoofSurfaces;

/// Roof faces of a built solid.
void add_roof_of(const model::Solid& solid, RoofSurfaces& out);
RoofSurfaces surfaces_of(const roofs::Roof& roof);

/// How many of `a` have a partner in `b` within 20 degrees, one to one.
int common_directions(const std::vector<double>& a, const std::vector<double>& b);

/// Vertical differences over points that both cover.
struct SurfaceError {
  std::size_t points = 0;
  double mean = 0, rms = 0;  ///< m, of (built - surveyed)
};
SurfaceError vertical_error(const RoofSurfaces& built, const RoofSurfaces& surveyed,
                            std::span<const model::Point2> points);

}  // namespace blockrand::run::test
