// Whether triangles of a solid pass through one another: exact, on the grid.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pipeline/geometry/check_solid.h"
#include "pipeline/geometry/grid.h"

namespace blockrand::geometry {

/// Finds a conflicting pair by a sweep along x; SolidDefect::none where there is none. Triangles of one face (by
/// `face_of`) cannot conflict: they come from one triangulation of a simple polygon.
SolidCheck check_intersections(std::span<const Grid3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles,
                               std::span<const std::uint32_t> face_of);

}  // namespace blockrand::geometry
