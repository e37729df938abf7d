// The triangles of a tile, ready for a vertex buffer.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/frame.h"

namespace blockrand::outputs {

/// A corner of the mesh. Positions are kept as indices until the mesh's extent decides how they are stored.
struct MeshVertex {
  std::uint32_t position = 0;           ///< into Mesh::positions
  std::uint32_t feature = 0;            ///< row of the property table
  std::array<std::int8_t, 3> normal{};  ///< east, north, up in 1/127
  friend bool operator==(const MeshVertex&, const MeshVertex&) = default;
};

/// Faces of one material class, in one colour or with a colour for each vertex.
struct MeshPrimitive {
  /// 65535 as an index would restart a primitive.
  static constexpr std::size_t kMostVertices = 65535;
  /// From so many vertices on, a colour has a primitive and a material of its own: it saves 8 bytes a vertex and costs
  /// about 400 and a draw call.
  static constexpr std::size_t kOwnColour = 1024;

  std::uint8_t material = 0;            ///< into Region::materials
  std::optional<model::Colour> colour;  ///< of all faces
  std::vector<MeshVertex> vertices;     ///< at most kMostVertices
  std::vector<model::Colour> colours;   ///< by vertex, where not all have one
  std::vector<std::uint16_t> indices;   ///< counter-clockwise triangles seen from outside
};

struct Mesh {
  std::vector<model::Point3> positions;   ///< east, north, up in metres
  std::vector<MeshPrimitive> primitives;  ///< by ascending material, its own colours first; none is empty
  model::Point3 min, max;                 ///< of the positions
  std::size_t triangles = 0;
  bool empty() const { return primitives.empty(); }
};

/// Faces of a LoD3 solid that are left to elements: the polygons of openings, and unless `bake` is set their reveals. By face.
std::vector<bool> hidden_faces(const model::Region& region, const model::Detail& detail, bool bake);

/// The solids of all parts of owned buildings, each at level of detail `lod` or, where it was not reached, the best
/// one below; with `lod` 0 their footprints. Features count the parts, with or without a solid, in the order of
/// building_table().
///
/// Of a LoD3 solid, what an element covers is left to the element: the polygon of its opening, and the reveal as well
/// unless `bake` is set, which puts the elements themselves into this mesh. Bodies on walls are always part of it.
///
/// Shading is flat: a face's vertices share the normal of its plane (Newell's method in the local frame). Corners of a
/// part with equal position, normal, colour and material become one vertex. Faces are in the order of the parts within
/// a colour.
Mesh build_mesh(const model::Region& region, int lod, const Frame& frame, bool bake = false);

/// The same, part by part: `visit` gets every part's row of the table and its mesh, which is empty where the part shows
/// nothing. Primitives have one colour each, whatever its number of vertices.
void for_each_part_mesh(const model::Region& region, int lod, const Frame& frame, bool bake,
                        const std::function<void(std::uint32_t feature, Mesh mesh)>& visit);

}  // namespace blockrand::outputs
