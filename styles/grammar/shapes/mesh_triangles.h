// Faces with holes as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "styles/grammar/shapes/shape_mesh.h"

namespace blockrand::grammar {

struct MeshTriangle {
  std::array<std::uint32_t, 3> vertices;  ///< of the mesh
  std::uint32_t face = 0;
};

/// Triangles that cover every face once, turned as their face is. Faces that cross themselves when seen along their
/// normal are fans of their outline. Ordered by face.
std::vector<MeshTriangle> triangles_of(const Mesh& mesh);

}  // namespace blockrand::grammar
