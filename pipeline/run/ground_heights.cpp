#include "pipeline/run/ground_heights.h"

#include <optional>

#include "pipeline/surroundings/tile_squares.h"

namespace blockrand::run {

surroundings::HeightAt terrain_height(const BuildInputs& inputs, const georef::Projection& projection) {
  if (!inputs.terrain) return {};
  return [&inputs, &projection](model::Point2 place) -> std::optional<double> {
    const georef::LonLat at = projection.inverse(place);
    const auto range = inputs.terrain->range_along({&at, 1});
    return range ? std::optional(range->lowest) : std::nullopt;
  };
}

std::function<model::GroundMesh(model::TileId)> ground_mesh_of(const BuildOptions& options, const BuildInputs& inputs,
                                                               const georef::Projection& projection) {
  if (options.outputs.ground != outputs::GroundChoice::imagery) return {};
  return [&projection, height = terrain_height(inputs, projection), level = options.ground_height.value_or(0)](
             model::TileId tile) { return surroundings::ground_mesh(projection, tile, height, level); };
}

}  // namespace blockrand::run
