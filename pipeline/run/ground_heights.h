// How high the ground lies around the houses, for what is made of it.
#pragma once

#include <functional>

#include "pipeline/georef/projection.h"
#include "pipeline/model/ground_mesh.h"
#include "pipeline/model/region.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/surroundings/surroundings.h"

namespace blockrand::run {

/// Heights of the terrain, m, by place in the build CRS; empty where there is none. \param inputs, projection  outlive the result
surroundings::HeightAt terrain_height(const BuildInputs& inputs, const georef::Projection& projection);

/// The ground that pictures are laid on; empty where none is asked for. \param inputs, projection  as above
std::function<model::GroundMesh(model::TileId)> ground_mesh_of(const BuildOptions& options, const BuildInputs& inputs,
                                                               const georef::Projection& projection);

}  // namespace blockrand::run
