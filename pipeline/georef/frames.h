// The earth-centred frame and the east-north-up frame at a place, on the WGS 84 ellipsoid.
#pragma once

#include <array>

#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/point.h"

namespace blockrand::georef {

inline constexpr double kWgs84A = 6378137.0;                 ///< m, semi-major axis
inline constexpr double kWgs84F = 1 / 298.257223563;         ///< flattening
inline constexpr double kWgs84E2 = kWgs84F * (2 - kWgs84F);  ///< first eccentricity squared
inline constexpr double kWgs84B = kWgs84A * (1 - kWgs84F);   ///< m, semi-minor axis

/// Degrees and metres above the ellipsoid.
struct Geodetic {
  double lon = 0, lat = 0, height = 0;
};

/// Earth-centred, earth-fixed metres (x to 0 E, z to the north pole). Error below 3e-9 m (the last bit) near the
/// ground.
model::Point3 to_ecef(const Geodetic& p);

/// Inverse of to_ecef: B. R. Bowring, Transformation from spatial to geographical coordinates, Survey Review 23 (1976),
/// iterated four times. Near the ground (-10 to 100 km) the error is below 1e-8 m, the last bit of degrees as doubles.
Geodetic from_ecef(const model::Point3& p);

/// Right-handed frame that touches the ellipsoid's normal at an origin: x east, y north, z up. Metres.
class EnuFrame {
 public:
  explicit EnuFrame(const Geodetic& origin);

  const Geodetic& origin() const { return origin_; }

  model::Point3 to_local(double lon_deg, double lat_deg, double height) const;
  model::Point3 to_local(const model::Point3& ecef) const;
  model::Point3 to_ecef(const model::Point3& local) const;

  /// A direction (no origin) from the earth-centred frame.
  model::Point3 rotate_to_local(const model::Point3& direction) const;

  /// Local to earth-centred as a 4 x 4 matrix, column by column: the `transform` of 3D Tiles.
  std::array<double, 16> local_to_ecef() const;

 private:
  Geodetic origin_;
  model::Point3 centre_;             // of the frame, earth-centred
  model::Point3 east_, north_, up_;  // unit vectors, earth-centred
};

}  // namespace blockrand::georef
