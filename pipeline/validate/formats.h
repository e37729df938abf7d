// The formats that a build may hold, as the validator knows them: written down once more, apart from the writers' list.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace blockrand::validate {

/// The formats that are files of a tile.
enum class Format { gltf, citygml, cityjson };
inline constexpr std::size_t kTileFormats = 3;

/// What is known of a format before a file of it is read.
struct FormatRules {
  std::string_view key;        ///< in `configuration.formats` of build.json
  std::string_view title{};    ///< in findings about all tiles
  std::string_view file{};     ///< in findings about one kind of file
  std::string_view checked{};  ///< what is checked of it
  /// Files of a tile are `<folder><tile><ending>`, or `…<ending>.gz`; empty where the format has none.
  std::string_view folder{};
  std::string_view ending{};
};

/// Every format; those of `Format` first, in its order. A format without a reader here is listed as well: its files are
/// compared with their hashes.
inline constexpr FormatRules kFormats[] = {
    {.key = "gltf",
     .title = "GLB tiles",
     .file = "GLB",
     .checked = "glTF 2.0, property tables, bounds, georeference",
     .folder = "tiles/",
     .ending = ".glb"},
    {.key = "citygml",
     .title = "CityGML",
     .file = "CityGML",
     .checked = "structure, references, attributes, colours",
     .folder = "citygml/",
     .ending = ".gml"},
    {.key = "cityjson",
     .title = "CityJSON",
     .file = "CityJSON",
     .checked = "structure, references, attributes, colours",
     .folder = "cityjson/",
     .ending = ".city.jsonl"},
    {.key = "gpkg"},
};

/// \param format  index below kTileFormats
inline std::string title(std::size_t format) { return std::string(kFormats[format].title); }

/// Whether build.json may name the format.
bool is_format(std::string_view key);

/// Whose file a path of a build is.
struct TilePath {
  std::string tile;  ///< "15_17600_12900"
  Format format = Format::gltf;
  std::optional<int> coarser;  ///< level of detail of a GLB beside the tile's finest
  bool piece = false;          ///< a GLB with a part of the tile's buildings
};

/// \returns  nothing for files of the whole build, and for files of surroundings
std::optional<TilePath> tile_path(std::string_view path);

/// "tiles/15/1/2_ground.glb": the ground as a picture.
bool is_ground(std::string_view path);

/// "citygml/15_1_2_surroundings.gml": CityGML of the tile "15_1_2"; pictures of the ground count; nothing for files of other kinds.
std::optional<TilePath> surroundings_path(std::string_view path);

/// "explain/15_1_2.jsonl.gz" → "15_1_2"; empty for other files.
std::string explained_tile(std::string_view path);

}  // namespace blockrand::validate
