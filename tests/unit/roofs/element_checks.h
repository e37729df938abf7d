// What every body on a roof must keep, measured on the finished solids alone.
#pragma once

#include <string>
#include <vector>

#include "pipeline/generate/envelope.h"
#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/solid_overlap.h"
#include "pipeline/geometry/triangulate.h"
#include "pipeline/model/roof_element.h"
#include "styles/roofs/roof.h"

namespace blockrand::roof_checks {

using Bodies = std::vector<model::RoofInstallation>;

/// "none" for a valid solid.
inline std::string verdict(const model::Solid& solid) {
  const auto triangles = geometry::triangulate(solid);
  if (!triangles) return "a face is no simple polygon";
  return geometry::check_solid(solid, *triangles).text();
}

inline double volume(const model::Solid& solid) {
  const auto triangles = geometry::triangulate(solid);
  return triangles ? geometry::volume(solid, *triangles) : -1;
}

/// m³ in common, deeper than 1 cm (geometry::OverlapOptions).
inline double overlap(const model::Solid& a, const model::Solid& b) {
  const auto ta = geometry::triangulate(a), tb = geometry::triangulate(b);
  if (!ta || !tb) return 1e9;
  return geometry::overlap_of({a.vertices, ta->triangles}, {b.vertices, tb->triangles}).volume;
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

inline bool boxes_meet(const model::Solid& a, const model::Solid& b) {
  const auto box = [](const model::Solid& s) {
    std::array<double, 6> out{1e18, 1e18, 1e18, -1e18, -1e18, -1e18};
    for (const auto& p : s.vertices) {
      const double v[] = {p.x, p.y, p.z};
      for (std::size_t i = 0; i < 3; ++i) {
        out[i] = std::min(out[i], v[i]);
        out[i + 3] = std::max(out[i + 3], v[i]);
      }
    }
    return out;
  };
  const auto p = box(a), q = box(b);
  for (std::size_t i = 0; i < 3; ++i)
    if (p[i] > q[i + 3] || q[i] > p[i + 3]) return false;
  return true;
}

/// "" when all bodies are valid and none reaches into another or into the building (overlaps of 1e-6 m³ are the
/// rounding of overlap_of itself).
inline std::string fault(const model::Solid& building, const Bodies& bodies) {
  constexpr double kNothing = 1e-6;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string who = std::string(model::name(bodies[i].kind)) + " " + std::to_string(i);
    if (const std::string v = verdict(bodies[i].solid); v != "none") return who + ": " + v;
    if (boxes_meet(bodies[i].solid, building))
      if (const double v = overlap(bodies[i].solid, building); v > kNothing)
        return who + " in the building by " + std::to_string(v);
    for (std::size_t k = 0; k < i; ++k)
      if (boxes_meet(bodies[i].solid, bodies[k].solid))
        if (const double v = overlap(bodies[i].solid, bodies[k].solid); v > kNothing)
          return who + " in " + std::string(model::name(bodies[k].kind)) + " " + std::to_string(k) + " by " +
                 std::to_string(v);
  }
  return "";
}

}  // namespace blockrand::roof_checks
