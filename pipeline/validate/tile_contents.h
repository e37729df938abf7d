// A tile's files, read: what each format holds, and the frame in which its meshes stand.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "pipeline/validate/contents.h"
#include "pipeline/validate/formats.h"
#include "pipeline/validate/glb.h"
#include "pipeline/validate/tile_check.h"
#include "pipeline/validate/tileset_reader.h"

namespace blockrand::validate {

inline constexpr auto kGltf = static_cast<std::size_t>(Format::gltf),
                      kCityGml = static_cast<std::size_t>(Format::citygml),
                      kCityJson = static_cast<std::size_t>(Format::cityjson);

/// What could be read of a tile; a format whose file is missing or unreadable is absent.
struct TileContents {
  std::optional<Glb> glb;
  std::array<std::optional<Contents>, kTileFormats> models;  ///< by format; that of glTF is in `glb`
  Matrix transform = kIdentity;                              ///< from the tile's frame to ECEF

  /// A format's contents, or null.
  const Contents* of(std::size_t format) const;
  /// The first format that tells bodies, attributes and geometry; null where none is there.
  const Contents* model(std::size_t& format) const;
};

/// The content of a file of the tile, unzipped. A file that is not there was found already; FILE_UNREADABLE is noted in
/// `result`. Both make `counts` incomplete.
std::optional<std::string> load_file(const std::string& path, const TileContext& context, FormatCounts& counts,
                                     TileResult& result);

/// A GLB against its own rules and the CRS of build.json.
std::optional<Glb> read_glb_file(const std::string& path, const TileContext& context, TileResult& result);

/// Whether the mesh lies in its tile's volume and those around it; else TILE_BOUNDS.
void check_bounds(const Glb& glb, const TilesetEntry& entry, const std::string& path, TileResult& result);

/// All files of a tile against the rules of their formats. Findings and incomplete counts go into `result`.
TileContents read_tile(const TileFiles& files, const TileContext& context, TileResult& result);

}  // namespace blockrand::validate
