// Transverse Mercator by Krüger's series, with the same bits on every CPU.
#pragma once

#include <array>

#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/point.h"

namespace blockrand::georef {

/// Ellipsoidal transverse Mercator projection (UTM and its kin).
///
/// C. F. F. Karney, Transverse Mercator with an accuracy of a few nanometers, Journal of Geodesy 85 (2011), eqs. 7-36:
/// Krüger's series to n^6. Error below 10 nm up to 30 degrees off the central meridian, below 1 mm up to 60.
class TransverseMercator {
 public:
  struct Parameters {
    double semi_major = 6378137.0;              ///< m
    double inverse_flattening = 298.257222101;  ///< GRS80
    double central_meridian = 0;                ///< degrees
    double latitude_of_origin = 0;              ///< degrees
    double scale = 0.9996;                      ///< on the central meridian
    double false_easting = 500000;              ///< m
    double false_northing = 0;                  ///< m
  };

  explicit TransverseMercator(const Parameters& parameters);

  /// Metres east and north. Any longitude: the difference to the central meridian is wrapped into [-180, 180].
  model::Point2 forward(LonLat p) const;

  /// Degrees, longitude in [-180, 180].
  LonLat inverse(model::Point2 p) const;

  /// Point scale factor: metres in the projection per metre on the ellipsoid (Karney 2011, eqs. 24-27).
  double scale(LonLat p) const;

 private:
  struct Intermediate;
  Intermediate series(LonLat p) const;
  double conformal_sigma(double sin_latitude) const;

  Parameters parameters_;
  double e2_ = 0, e_ = 0;      // eccentricity, squared and plain
  double radius_ = 0;          // k0 times Karney's A: radius of the rectifying sphere
  double rectifying_ = 0;      // k0 A / a
  double northing_shift_ = 0;  // false northing minus the northing of the latitude of origin
  std::array<double, 6> alpha_{}, beta_{};
};

}  // namespace blockrand::georef
