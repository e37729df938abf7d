// Reads glTF 2.0 and 3D Tiles: buildings as the triangles that viewers draw.
#pragma once

#include <string>

#include "importers/reference/read_options.h"
#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference {

/// Reads a `.glb`, a `.gltf` with its buffers, or a tileset.json of 3D Tiles 1.0 or 1.1 with all contents that are
/// glTF.
///
/// Place: `options.gltf_origin`; else asset.extras.georeference, which Blockrand writes (`local_to_ecef`, column by
/// column, or `origin`); in a tileset the tiles' transforms, which lead to earth-centred coordinates. What comes out is
/// in `options.reference_crs`; without it in the CRS that asset.extras names (of the build), without that in the UTM
/// zone of the model's middle (georef::choose_crs). z is the height above the ellipsoid; `crs.height_words` is what the
/// file says of it, and decides about `height_reference` (Blockrand's files without terrain: above_local_ground).
///
/// Tileset: of tiles that are replaced by their children (`refine` REPLACE) only the innermost count, with ADD all.
/// External tilesets are followed. Implicit tiling, 3D Tiles 1.0's own formats (b3dm …) and contents that are missing
/// are noted; it is an error when nothing else is there.
///
/// Which triangles are a building: those of one feature by EXT_instance_features, EXT_mesh_features (with or without
/// EXT_structural_metadata), `_FEATURE_ID_0` or `_BATCHID`; without any of these those of a node with a mesh, named
/// after the node or its mesh. A property table with columns `id` and `building` is read as Blockrand writes it: rows
/// are building parts. In other tables the column with the semantic ID, or one named like an id, names the building;
/// rows of one id, in whatever tile, are one building. Every row is a building, with or without triangles. Triangles
/// have no surface class: they are `Building::geometries` of kind surfaces (LoD0: footprint), `lod` from the column of
/// that name, else 2.
///
/// Read: node transforms, EXT_mesh_gpu_instancing, KHR_mesh_quantization, sparse accessors, triangle strips and fans.
/// Left out: points and lines, animations, skins, morph targets.
///
/// \throws base::InputError  when there is no such file, it is damaged, not glTF 2.0, compressed by Draco,
/// of
///         3D Tiles 1.0's own formats, or nothing says where on the Earth it lies
/// \throws base::UsageError  when `reference_crs` is no projected CRS in metres
ReferenceModel read_gltf(const std::string& path, const ReadOptions& options = {});

/// The same of one `.glb` or `.gltf` in its own axes: x right, y up, z towards the viewer, m. It may lie anywhere; `crs` says
/// nothing.
/// \throws base::InputError  as above, but for the place; and where it draws no triangle
ReferenceModel read_gltf_axes(const std::string& path);

}  // namespace blockrand::importers::reference
