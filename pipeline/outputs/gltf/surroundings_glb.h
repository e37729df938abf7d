// What stands around the houses of a tile as binary glTF.
#pragma once

#include <optional>

#include "pipeline/model/surroundings.h"
#include "pipeline/outputs/gltf/glb_writer.h"

namespace blockrand::outputs {

inline constexpr const char* kSurroundingClass = "surrounding";

/// Ground and bodies as one mesh, as write_glb() has houses (colours of vertices, one material, _FEATURE_ID_0), objects as a
/// shape that is stored once and placed by EXT_mesh_gpu_instancing; with other instancing than `ext` they are triangles, too. The
/// property table has a row for each OSM object and class: `osm_id`, `class`, `material`.
/// \param height  m; where the objects stand lies in the surroundings themselves
/// \throws std::length_error  as write_glb
Glb write_surroundings_glb(const model::Surroundings& surroundings, const model::SurroundingCatalogue& catalogue,
                           const GlbOptions& options);

/// m: the lowest point of everything; nothing where there is nothing.
std::optional<double> lowest_point(const model::Surroundings& surroundings);

}  // namespace blockrand::outputs
