#include "pipeline/georef/frames.h"

#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/model/vector.h"

namespace blockrand::georef {
model::Point3 to_ecef(const Geodetic& p) {
  const base::SinCos lon = base::sin_cos(p.lon * base::kRadiansPerDegree);
  const base::SinCos lat = base::sin_cos(p.lat * base::kRadiansPerDegree);
  const double n = kWgs84A / std::sqrt(1 - kWgs84E2 * lat.sin * lat.sin);
  const double r = (n + p.height) * lat.cos;
  return {r * lon.cos, r * lon.sin, ((1 - kWgs84E2) * n + p.height) * lat.sin};
}

Geodetic from_ecef(const model::Point3& p) {
  const double r = std::sqrt(p.x * p.x + p.y * p.y);
  constexpr double kSecondE2 = kWgs84E2 / (1 - kWgs84E2);
  // Reduced latitude beta as a direction (sine, cosine); Bowring's step triples the right digits.
  double sin_beta = p.z * kWgs84A, cos_beta = r * kWgs84B;
  double sin_lat = 0, cos_lat = 1;
  for (int step = 0; step < 4; ++step) {
    const double length = std::sqrt(sin_beta * sin_beta + cos_beta * cos_beta);
    if (length == 0) break;
    sin_beta /= length, cos_beta /= length;
    const double up = p.z + kSecondE2 * kWgs84B * sin_beta * sin_beta * sin_beta;
    const double out = r - kWgs84E2 * kWgs84A * cos_beta * cos_beta * cos_beta;
    const double norm = std::sqrt(up * up + out * out);
    sin_lat = up / norm, cos_lat = out / norm;
    sin_beta = (1 - kWgs84F) * sin_lat, cos_beta = cos_lat;
  }
  Geodetic g;
  g.lon = base::atan2(p.y, p.x) * base::kDegreesPerRadian;
  g.lat = base::atan2(sin_lat, cos_lat) * base::kDegreesPerRadian;
  g.height = r * cos_lat + p.z * sin_lat - kWgs84A * std::sqrt(1 - kWgs84E2 * sin_lat * sin_lat);
  return g;
}

EnuFrame::EnuFrame(const Geodetic& origin) : origin_(origin), centre_(georef::to_ecef(origin)) {
  const base::SinCos lon = base::sin_cos(origin.lon * base::kRadiansPerDegree);
  const base::SinCos lat = base::sin_cos(origin.lat * base::kRadiansPerDegree);
  east_ = {-lon.sin, lon.cos, 0};
  north_ = {-lat.sin * lon.cos, -lat.sin * lon.sin, lat.cos};
  up_ = {lat.cos * lon.cos, lat.cos * lon.sin, lat.sin};
}

model::Point3 EnuFrame::rotate_to_local(const model::Point3& d) const {
  return {dot(east_, d), dot(north_, d), dot(up_, d)};
}

model::Point3 EnuFrame::to_local(const model::Point3& ecef) const {
  return rotate_to_local({ecef.x - centre_.x, ecef.y - centre_.y, ecef.z - centre_.z});
}

model::Point3 EnuFrame::to_local(double lon_deg, double lat_deg, double height) const {
  return to_local(georef::to_ecef({lon_deg, lat_deg, height}));
}

model::Point3 EnuFrame::to_ecef(const model::Point3& p) const {
  return {centre_.x + (east_.x * p.x + north_.x * p.y + up_.x * p.z),
          centre_.y + (east_.y * p.x + north_.y * p.y + up_.y * p.z),
          centre_.z + (east_.z * p.x + north_.z * p.y + up_.z * p.z)};
}

std::array<double, 16> EnuFrame::local_to_ecef() const {
  return {east_.x, east_.y, east_.z, 0, north_.x,  north_.y,  north_.z,  0,
          up_.x,   up_.y,   up_.z,   0, centre_.x, centre_.y, centre_.z, 1};
}

}  // namespace blockrand::georef
