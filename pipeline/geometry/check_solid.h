// The project's own judge of solids: closed, manifold, oriented, planar, free of self-intersections.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/geometry/grid.h"
#include "pipeline/model/solid.h"

namespace blockrand::geometry {

enum class SolidDefect : std::uint8_t {
  none,
  empty,                ///< no faces
  bad_index,            ///< a loop names a vertex that does not exist
  short_loop,           ///< a loop with fewer than three vertices
  repeated_vertex,      ///< a vertex twice in one loop, or two vertices at one place
  invalid_face,         ///< a face is not a simple polygon with holes
  not_planar,           ///< a vertex lies too far from its face's plane
  open_edge,            ///< an edge with a face on one side only
  wrong_orientation,    ///< two faces run along an edge in the same direction
  non_manifold_edge,    ///< more than two faces meet in an edge
  non_manifold_vertex,  ///< faces touch in a vertex without sharing an edge there
  not_connected,        ///< more than one shell
  inside_out,           ///< negative or zero volume
  self_intersection,    ///< two faces cross, overlap or touch where they share nothing
};
std::string_view name(SolidDefect defect);

struct SolidCheck {
  SolidDefect defect = SolidDefect::none;
  std::int64_t first = -1, second = -1;  ///< faces or vertices concerned, where that makes sense
  double measure = 0;                    ///< m off the plane for not_planar
  bool valid() const { return defect == SolidDefect::none; }
  std::string text() const;
};

struct SolidCheckOptions {
  double planarity = 0.01;  ///< m. CityGML's usual tolerance; rounding to the grid alone costs up to 0.001.
};

/// Checks a solid whose vertices lie on the 1/1024 m grid. All decisions are exact (integer arithmetic) but planarity.
/// \param triangles  the solid's triangulation by geometry::triangulate
/// O(n log n) for n faces of footprint-like solids.
SolidCheck check_solid(const model::Solid& solid, const model::SolidTriangles& triangles,
                       const SolidCheckOptions& options = {});

/// As above for a mesh of triangles (counter-clockwise from outside) that was read from a file: vertices in units of
/// `1 / steps_per_metre`, equal positions merged by the caller.
SolidCheck check_mesh(std::span<const Grid3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles);

/// Volume enclosed by the triangles in m³; positive when they face outwards.
double volume(const model::Solid& solid, const model::SolidTriangles& triangles);

}  // namespace blockrand::geometry
