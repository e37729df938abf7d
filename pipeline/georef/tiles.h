// The geodetic quadtree that cuts the world into units of work (ARCHITECTURE.md, "Coordinates").
#pragma once

#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/point.h"
#include "pipeline/model/region.h"

namespace blockrand::georef {

inline constexpr int kMaxTileLevel = 30;  ///< tiles of 4 cm; x still fits 32 bits

/// The tile that holds a location: west and south edges belong to a tile, 180 E and 90 N to the last one.
///
/// Integer arithmetic on OSM's own 1e-7 degrees; places outside of the globe go to the nearest tile.
/// Requires 0 <= level <= kMaxTileLevel.
model::TileId tile_of(model::Location location, int level);

/// Degrees; exact in doubles at every level.
GeoBox bounds(const model::TileId& tile);

/// Degrees; exact in doubles at every level.
LonLat centre(const model::TileId& tile);

/// Whether `tile` is `ancestor` or lies in it.
bool contains(const model::TileId& ancestor, const model::TileId& tile);

/// The tile and what lies within `halo` metres of it, in degrees: rounded up, ends at 180 degrees and at the poles.
GeoBox with_halo(const model::TileId& tile, double halo);

}  // namespace blockrand::georef
