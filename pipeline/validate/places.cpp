#include "pipeline/validate/places.h"

#include <algorithm>
#include <cmath>

namespace blockrand::validate {

using model::Point2;
using model::Point3;

std::vector<Point2> corners_on_earth(georef::ProjTransform& proj_transform, const Matrix& transform,
                                     const std::vector<GlbTriangle>& triangles) {
  std::vector<Point3> corners;
  for (const GlbTriangle& t : triangles) corners.insert(corners.end(), t.corners.begin(), t.corners.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Point2> out;
  for (const Point3& p : corners) {
    const georef::Geodetic g = proj_transform.to_geodetic(apply(transform, p));
    out.push_back({g.lon, g.lat});
  }
  return out;
}

std::vector<Point2> plan_points(const ReadBody& body) {
  std::vector<Point2> out;
  const auto add = [&](const std::vector<ReadPolygon>& polygons) {
    for (const ReadPolygon& polygon : polygons)
      for (const auto& ring : polygon.rings)
        for (const Point3& p : ring) out.push_back(p.xy());
  };
  add(body.footprint);
  for (const ReadSolid& solid : body.solids) add(solid.polygons);
  return out;
}

namespace {

constexpr Point2 kNowhere{1e6, 0};

void keep_nearer(Point2& best, Point2 d) {
  if (d.x * d.x + d.y * d.y < best.x * best.x + best.y * best.y) best = d;
}

}  // namespace

Point2 offset(const std::vector<Point2>& points, Point2 at) {
  Point2 best = kNowhere;
  for (const Point2& p : points) keep_nearer(best, {p.x - at.x, p.y - at.y});
  return best;
}

Point2 offset_on_earth(const std::vector<Point2>& points, model::Location at) {
  // Radii of curvature at the latitude: metres per degree north and east.
  const double s = std::sin(at.lat_degrees() * kRadians), w = 1 - kEarthE2 * s * s;
  const double north = kEarthA * (1 - kEarthE2) / (w * std::sqrt(w)) * kRadians;
  const double east = kEarthA / std::sqrt(w) * std::cos(at.lat_degrees() * kRadians) * kRadians;
  Point2 best = kNowhere;
  for (const Point2& p : points)
    keep_nearer(best, {std::remainder(p.x - at.lon_degrees(), 360.0) * east, (p.y - at.lat_degrees()) * north});
  return best;
}

}  // namespace blockrand::validate
