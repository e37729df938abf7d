// How much room two solids have in common. For parts of one building, which must not overlap (val3dity's 601).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pipeline/model/point.h"

namespace blockrand::geometry {

/// A closed surface of triangles, counter-clockwise seen from outside. Any shape: nothing is assumed of heights.
struct ClosedMesh {
  std::span<const model::Point3> vertices;  ///< m
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// The volume in m³ that both enclose, to about a cubic millimetre for houses. It depends steadily on the vertices: no
/// case is decided, so that common walls, common corners and gaps of rounding are no exceptions. Cost: triangles whose
/// boxes meet in plan, at most the product of both counts.
double common_volume(const ClosedMesh& a, const ClosedMesh& b);

/// m³. Doubles are wrong by a thousandth of it; the thinnest slivers that rounding to the grid makes have ten times as
/// much.
inline constexpr double kLeastCommonVolume = 1e-10;

/// Whether the interiors of two solids meet: val3dity's 601 without a tolerance. Walls, corners and faces may be common.
bool interiors_meet(const ClosedMesh& a, const ClosedMesh& b);

struct OverlapOptions {
  double depth = 0.01;   ///< m. What is thinner than this on every side is rounding, or walls joined by repair.
  double volume = 0.01;  ///< m³ that is deeper.
};

struct SolidOverlap {
  double volume = 0;  ///< m³ in common, half of `depth` taken off both on every side
  bool overlap = false;
};

/// Do two solids overlap by more than a tolerance? Every wall of both is moved inwards by half of `depth`; what both
/// still enclose counts. So parts that share a wall, stand on each other, or reach into each other by a rounded corner
/// do not overlap, however large the wall. Solids thinner than `depth` have no inside that counts.
SolidOverlap overlap_of(const ClosedMesh& a, const ClosedMesh& b, const OverlapOptions& options = {});

}  // namespace blockrand::geometry
