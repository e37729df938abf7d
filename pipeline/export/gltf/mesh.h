// The triangles of a tile, ready for a vertex buffer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/export/frame.h"
#include "pipeline/model/region.h"

namespace blockrand::export_ {

/// A corner of the mesh. Positions are kept as indices until the mesh's extent decides how they are stored.
struct MeshVertex {
  std::uint32_t position = 0;             ///< into Mesh::positions
  std::uint32_t feature = 0;              ///< row of the property table
  std::array<std::int8_t, 3> normal{};    ///< east, north, up in 1/127
  std::array<std::uint16_t, 3> colour{};  ///< linear light in 1/65535
  friend bool operator==(const MeshVertex&, const MeshVertex&) = default;
};

/// All faces of one material class.
struct MeshPrimitive {
  std::uint8_t material = 0;  ///< into Region::materials
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< counter-clockwise triangles seen from outside
};

struct Mesh {
  std::vector<model::Point3> positions;   ///< east, north, up in metres
  std::vector<MeshPrimitive> primitives;  ///< by ascending material; none is empty
  model::Point3 min, max;                 ///< of the positions
  std::size_t triangles = 0;
  bool empty() const { return primitives.empty(); }
};

/// The solids of all parts of owned buildings, each at level of detail `lod` or, where it was not reached, the best
/// one below; with `lod` 0 their footprints. Features count the parts, with or without a solid, in the order of
/// building_table().
///
/// Of a LoD3 solid, what an element covers is left to the element: the polygon of its opening, and the reveal as well
/// unless `bake` is set, which puts the elements themselves into this mesh. Bodies on walls are always part of it.
///
/// Shading is flat: a face's vertices share the normal of its plane (Newell's method in the local frame). Corners of a
/// part with equal position, normal, colour and material become one vertex.
Mesh build_mesh(const model::Region& region, int lod, const Frame& frame, bool bake = false);

}  // namespace blockrand::export_
