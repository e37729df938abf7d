// A face as a plan polygon on the exact grid, for the plan algorithms of pipeline/geometry.
#pragma once

#include <optional>
#include <vector>

#include "pipeline/geometry/grid.h"
#include "pipeline/model/polygon.h"
#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

/// A face in its own plane, x along the first edge, enlarged by a power of two so that the grid of 1/1024 is some
/// micrometres: roofs and setbacks keep the precision of what they are made of.
struct FlatFace {
  Frame plane;                          ///< in the mesh's coordinates: x along the first edge, z along the normal
  double scale = 1;                     ///< plan units per metre
  model::Polygon polygon;               ///< on the grid, strictly simple (checked), the first point is the face's first
  std::vector<std::uint32_t> vertices;  ///< of the mesh, by corner of the polygon, ring by ring
  std::vector<Corner> corners;          ///< of the face, likewise

  Vector3 to_mesh(model::Point2 p, double height = 0) const {
    return place(plane, {p.x / scale, p.y / scale, height / scale});
  }
};

/// Nothing for faces without area, that cross or touch themselves, or are too large. Points that lie on a straight edge
/// stay.
std::optional<FlatFace> flat_face(const Mesh& mesh, std::size_t face);

/// A face cut into triangles of its own vertices; empty when it is not simple.
std::vector<std::array<Corner, 3>> triangles_of(const Mesh& mesh, std::size_t face);

}  // namespace blockrand::grammar
