// A whole build as objects that people find in a list: houses by their address, below them their parts.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pipeline/model/region.h"
#include "pipeline/outputs/frame.h"
#include "pipeline/outputs/gltf/instance_writer.h"
#include "pipeline/outputs/gltf/surface_textures.h"

namespace blockrand::outputs {

class GlbDocument;

/// What model.glb is made of.
enum class Objects : std::uint8_t {
  building,  ///< a node for each house, below it one for each part: what modelling programs and game engines expect
  tile,      ///< all houses in one mesh, as tiles have them: smaller and quicker to draw
};

/// What was written.
struct ObjectFigures {
  std::size_t buildings = 0, parts = 0;      ///< that show something
  std::size_t triangles = 0;                 ///< as drawn
  std::size_t elements = 0, placements = 0;  ///< distinct elements and their places, where they are nodes
  model::Point3 min, max;                    ///< of meshes and placed elements' origins, in east, north, up
  bool empty() const { return parts == 0; }
};

/// Adds a root node for each owned building that shows something: its name is the address ("Kastanienallee 12"), else the
/// name tag, else the id; its origin is the middle of the house on its lowest point; `extras` hold id, address and name_tag.
/// Its children are the parts, called by their ids: one mesh each, with a primitive for each material and colour, and in
/// `extras` id and `feature`, the row of the property table.
///
/// Only what every reader of glTF 2.0 knows: positions are floats, multiples of 1/4096 m about the house's origin;
/// vertices have neither colours nor normals, which readers must take as flat, as all faces are; vertices are shared
/// within a face alone, so that readers which smooth such meshes find nothing to smooth.
///
/// \param lod  0 to 3, as build_mesh() takes it
/// \param elements  `nodes`: elements are meshes that places share, children of their parts' nodes with `feature` in
///                  `extras`; otherwise they are triangles of the parts' meshes
/// \param textures  lays them on faces: texture coordinates are floats then, and the base colour factor is divided by the texture's
///                  mean; null: all is plain
/// \param panes     of glass; null: it is as modelled
ObjectFigures write_objects(GlbDocument& document, const model::Region& region, int lod, const Frame& frame,
                            Instancing elements, SurfaceTextures* textures = nullptr,
                            const PaneMaterials* panes = nullptr);

}  // namespace blockrand::outputs
