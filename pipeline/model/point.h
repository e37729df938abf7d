// Points in the build's coordinate system, and raw positions as OSM stores them.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace blockrand::model {

/// The grid of ARCHITECTURE.md, "Coordinates": all coordinates at stage borders are multiples of 1/1024 m, which
/// doubles hold exactly, so that the last bit of a maths library does not travel and exact predicates work on integers.
inline constexpr double kGridStepsPerMetre = 1024.0;

inline double snap(double metres) { return std::nearbyint(metres * kGridStepsPerMetre) / kGridStepsPerMetre; }

/// Metres in the build CRS; x east, y north.
struct Point2 {
  double x = 0, y = 0;
  friend bool operator==(const Point2&, const Point2&) = default;
  friend auto operator<=>(const Point2&, const Point2&) = default;
};

/// Metres in the build CRS; z up (height above the build's height reference).
struct Point3 {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Point3&, const Point3&) = default;
  friend auto operator<=>(const Point3&, const Point3&) = default;
  Point2 xy() const { return {x, y}; }
};

inline Point2 snap(Point2 p) { return {snap(p.x), snap(p.y)}; }
inline Point3 snap(Point3 p) { return {snap(p.x), snap(p.y), snap(p.z)}; }

/// WGS 84 position in units of 1e-7 degrees: exactly what an OSM file says.
struct Location {
  std::int32_t lon = 0, lat = 0;
  friend bool operator==(const Location&, const Location&) = default;
  friend auto operator<=>(const Location&, const Location&) = default;
  double lon_degrees() const { return lon * 1e-7; }
  double lat_degrees() const { return lat * 1e-7; }
};

}  // namespace blockrand::model
