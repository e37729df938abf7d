#include "pipeline/georef/projection.h"

#include <cassert>
#include <cmath>

#include "pipeline/base/portable_math.h"
#include "pipeline/georef/frames.h"

namespace blockrand::georef {

Projection::Projection(Crs crs, const GeoBox& extent)
    : crs_(std::move(crs)), transform_(Transform::from_pipeline(crs_.pipeline, extent)) {}

model::Point2 Projection::forward(double lon_deg, double lat_deg) const {
  return transform_.forward({lon_deg, lat_deg});
}

void Projection::forward(std::span<const model::Location> in, std::span<model::Point2> out) const {
  assert(in.size() == out.size());
  for (std::size_t i = 0; i < in.size(); ++i) out[i] = forward(in[i]);
}

void Projection::forward(std::span<const LonLat> in, std::span<model::Point2> out) const {
  assert(in.size() == out.size());
  for (std::size_t i = 0; i < in.size(); ++i) out[i] = forward(in[i].lon, in[i].lat);
}

LonLat Projection::inverse(model::Point2 p) const {
  const model::Point2 g = transform_.inverse(p);
  return {g.x, g.y};
}

void Projection::inverse(std::span<const model::Point2> in, std::span<LonLat> out) const {
  assert(in.size() == out.size());
  for (std::size_t i = 0; i < in.size(); ++i) out[i] = inverse(in[i]);
}

double Projection::grid_scale(double lon_deg, double lat_deg) const {
  if (const auto own = transform_.own_scale({lon_deg, lat_deg})) return *own;
  // Central differences over about 20 m: the scale of any CRS, datum shift included, to about 1e-9.
  constexpr double kStep = 1e-4;  // degrees
  const double lat = lat_deg > 89.9 ? 89.9 : lat_deg < -89.9 ? -89.9 : lat_deg;
  const model::Point2 w = forward(lon_deg - kStep, lat), e = forward(lon_deg + kStep, lat);
  const model::Point2 s = forward(lon_deg, lat - kStep), n = forward(lon_deg, lat + kStep);
  const double area = (e.x - w.x) * (n.y - s.y) - (e.y - w.y) * (n.x - s.x);
  const base::SinCos sc = base::sin_cos(lat * base::kRadiansPerDegree);
  const double root = std::sqrt(1 - kWgs84E2 * sc.sin * sc.sin);
  const double meridian = kWgs84A * (1 - kWgs84E2) / (root * root * root), parallel = kWgs84A / root * sc.cos;
  const double step = 2 * kStep * base::kRadiansPerDegree;
  return std::sqrt(std::fabs(area) / (meridian * parallel * step * step));
}

}  // namespace blockrand::georef
