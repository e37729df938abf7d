// A plain house with a roof of known pitch, for tests that work elements out by hand.
#pragma once

#include "tests/unit/roofs/fitted_roof.h"

namespace blockrand::roof_checks {

inline constexpr double kEaves = 40;  ///< m, of all roofs here; houses stand on z = 30

/// `length` along x, `depth` along y, from (0, 0).
inline Polygon rectangle(double length, double depth) {
  return polygon({{0, 0}, {length, 0}, {length, depth}, {0, depth}});
}

inline roofs::Roof roof_on(const Polygon& plan, model::RoofShape shape, double height) {
  roofs::RoofRequest request;
  request.shape = shape;
  request.measures = {kEaves, height};
  return roofs::build_roof(plan, request).value().roof;
}

/// A house 20 by 10 m whose ridge runs along x; the tangent of its pitch is `rise`.
struct GabledHouse {
  explicit GabledHouse(double rise, double length = 20)
      : plan(rectangle(length, 10)), roof(roof_on(plan, model::RoofShape::gabled, 5 * rise)) {}
  /// The surface that rises from y = 0.
  std::size_t south() const {
    for (std::size_t s = 0; s < roof.surfaces.size(); ++s)
      if (roof.surfaces[s].edge == 0) return s;
    return SIZE_MAX;
  }
  roofs::RoofSlope plane() const { return roofs::roof_slope(roof, south()).value(); }
  Polygon plan;
  roofs::Roof roof;
};

/// True when two roofs have the same points everywhere.
inline bool same_roof(const roofs::Roof& a, const roofs::Roof& b) {
  if (a.wall_tops != b.wall_tops || a.elements != b.elements || a.surfaces.size() != b.surfaces.size()) return false;
  for (std::size_t i = 0; i < a.surfaces.size(); ++i)
    if (a.surfaces[i].loops != b.surfaces[i].loops) return false;
  return true;
}

/// The plan and its roof as they are, turned and far from the origin: the same house, on other points of the grid.
inline std::vector<Polygon> turned_about(const Polygon& plan) {
  std::vector<Polygon> out;
  for (const double angle : kAngles)
    for (const Point2 place : kPlaces) out.push_back(moved(plan, angle, place));
  return out;
}

}  // namespace blockrand::roof_checks
