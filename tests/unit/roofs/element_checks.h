// What every body on a roof must keep, measured on the finished solids alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/solid_overlap.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/masses/envelope.h"
#include "pipeline/model/roof_element.h"
#include "styles/roofs/roof.h"

namespace blockrand::roof_checks {

using Bodies = std::vector<model::RoofInstallation>;

/// "none" for a valid solid.
inline std::string validity(const model::Solid& solid) {
  const auto triangles = geometry::triangulate(solid);
  if (!triangles) return "a face is no simple polygon";
  return geometry::check_solid(solid, *triangles).text();
}

inline double volume(const model::Solid& solid) {
  const auto triangles = geometry::triangulate(solid);
  return triangles ? geometry::volume(solid, *triangles) : -1;
}

/// m² of a solid's faces of one kind.
inline double area(const model::Solid& solid, model::SurfaceKind kind) {
  double sum = 0;
  const auto triangles = geometry::triangulate(solid);
  if (!triangles) return -1;
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    if (solid.faces[f].kind != kind) continue;
    for (std::uint32_t t = triangles->first[f]; t < triangles->first[f + 1]; ++t) {
      const auto& [i, j, k] = triangles->triangles[t];
      const auto &a = solid.vertices[i], &b = solid.vertices[j], &c = solid.vertices[k];
      const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
      sum += std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
    }
  }
  return sum;
}

/// A solid made ready for many comparisons.
struct Measured {
  const model::Solid* solid = nullptr;
  std::optional<model::SolidTriangles> triangles;
  std::array<double, 6> box{1e18, 1e18, 1e18, -1e18, -1e18, -1e18};

  explicit Measured(const model::Solid& s) : solid(&s), triangles(geometry::triangulate(s)) {
    for (const auto& p : s.vertices) {
      const double v[] = {p.x, p.y, p.z};
      for (std::size_t i = 0; i < 3; ++i) {
        box[i] = std::min(box[i], v[i]);
        box[i + 3] = std::max(box[i + 3], v[i]);
      }
    }
  }
  bool near(const Measured& o) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (box[i] > o.box[i + 3] || o.box[i] > box[i + 3]) return false;
    return true;
  }
  double overlap(const Measured& o) const {
    if (!triangles || !o.triangles) return 1e9;
    return near(o) ? geometry::overlap_of({solid->vertices, triangles->triangles},
                                          {o.solid->vertices, o.triangles->triangles})
                         .volume
                   : 0;
  }
};

/// "" when all bodies are valid and none reaches into another or into the building (overlaps of 1e-6 m³ are the
/// rounding of overlap_of itself).
inline std::string fault(const model::Solid& building, const Bodies& bodies) {
  constexpr double kNothing = 1e-6;
  const Measured house(building);
  std::vector<Measured> all;
  for (const auto& body : bodies) all.emplace_back(body.solid);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string who = std::string(model::name(bodies[i].kind)) + " " + std::to_string(i);
    if (!all[i].triangles) return who + ": a face is no simple polygon";
    const auto check = geometry::check_solid(bodies[i].solid, *all[i].triangles);
    if (!check.valid()) return who + ": " + check.text();
    if (const double v = all[i].overlap(house); v > kNothing) return who + " in the building by " + std::to_string(v);
    for (std::size_t k = 0; k < i; ++k)
      if (const double v = all[i].overlap(all[k]); v > kNothing)
        return who + " in " + std::string(model::name(bodies[k].kind)) + " " + std::to_string(k) + " by " +
               std::to_string(v);
  }
  return "";
}

}  // namespace blockrand::roof_checks
