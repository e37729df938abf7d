#include "pipeline/georef/round_trip.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/georef/tile_frame.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::georef {
namespace {

constexpr int kSamples = 17;
constexpr double kSampleHeight = 100;  // m; a building's

/// Up to the next micrometre: the digits below it may differ between CPUs where PROJ does the work.
double round_up(double metres) { return std::ceil(metres * 1e6) / 1e6; }

}  // namespace

RoundTrip measure_round_trip(const Projection& projection, const GeoBox& extent, int level) {
  RoundTrip result;
  std::map<model::TileId, TileFrame> tiles;  // of a quarter few: a frame costs as much as two hundred points
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const LonLat p = extent.at(i / (kSamples - 1.0), j / (kSamples - 1.0));
      ++result.points;
      const model::Point2 crs = projection.forward(p.lon, p.lat);
      const LonLat back = projection.inverse(crs);
      if (!std::isfinite(crs.x) || !std::isfinite(crs.y) || !std::isfinite(back.lon) || !std::isfinite(back.lat)) {
        ++result.undefined;
        continue;
      }
      const model::Point3 a = to_ecef({p.lon, p.lat, 0}), b = to_ecef({back.lon, back.lat, 0});
      result.projection_m = std::max(result.projection_m, std::hypot(a.x - b.x, a.y - b.y, a.z - b.z));

      const model::Location location{static_cast<std::int32_t>(std::nearbyint(p.lon * 1e7)),
                                     static_cast<std::int32_t>(std::nearbyint(p.lat * 1e7))};
      const model::TileId id = tile_of(location, level);
      const TileFrame& tile = tiles.try_emplace(id, projection, id).first->second;
      const model::Point3 local = tile.to_local({crs.x, crs.y, kSampleHeight});
      const Geodetic geodetic = from_ecef(tile.frame().to_ecef(local));
      const model::Point2 again = projection.forward(geodetic.lon, geodetic.lat);
      const double scale = projection.grid_scale(p.lon, p.lat);
      const double error =
          std::hypot((again.x - crs.x) / scale, (again.y - crs.y) / scale, geodetic.height - kSampleHeight);
      result.frame_m = std::max(result.frame_m, error);
    }
  }
  result.projection_m = round_up(result.projection_m);
  result.frame_m = round_up(result.frame_m);
  return result;
}

}  // namespace blockrand::georef
