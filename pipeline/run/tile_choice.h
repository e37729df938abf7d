// Building one tile alone, in a process of its own: a shard of a cluster, a tile of an update.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
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

/// A tile that is built alone.
struct TileChoice {
  model::TileId id;
  RegionFacts facts;                            ///< of the whole extract
  std::optional<outputs::ReadImagery> imagery;  ///< what the build of the whole saw in its images
  std::array<double, 4> window;  ///< west, south, east, north in degrees: the tile and its halo, all that is read
};

/// What the options ask for; empty for the whole extract.
/// \throws base::UsageError  `tile` is not "level/x/y", or lacks `pinned`, or contradicts other options
/// \throws base::InputError  `pinned` cannot be used
std::optional<TileChoice> choose_tile(const BuildOptions& options);

/// Indices of the shards to build: all, or the tile's (none where it holds no building).
std::vector<std::size_t> shards_to_build(std::span<const footprints::Shard> shards,
                                         const std::optional<TileChoice>& tile);

/// Removes the objects of other tiles from the extract, and their rows: they were read as surroundings only.
void forget_others(model::Extract& extract, model::TileId tile, std::vector<model::ReportRow>& rows);

}  // namespace blockrand::run
