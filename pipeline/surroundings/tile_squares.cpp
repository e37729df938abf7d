#include "pipeline/surroundings/tile_squares.h"

#include <cmath>

#include "pipeline/georef/tiles.h"

namespace blockrand::surroundings {

std::vector<SquareIndex> squares_of_tile(const georef::Projection& projection, model::TileId tile) {
  const georef::GeoBox bounds = georef::bounds(tile);
  geometry::PlanBox box;
  constexpr int kSteps = 8;  // parallels are bent in the plane
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const georef::LonLat at = bounds.at(i / static_cast<double>(kSteps), k / static_cast<double>(kSteps));
      const model::Point2 p = projection.forward(at.lon, at.lat);
      if (std::isfinite(p.x) && std::isfinite(p.y)) box.include(p);
    }
  std::vector<SquareIndex> out;
  if (box.empty()) return out;
  const SquareIndex low = square_of({box.minimum.x - 1, box.minimum.y - 1});
  const SquareIndex high = square_of({box.maximum.x + 1, box.maximum.y + 1});
  for (std::int32_t y = low.y; y <= high.y; ++y)
    for (std::int32_t x = low.x; x <= high.x; ++x) {
      const georef::LonLat at = projection.inverse(box_of({x, y}).centre());
      const model::Location place{static_cast<std::int32_t>(std::lround(at.lon * 1e7)),
                                  static_cast<std::int32_t>(std::lround(at.lat * 1e7))};
      if (georef::tile_of(place, tile.level) == tile) out.push_back({x, y});
    }
  return out;
}

model::GroundMesh ground_mesh(const georef::Projection& projection, model::TileId tile, const HeightAt& height,
                              double level) {
  model::GroundMesh out{.square = kSquareSize, .cells = kTerrainSteps, .squares = {}};
  constexpr double kCell = kSquareSize / kTerrainSteps;
  for (const SquareIndex square : squares_of_tile(projection, tile)) {
    const SquareGround ground(square, height, level);
    model::GroundSquare& s = out.squares.emplace_back();
    s.corner = box_of(square).minimum;
    for (int row = 0; row <= kTerrainSteps; ++row)
      for (int column = 0; column <= kTerrainSteps; ++column)
        s.heights.push_back(ground.at({s.corner.x + column * kCell, s.corner.y + row * kCell}));
  }
  return out;
}

}  // namespace blockrand::surroundings
