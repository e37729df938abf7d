// Closed solids and the looks of their faces.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/model/colour.h"
#include "pipeline/model/point.h"

namespace blockrand::model {

/// The semantic class of a face, in CityGML's terms.
enum class SurfaceKind : std::uint8_t {
  ground,  ///< touches the terrain
  wall,
  roof,
  outer_ceiling,  ///< underside of passages, bays, raised parts, canopies
  outer_floor,    ///< loggias, set-back terraces
  closure,
  window,  ///< polygon of an opening, at the end of its reveal
  door,    ///< the same
};
inline constexpr int kSurfaceKindCount = 8;

/// How a material class reflects light; colours come per face. Read from configs/materials.
struct MaterialClass {
  std::string name;  ///< "plaster", "roof_tiles" …
  float roughness = 0.9f;
  float metallic = 0.0f;
};

/// One planar face of a solid. Its loops index Solid::vertices; the outer loop runs counter-clockwise seen from
/// outside, holes clockwise; no vertex is repeated within a loop.
struct Face {
  SurfaceKind kind = SurfaceKind::wall;
  std::uint8_t material = 0;  ///< index into Region::materials
  Colour colour;
  std::uint32_t first_loop = 0, loop_count = 0;  ///< into Solid::loops; the first loop is the outer one
  std::int32_t edge = -1;                        ///< the plan edge that this wall or roof face rises from; -1 for none
};

/// A closed boundary, or surfaces that need not bound anything, stored as indexed faces with loops. All coordinates lie on the
/// 1/1024 m grid.
struct Solid {
  struct Loop {
    std::uint32_t first = 0, count = 0;  ///< into Solid::indices
  };
  std::vector<Point3> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Loop> loops;
  std::vector<Face> faces;
  /// False: surfaces as rules for footprints or the model of a landmark made them. CityGML calls them a MultiSurface.
  bool closed = true;

  bool empty() const { return faces.empty(); }
  std::span<const Loop> loops_of(const Face& f) const { return std::span(loops).subspan(f.first_loop, f.loop_count); }
  std::span<const std::uint32_t> indices_of(const Loop& l) const {
    return std::span(indices).subspan(l.first, l.count);
  }
};

/// The triangles of a solid, grouped by face: `triangles[first[f] .. first[f+1])` belong to face f. Counter-clockwise
/// seen from outside. One triangulation serves the checker and every mesh format.
struct SolidTriangles {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> first;
};

}  // namespace blockrand::model
