// How exact the georeference of a build is, measured where it is used.
#pragma once

#include <cstddef>

#include "pipeline/georef/projection.h"

namespace blockrand::georef {

inline constexpr double kMaxRoundTrip = 1e-3;  ///< m; ARCHITECTURE.md, law 8

/// Largest errors over a grid of sample points, in metres on the ground. For build.json.
struct RoundTrip {
  double projection_m = 0;  ///< lon/lat -> CRS -> lon/lat
  double frame_m = 0;       ///< CRS -> east-north-up of the tile -> earth-centred -> lon/lat/h -> CRS
  std::size_t points = 0;
  std::size_t undefined = 0;  ///< points where the CRS gives no coordinates; not in the maxima

  bool ok() const { return undefined == 0 && projection_m < kMaxRoundTrip && frame_m < kMaxRoundTrip; }
};

/// Samples 17 x 17 points of the extent, corners included, in the frames of the tiles of `level` that they lie in.
RoundTrip measure_round_trip(const Projection& projection, const GeoBox& extent, int level = 15);

}  // namespace blockrand::georef
