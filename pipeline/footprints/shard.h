// Which buildings there are, which parts belong to them, and which tile each is in.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/extract.h"
#include "pipeline/model/region.h"

namespace blockrand::footprints {

/// An outline with its parts, a part that stands alone, or parts without an outline that share walls. Indices into
/// Extract::buildings.
struct Seed {
  std::uint32_t outline = model::kNoIndex;  ///< kNoIndex for parts without outline
  std::vector<std::uint32_t> parts;         ///< in id order
  std::uint32_t lead() const { return outline != model::kNoIndex ? outline : parts.front(); }
};

/// The buildings of one tile, in id order of their leads.
struct Shard {
  model::TileId tile;
  std::vector<Seed> seeds;
};

/// Level of the tiles that are the unit of work and of output files (ARCHITECTURE.md, "Coordinates").
inline constexpr int kTileLevel = 15;

/// Centre of the raw bounding box of an object's rings; longitudes are unwrapped around its first vertex, so that an
/// object across 180 degrees has its centre there. The object must have a ring.
model::Location box_centre(const model::Extract& extract, const model::MappedBuilding& object);

/// Assigns parts to outlines and both to tiles. A part belongs to the outline that a type=building relation names, unless
/// that holds less than half of its corners and another outline all of them (PARTS_OUTSIDE in `report`); without a
/// relation to the smallest outline that holds at least half of its corners (boundary included) and whose box holds the
/// middle of the part's. A part that no outline holds stands alone (PART_WITHOUT_OUTLINE), together with those of its
/// kind that it shares an edge with (two nodes in sequence), and so on: one building. A building belongs to the tile of
/// the centre of its lead's raw box. Shards come in tile order; nothing depends on the order of the input.
std::vector<Shard> make_shards(const model::Extract& extract, model::Report& report, int level = kTileLevel);

}  // namespace blockrand::footprints
