// Coloured triangles as binary glTF: what a rule file makes, to look at.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::outputs {

/// Triangles of one colour.
struct ColouredTriangles {
  std::string name;                          ///< of the material
  std::array<double, 4> colour{1, 1, 1, 1};  ///< sRGB and opacity, 0 to 1
  double roughness = 1, metallic = 0;
  std::vector<model::Point3> corners;  ///< three a triangle, counter-clockwise seen from outside; metres
};

/// One mesh with a primitive and a material for each group, with normals; groups without triangles are left out.
/// \param y_up  the corners are in glTF's axes already; otherwise they are x east, y north, z up
std::string write_triangle_glb(std::span<const ColouredTriangles> groups, const std::string& generator, bool y_up);

}  // namespace blockrand::outputs
