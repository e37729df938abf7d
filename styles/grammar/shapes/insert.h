// Putting geometry into a scope: assets and primitives.
#pragma once

#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

enum class InsertMode : std::uint8_t { align_size_and_position, keep_size_and_position, keep_size_align_position };

/// Replaces the geometry by `asset` (in the asset's own coordinates, y up) by the size rules of
/// docs/rule_language.md §2.2, then cuts it with the active trim planes. The scope is that of the uncut asset.
void insert_asset(Shape& shape, Mesh asset, InsertMode mode = InsertMode::align_size_and_position);

/// Cuts the geometry with the shape's active trim planes.
void apply_trim_planes(Shape& shape);

/// Unit primitives in the box from 0 to 1 (the quad and the disk at y = 0), with uv set 0, faces outwards.
Mesh quad_mesh();
Mesh disk_mesh(int sides);
Mesh cube_mesh();
Mesh sphere_mesh(int sides, int divisions);
Mesh cylinder_mesh(int sides);
Mesh cone_mesh(int sides);

}  // namespace blockrand::grammar
