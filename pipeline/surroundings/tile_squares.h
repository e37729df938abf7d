// Which squares of the ground's grid belong to a tile.
#pragma once

#include <vector>

#include "pipeline/georef/projection.h"
#include "pipeline/model/ground_mesh.h"
#include "pipeline/model/region.h"
#include "pipeline/surroundings/ground_height.h"

namespace blockrand::surroundings {

/// Those whose middles lie in the tile, by rows from the south.
std::vector<SquareIndex> squares_of_tile(const georef::Projection& projection, model::TileId tile);

/// The ground of a tile as one mesh, heights as SquareGround has them. Depends on the tile and the terrain alone.
/// \param height, level  as SquareGround takes them
model::GroundMesh ground_mesh(const georef::Projection& projection, model::TileId tile, const HeightAt& height,
                              double level);

}  // namespace blockrand::surroundings
