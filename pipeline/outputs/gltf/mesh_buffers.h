// The triangles of a tile, ready for a vertex buffer.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pipeline/model/region.h"
#include "pipeline/outputs/frame.h"
#include "pipeline/outputs/gltf/element_pieces.h"

namespace blockrand::outputs {

/// A corner of the mesh. Positions are kept as indices until the mesh's extent decides how they are stored.
struct MeshVertex {
  std::uint32_t position = 0;           ///< into Mesh::positions
  std::uint32_t feature = 0;            ///< row of the property table
  std::array<std::int8_t, 3> normal{};  ///< east, north, up in 1/127
  model::PartMaterial look;
  friend bool operator==(const MeshVertex&, const MeshVertex&) = default;
};

/// Faces of one material and colour, or of all.
struct MeshPrimitive {
  /// 65535 as an index would restart a primitive.
  static constexpr std::size_t kMostVertices = 65535;

  model::PartMaterial look;            ///< of all faces, where they have one
  std::vector<MeshVertex> vertices;    ///< at most kMostVertices
  std::vector<std::uint16_t> indices;  ///< counter-clockwise triangles seen from outside

  bool glass = false;                                ///< of a pane or a sheet of glass, `look` tells which material
  int texture = -1;                                  ///< of SurfaceTextures; -1: none
  float reach = 1;                                   ///< repeats that a stored texture coordinate of 1 stands for
  std::vector<std::array<float, 2>> repeats;         ///< parallel to vertices where there is a texture: right, down
  std::vector<std::array<std::int8_t, 3>> tangents;  ///< the same: where repeats go right; east, north, up in 1/127
};

struct Mesh {
  std::vector<model::Point3> positions;   ///< east, north, up in metres
  std::vector<MeshPrimitive> primitives;  ///< none is empty
  std::vector<MeshPrimitive> pieces;      ///< of elements, apart from solids
  std::size_t solid_positions = 0;        ///< how many positions, the first ones, are those of solids
  std::vector<model::Point2> plan;        ///< of the positions in the build CRS; empty where no ground is textured
  std::vector<std::array<double, 2>>
      courses;  ///< by feature: cosine and sine of the direction of a ground's texture; others lie along the axes
  model::Point3 min, max;  ///< of the positions
  std::size_t triangles = 0;
  bool empty() const { return primitives.empty() && pieces.empty(); }
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
/// part with equal position, normal, colour and material become one vertex. Faces are in the order of the parts.
/// Primitives are as few as there can be: vertices have their looks. \param pieces  of elements that are not placed;
/// they are kept apart \param panes  of elements that are baked; null: as modelled
Mesh build_mesh(const model::Region& region, int lod, const Frame& frame, bool bake = false,
                std::span<const BakedPiece> pieces = {}, const PaneMaterials* panes = nullptr);

/// The same, part by part: `visit` gets every part's row of the table and its mesh, which is empty where the part shows
/// nothing. Primitives have one look each, by ascending material and colour.
void for_each_part_mesh(const model::Region& region, int lod, const Frame& frame, bool bake,
                        const std::function<void(std::uint32_t feature, Mesh mesh)>& visit,
                        const PaneMaterials* panes = nullptr);

}  // namespace blockrand::outputs
