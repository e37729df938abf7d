// Sizes of an element's mesh, for tests.
#pragma once

#include <algorithm>

#include "styles/elements/built_element.h"

namespace blockrand::elements {

/// Triangles that the mesh takes when each face is cut into a fan.
inline std::size_t triangle_count(const ElementMesh& mesh) {
  std::size_t triangles = 0;
  for (const ElementFace& f : mesh.faces) triangles += f.count - 2;
  return triangles;
}

/// Smallest and largest coordinates of an element's mesh, m.
struct Bounds3 {
  model::Point3 least, most;
};
inline Bounds3 bounds_of(const ElementMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  Bounds3 b{mesh.vertices[0], mesh.vertices[0]};
  for (const model::Point3& p : mesh.vertices) {
    b.least = {std::min(b.least.x, p.x), std::min(b.least.y, p.y), std::min(b.least.z, p.z)};
    b.most = {std::max(b.most.x, p.x), std::max(b.most.y, p.y), std::max(b.most.z, p.z)};
  }
  return b;
}

}  // namespace blockrand::elements
