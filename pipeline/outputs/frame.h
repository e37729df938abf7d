// What the exporters need to know about the tile's local frame; georef fills it.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "pipeline/model/point.h"

namespace blockrand::outputs {

/// The topocentric east-north-up frame that a tile's mesh is written in.
struct Frame {
  /// Maps points of the build CRS to metres east, north, up of the origin; both spans have the same length. Equal
  /// points must give equal results, so that a mesh closes again when it is welded by position. Empty means identity
  /// (models without a place on the Earth, tests).
  std::function<void(std::span<const model::Point3> in, std::span<model::Point3> out)> to_enu;
  double longitude = 0, latitude = 0;  ///< degrees, WGS 84
  double height = 0;                   ///< m above the ellipsoid
  /// Local east, north, up to Earth-centred Earth-fixed metres (EPSG:4978), column-major.
  std::array<double, 16> enu_to_ecef{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

}  // namespace blockrand::outputs
