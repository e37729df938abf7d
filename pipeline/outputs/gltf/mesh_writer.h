// The triangles of a mesh as vertex buffers of a GLB.
#pragma once

#include <cstddef>
#include <string_view>

#include "pipeline/outputs/gltf/glb_document.h"
#include "pipeline/outputs/gltf/material.h"
#include "pipeline/outputs/gltf/mesh_buffers.h"
#include "pipeline/outputs/gltf/panes.h"
#include "pipeline/outputs/gltf/surface_textures.h"

namespace blockrand::outputs {

/// Adds a node for `mesh.primitives` and one for `mesh.pieces`, by whose name "elements" readers know them apart. Takes the
/// primitives out of `mesh` as it writes them.
/// \param features  rows of the property table
/// \param label     class of the features
/// \param material  for which `table` tells where classes are
/// \param textures  lays them on the primitives; null: all is plain
/// \param panes     glass becomes primitives of their own; null: it is as all else
/// \return how many triangles it wrote
std::size_t write_mesh(GlbDocument& document, Mesh& mesh, std::size_t features, std::string_view label, int material,
                       const MaterialTable& table, SurfaceTextures* textures = nullptr,
                       const PaneMaterials* panes = nullptr);

}  // namespace blockrand::outputs
