#include "pipeline/georef/tiles.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "pipeline/base/portable_math.h"

namespace blockrand::georef {

model::TileId tile_of(model::Location location, int level) {
  assert(level >= 0 && level <= kMaxTileLevel);
  constexpr std::int64_t kHalfTurn = 1'800'000'000;  // 180 degrees in units of 1e-7
  const std::int64_t columns = std::int64_t{1} << (level + 1), rows = std::int64_t{1} << level;
  const auto index = [](std::int64_t from_edge, std::int64_t span, std::int64_t count) {
    from_edge = std::clamp<std::int64_t>(from_edge, 0, span);
    return static_cast<std::uint32_t>(std::min(from_edge * count / span, count - 1));
  };
  return {level, index(location.lon + kHalfTurn, 2 * kHalfTurn, columns),
          index(location.lat + kHalfTurn / 2, kHalfTurn, rows)};
}

GeoBox bounds(const model::TileId& tile) {
  const auto edge = [&](double origin, std::uint64_t i) {  // i * 180 has at most 39 bits, the division moves the point
    return origin + std::ldexp(static_cast<double>(i * 180), -tile.level);
  };
  return {edge(-180, tile.x), edge(-90, tile.y), edge(-180, std::uint64_t{tile.x} + 1),
          edge(-90, std::uint64_t{tile.y} + 1)};
}

LonLat centre(const model::TileId& tile) {
  const GeoBox b = bounds(tile);
  return {0.5 * (b.west + b.east), 0.5 * (b.south + b.north)};
}

GeoBox with_halo(const model::TileId& tile, double halo) {
  constexpr double kMetresPerDegree =
      111'000;  // of latitude, the least on the ellipsoid is 110.6 km: rounds the halo up
  const GeoBox box = bounds(tile);
  const double north = halo / kMetresPerDegree;
  const double farthest = std::min(89.0, std::max(std::abs(box.south), std::abs(box.north)) + north);
  const double east = north / base::cos(farthest * base::kPi / 180);
  // OSM cuts ways at 180 degrees: nothing is seen of what lies beyond.
  return {std::max(-180.0, box.west - east), std::max(-90.0, box.south - north), std::min(180.0, box.east + east),
          std::min(90.0, box.north + north)};
}

bool contains(const model::TileId& ancestor, const model::TileId& tile) {
  const int steps = tile.level - ancestor.level;
  return steps >= 0 && (tile.x >> steps) == ancestor.x && (tile.y >> steps) == ancestor.y;
}

}  // namespace blockrand::georef
