// Building one tile alone, in a process of its own: a shard of a cluster, a tile of an update.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/footprints/shard.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/report.h"
#include "pipeline/outputs/imagery/imagery_document.h"
#include "pipeline/run/build.h"
#include "pipeline/run/region_facts.h"

namespace blockrand::run {

/// m around a tile that its buildings depend on: a block of up to 1 km, whose buildings stand in rows of up to 1 km that
/// are known to be longer when the data goes on; and a kilometre for what chains of these and large buildings add.
inline constexpr double kHalo = 3000;

/// Tiles of one level between two of them, which count as well.
struct TileRange {
  model::TileId low, high;
  bool holds(const model::TileId& tile) const {
    return tile.x >= low.x && tile.x <= high.x && tile.y >= low.y && tile.y <= high.y;
  }
};
/// Those that a box in degrees meets.
TileRange tiles_in(const georef::GeoBox& box, int level);
/// Both; empty where they have none in common.
std::optional<TileRange> common(const TileRange& a, const TileRange& b);

/// A tile that is built alone, or an area of many tiles.
struct TileChoice {
  model::TileId id;
  int tile_level = 0;                           ///< of the tiles that are made: that of `id` for one tile
  bool placeless = false;                       ///< of an area: objects without any known position are told here
  std::optional<std::set<model::TileId>> only;  ///< of an area: the tiles that are looked into; empty: all
  bool is_area() const { return tile_level > id.level; }
  RegionFacts facts;                            ///< of the whole extract
  std::optional<outputs::ReadImagery> imagery;  ///< what the build of the whole saw in its images
  std::array<double, 4> window{};  ///< west, south, east, north in degrees: the tile and its halo, all that is read
  std::vector<std::array<double, 4>> parts;  ///< with `only`: of the window what is read; empty: all
  TileRange region;                          ///< of an area: tiles among the buildings of the whole
  std::set<model::TileId> other_network;     ///< of `only`: those near which streets or the like changed
};

/// The area, its window and its place in the region. \param facts  of the whole
TileChoice choose_area(const model::TileId& area, RegionFacts facts);

/// "11/1093/805"
std::string text_of(const model::TileId& tile);

/// Reads it. \throws base::UsageError  \param option  for messages
/// \param lowest  level
model::TileId parse_tile(const std::string& text, std::string_view option, int lowest = 8);
inline constexpr int kLowestArea = 1;

/// What the options ask for; empty for the whole extract.
/// \throws base::UsageError  `tile` is not "level/x/y", or lacks `pinned`, or contradicts other options
/// \throws base::InputError  `pinned` cannot be used
std::optional<TileChoice> choose_tile(const BuildOptions& options);

/// Indices of the shards to build: all, the tile's, or those in the area (none where it holds no building).
std::vector<std::size_t> shards_to_build(std::span<const footprints::Shard> shards,
                                         const std::optional<TileChoice>& tile);

/// Whether the middle of an object is in the tile; one without a place: whether the tile tells of such.
bool lies_in(const model::Extract& extract, const model::MappedBuilding& object, const TileChoice& tile);

/// Removes the objects of other tiles from the extract, and their rows: they were read as surroundings only. Rows of what is no
/// building belong to the tile of its first vertex.
void forget_others(model::Extract& extract, const TileChoice& tile,
                   const std::function<bool(const model::MappedBuilding&)>& is_here,
                   std::vector<model::ReportRow>& rows);

}  // namespace blockrand::run
