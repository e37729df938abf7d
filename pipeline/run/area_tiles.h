// The tiles of a build in areas: those that are looked into, and what is known of the others from before.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/footprints/shard.h"
#include "pipeline/run/area_reach.h"
#include "pipeline/run/area_record.h"
#include "pipeline/run/build_areas.h"
#include "pipeline/run/tile_work.h"
#include "pipeline/run/work_cache.h"

namespace blockrand::run {

/// A tile of the build.
struct TileToTell {
  model::TileId tile;
  std::size_t place = 0;             ///< among the shards that outputs know
  std::optional<std::size_t> shard;  ///< empty: it is not looked into, but what an earlier run made of it taken
  std::string key;                   ///< of that
};

/// Of the tiles that are looked into, and of the others as they were.
AreaRecord record_tiles(const RecordInputs& inputs, AreaRecord before);

/// \param cache  may be null \throws WindowTooSmall  they are not kept any more
AreaRecord records_before(const AreaPart& part, WorkCache* cache);

/// Of the tiles that are looked into. \throws WindowTooSmall  more must be read for them
void note_reaches(const TileChoice& area, const ReachInputs& inputs, AreaRecord& records);

/// What outputs show of a tile. \throws WindowTooSmall  of one that is not looked into it is something else now
void note_shown(std::span<const TileToTell> todo, const OpenOutputs& open, AreaRecord& records);

/// In tile order. \param area  null: all that is looked into
std::vector<TileToTell> tiles_to_tell(std::span<const footprints::Shard> shards,
                                      std::span<const std::size_t> looked_into, const AreaAsTold* area,
                                      const AreaRecord& records);

}  // namespace blockrand::run
