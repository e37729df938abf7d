// A model as triangles with names of materials: what hand-made files become before they are elements.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::model {

/// Metres, y up, z towards the viewer: the frame of glTF and of ElementMesh.
struct TriangleModel {
  struct Triangle {
    std::array<Point3, 3> corners;    ///< counter-clockwise seen from outside, finite
    std::uint32_t material_name = 0;  ///< into `material_names`
  };
  std::vector<std::string> material_names;  ///< in the order of their first triangles; empty texts: without a name
  std::vector<Triangle> triangles;
};

}  // namespace blockrand::model
