// Reads a small glTF model as triangles with the names of their materials: what elements can be made of.
#pragma once

#include <string>

#include "pipeline/model/triangle_model.h"

namespace blockrand::importers::reference {

/// Triangles in one file, node by node: a model of an element has thousands.
inline constexpr std::size_t kMostModelTriangles = 200'000;

/// Reads the default scene of a `.glb` or `.gltf`, nodes in their places, in the file's own axes: y up, metres.
/// Triangles without an area are left out.
/// \throws base::InputError  when there is no such file, it is damaged, not glTF 2.0, compressed by Draco, has
///         instances, strips, lines or points, nodes without end, or more triangles than kMostModelTriangles
model::TriangleModel read_triangle_model(const std::string& path);

}  // namespace blockrand::importers::reference
