// Sound solids and deliberate damage, for both judges.
#pragma once

#include <string>
#include <vector>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/solid_builder.h"
#include "pipeline/model/solid.h"

namespace blockrand::testing_shapes {

/// A box with its low corner at `at`.
model::Solid box(model::Point3 at, double width, double depth, double height);
/// A house with a gable roof along x.
model::Solid gabled_house(model::Point3 at, double width, double depth, double eaves, double ridge);
/// A block with a courtyard.
model::Solid courtyard_block(model::Point3 at, double outer, double inner, double height);

struct BrokenSolid {
  std::string name;
  model::Solid solid;
};

/// At least fifty solids, each broken in one way that a judge must notice.
std::vector<BrokenSolid> broken_solids();

}  // namespace blockrand::testing_shapes
