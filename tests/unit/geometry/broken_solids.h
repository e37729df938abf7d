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
  int code = 0;              ///< what it is told as (geometry/solid_defect.h)
  bool seen_by_cgal = true;  ///< false: the second judge has no word on it
};

/// At least eighty solids, each broken in one way that a judge must notice. Every class of defects is there but 103, which
/// only files can have.
std::vector<BrokenSolid> broken_solids();

struct SoundSolid {
  std::string name;
  model::Solid solid;
};

/// Neighbours of the broken ones: by a hair not broken.
std::vector<SoundSolid> sound_solids();

}  // namespace blockrand::testing_shapes
