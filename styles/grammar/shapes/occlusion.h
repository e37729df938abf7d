// What stands around a shape: answers to inside(), overlaps(), touches(), minimumDistance()
// (docs/rule_language.md §4.6).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

/// Surfaces nearer than this lie on each other; metres. Finer than any joint that a rule file builds, and coarser than
/// what turning back and forth through frames costs.
inline constexpr double kContact = 1e-4;

/// A shape that others may ask about, in the world.
struct Occluder {
  Mesh mesh;  ///< triangulated; empty unless the geometry is closed
  Box box;    ///< of the geometry
  std::array<Vector3, 8> scope_corners;
  std::vector<std::uint32_t> lineage;  ///< the way from the start: what begins so descends from this shape
  std::string label;                   ///< empty: none
};

/// The shape as an occluder: its geometry where that is closed, its scope always.
Occluder occluder_of(const Shape& shape);

/// What comparing shapes may cost: tests of a piece against a plane, of a point against a triangle, of boxes.
struct Effort {
  std::size_t left = std::numeric_limits<std::size_t>::max();
  bool spent = false;  ///< more was needed than was left: the answer is not known

  bool take(std::size_t tests) {
    spent = spent || tests > left;
    left -= std::min(tests, left);
    return !spent;
  }
};

/// How geometry lies to a closed one.
struct Contact {
  bool within = false;      ///< some of it lies inside
  bool beyond = false;      ///< some of it lies outside
  bool on_surface = false;  ///< some of it lies in the surface
};
/// \param mesh  in the world; open or closed
Contact contact(const Mesh& mesh, const Occluder& other, Effort& effort);

/// The shape's geometry in the world, and the box of it without a copy.
Mesh mesh_in_world(const Shape& shape);
Box box_in_world(const Shape& shape);
/// Whether two boxes overlap or touch; empty ones do not.
bool boxes_meet(const Box& a, const Box& b);

/// Completely in or on; partly in; overlapping or lying against one another. False where the effort is spent.
bool is_inside(const Mesh& mesh, const Occluder& other, Effort& effort);
bool overlaps(const Mesh& mesh, const Occluder& other, Effort& effort);
bool touches(const Mesh& mesh, const Occluder& other, Effort& effort);

/// m, between two boxes given by their corners (as Occluder::scope_corners has them); 0 when they meet.
double box_distance(const std::array<Vector3, 8>& a, const std::array<Vector3, 8>& b);
/// The corners of the shape's scope in the world: corner i lies at the far end of x, y, z where bits 0, 1, 2 are set.
std::array<Vector3, 8> scope_corners(const Shape& shape);

}  // namespace blockrand::grammar
