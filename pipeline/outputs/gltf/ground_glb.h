// The ground with its picture as binary glTF.
#pragma once

#include <span>
#include <string>

#include "pipeline/model/ground_mesh.h"
#include "pipeline/outputs/gltf/glb_writer.h"
#include "pipeline/outputs/gltf/ground_picture.h"

namespace blockrand::outputs {

/// Of one tile.
struct GroundPart {
  const model::GroundMesh* mesh = nullptr;
  const GroundCover* cover = nullptr;
  std::string webp, png;  ///< where the GLB finds the picture
};

/// A mesh for each part: a primitive of the cells that the picture shows, and one of the others, in kBareGround. Normals point up,
/// whatever the slope: pictures have their light already. Texture coordinates are 16-bit shares of the picture, which is
/// not repeated (EXT_texture_webp, with the PNG for others). KHR_mesh_quantization is required.
/// \param options  head and frame; instancing, textures and the like are not asked
/// \throws std::length_error  a tile has more vertices than a primitive takes
Glb write_ground_glb(std::span<const GroundPart> parts, const GlbOptions& options);

}  // namespace blockrand::outputs
