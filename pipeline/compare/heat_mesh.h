// Surfaces cut small enough to be coloured corner by corner. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/compare/face_triangles.h"

namespace blockrand::compare {

struct HeatMesh {
  std::vector<Point3> points;  ///< each once
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Cuts triangles at the middle of their longest edge until no edge is longer than `max_edge` (m) or, where that would
/// make more than about `max_triangles`, than a longer one.
HeatMesh cut_small(const std::vector<Triangle3>& triangles, double max_edge, std::size_t max_triangles);

}  // namespace blockrand::compare
