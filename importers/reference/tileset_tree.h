// 3D Tiles 1.0 and 1.1: which contents count, and where they stand. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "importers/reference/json_access.h"
#include "importers/reference/matrix4.h"
#include "importers/reference/note_log.h"

namespace blockrand::importers::reference {

struct TilesetContent {
  std::string path;  ///< of a glTF file
  Matrix4 place;     ///< from its axes (y up) to the tileset's: earth-centred, where it has a place on the Earth
};

struct Tileset {
  std::string version;                   ///< "1.1"
  std::string crs, height_words;         ///< asset.extras of Blockrand's tilesets; else empty
  std::vector<TilesetContent> contents;  ///< depth first, as the file has them
  std::uint64_t bytes = 0;               ///< on disk, of all tilesets without their contents
};

/// Follows a tileset and those in it. What a tile replaces by its children (REPLACE) does not count; implicit tiling,
/// formats other than glTF, and what is missing is noted.
/// \throws base::InputError  when the outermost one is damaged or no tileset, nothing that can be read is in it, or it
///                            multiplies without end
Tileset read_tileset(const std::string& path, const Json& json, NoteLog& notes);

}  // namespace blockrand::importers::reference
