// Which buildings of an extract a build is about: all, or those of the tile or area that is built alone.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::outputs {

/// By number: the buildings of a tile or area that is built alone, else all.
inline std::vector<bool> buildings_here(const footprints::RepairedExtract& repaired,
                                        std::span<const footprints::Shard> shards,
                                        const std::optional<model::TileId>& tile) {
  std::vector<bool> here(repaired.footprints.size(), !tile);
  if (tile)
    for (std::size_t s = 0; s < shards.size(); ++s)
      if (georef::contains(*tile, shards[s].tile))
        for (std::size_t i = 0; i < shards[s].seeds.size(); ++i) here[repaired.first[s] + i] = true;
  return here;
}

}  // namespace blockrand::outputs
