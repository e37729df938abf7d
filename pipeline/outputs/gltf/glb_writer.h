// A tile as binary glTF.
#pragma once

#include <cstddef>
#include <set>
#include <string>

#include "pipeline/model/region.h"
#include "pipeline/outputs/frame.h"
#include "pipeline/outputs/gltf/attribute_profile.h"
#include "pipeline/outputs/gltf/compression.h"
#include "pipeline/outputs/gltf/instance_writer.h"
#include "pipeline/outputs/gltf/object_writer.h"
#include "pipeline/outputs/gltf/texture_set.h"

namespace blockrand::outputs {

struct GlbOptions {
  int lod = 2;                   ///< highest level of detail: 0 to 3; with 0 the mesh is the footprints
  std::string crs;               ///< of the build, for example "EPSG:25833"
  std::string height_reference;  ///< in words: "ellipsoidal heights (EGM96 + terrain)", "heights above local ground"
  std::string generator;         ///< program and version, for asset.generator
  std::string attribution;       ///< asset.copyright: "© OpenStreetMap contributors, ODbL 1.0"
  Frame frame;
  Instancing instancing = Instancing::ext;  ///< of what stands in facades, at LoD3
  Objects objects = Objects::tile;          ///< what the scene consists of
  Compression compression = Compression::none;
  AttributeProfile profile = AttributeProfile::all;  ///< what the property table tells of a building
  bool evidence = false;                             ///< also why each attribute has its value
  const TextureSet* textures = nullptr;              ///< null: surfaces are plain
  std::string texture_folder;                        ///< from the file to the pictures: "../../../textures/"
};

struct Glb {
  std::string bytes;
  std::size_t rows = 0;       ///< of the property table: parts of owned buildings
  std::size_t triangles = 0;  ///< as drawn; 0: the file is valid, but shows nothing; a tileset should leave it out
  std::size_t elements = 0, placements = 0;  ///< distinct elements and their places, where they are not baked
  std::size_t buildings = 0, parts = 0;      ///< nodes of objects; 0 without such
  std::set<std::string> textures;            ///< names of those that it shows
  std::size_t too_light = 0;                 ///< triangles that stay plain: their colour is lighter than their texture
  model::Point3 min, max;                    ///< of the mesh in east, north, up; zero without triangles
};

/// The owned buildings of `region` as one GLB.
///
/// With objects for buildings as write_objects() says, without a required extension but for compression. Otherwise one
/// mesh, indexed, y up: a primitive for every 65,535 vertices, all of one material (MaterialTable). Attributes lie in
/// streams of their own (glb_document.h): POSITION as floats that are multiples of 1/2048 m, or any where these would turn a
/// sliver of a solid over, NORMAL (8 bits), COLOR_0 (16 bits, linear light), TEXCOORD_0, which says the class of material, and _FEATURE_ID_0, the row of the part in the
/// property table. Extensions: KHR_mesh_quantization (required), EXT_mesh_features,
/// EXT_structural_metadata. Elements of LoD3 as GlbOptions::instancing says (piece_writer.h, instance_writer.h), with
/// EXT_mesh_gpu_instancing (required) and EXT_instance_features; with compression EXT_meshopt_compression (required).
/// With textures, faces of a material that has one are primitives of their own: TEXCOORD_0 counts repeats (KHR_texture_transform),
/// and COLOR_0 is divided by the texture's mean. Nothing else differs.
/// `asset.extras.georeference` says where on the Earth the mesh stands.
///
/// The same region gives the same bytes. A region without parts gives a valid file with an empty scene.
/// \throws std::length_error when the tile has more than 2^24 parts or 4 GB of data
Glb write_glb(const model::Region& region, const GlbOptions& options);

}  // namespace blockrand::outputs
