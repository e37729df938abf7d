// Earth-centred coordinates to longitude, latitude and height, and 4 x 4 matrices: written for the validators, so that an
// error in georef or export cannot hide behind itself.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/model/point.h"

namespace blockrand::validate {

inline constexpr double kRadians = std::numbers::pi / 180;

/// Column-major, as in glTF and 3D Tiles.
using Matrix = std::array<double, 16>;
inline constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

inline Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t k = 0; k < 4; ++k) out[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
  return out;
}

inline model::Point3 apply(const Matrix& m, const model::Point3& p) {
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

/// Back through a matrix of orthonormal axes.
inline model::Point3 apply_inverse(const Matrix& m, const model::Point3& p) {
  const double x = p.x - m[12], y = p.y - m[13], z = p.z - m[14];
  return {m[0] * x + m[1] * y + m[2] * z, m[4] * x + m[5] * y + m[6] * z, m[8] * x + m[9] * y + m[10] * z};
}

/// Radians and metres above WGS 84.
struct Place {
  double lon = 0, lat = 0, height = 0;
};

inline constexpr double kEarthA = 6378137.0, kEarthE2 = 6.69437999014131e-3;

/// Iterates on the latitude; near the ground five rounds leave less than a micrometre.
inline Place geodetic(const model::Point3& p) {
  const double r = std::hypot(p.x, p.y);
  double lat = std::atan2(p.z, r * (1 - kEarthE2));
  double n = kEarthA;
  for (int i = 0; i < 5; ++i) {
    const double s = std::sin(lat);
    n = kEarthA / std::sqrt(1 - kEarthE2 * s * s);
    lat = std::atan2(p.z + kEarthE2 * n * s, r);
  }
  const double s = std::sin(lat);
  n = kEarthA / std::sqrt(1 - kEarthE2 * s * s);
  return {std::atan2(p.y, p.x), lat, r * std::cos(lat) + p.z * s - kEarthA * kEarthA / n};
}

inline model::Point3 earth_centred(const Place& p) {
  const double s = std::sin(p.lat), c = std::cos(p.lat), n = kEarthA / std::sqrt(1 - kEarthE2 * s * s);
  return {(n + p.height) * c * std::cos(p.lon), (n + p.height) * c * std::sin(p.lon),
          (n * (1 - kEarthE2) + p.height) * s};
}

/// From metres east, north, up of a place to earth-centred coordinates.
inline Matrix east_north_up(const Place& p) {
  const double sl = std::sin(p.lon), cl = std::cos(p.lon), sp = std::sin(p.lat), cp = std::cos(p.lat);
  const model::Point3 o = earth_centred(p);
  return {-sl, cl, 0, 0, -sp * cl, -sp * sl, cp, 0, cp * cl, cp * sl, sp, 0, o.x, o.y, o.z, 1};
}

}  // namespace blockrand::validate
