// The order of triangles and vertices of flat faces that packs well: along each wall, column by column.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace blockrand::outputs {

/// A vertex of a flat face, in whole steps.
struct FaceCorner {
  std::array<std::int64_t, 3> steps{};  ///< east, north, up
  std::array<std::int8_t, 3> normal{};  ///< of its face
};

/// Faces (triangles that share vertices) stay in their order. Triangles of a face go along it, to the right as seen from
/// outside, and where they end in the same column from below. Vertices come in the order in which triangles ask for
/// them: those of a column of windows follow each other and differ in their heights alone.
/// \param indices  of triangles; get the new order and the new numbers
/// \param column  steps; vertices of a face that lie no farther from each other along it are one column
/// \return by vertex its new number; ~0 where no triangle uses it
std::vector<std::uint32_t> order_along_faces(std::vector<std::uint16_t>& indices, std::span<const FaceCorner> corners,
                                             double column);

}  // namespace blockrand::outputs
