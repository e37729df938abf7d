#include "pipeline/run/area_tiles.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "pipeline/georef/tiles.h"

namespace blockrand::run {

AreaRecord record_tiles(const RecordInputs& inputs, AreaRecord before) {
  const std::optional<std::set<model::TileId>>& only = inputs.area.only;
  AreaRecord tiles = record_area(inputs, [&](const model::TileId& t) { return !only || only->contains(t); });
  for (auto& [tile, told] : before)
    if (!only->contains(tile)) tiles.emplace(tile, std::move(told));
  return tiles;
}

AreaRecord records_before(const AreaPart& part, WorkCache* cache) {
  if (cache)
    if (const std::optional<WorkCache::Found> found = cache->find(kRecords, part.before_key)) try {
        return base::unpacked<AreaRecord>(found->bytes);
      } catch (const base::UnpackError&) {
      }
  throw WindowTooSmall("records of tiles are missing");
}

void note_reaches(const TileChoice& area, const ReachInputs& inputs, AreaRecord& records) {
  std::vector<model::TileId> tiles;
  for (const auto& [tile, told] : records)
    if (!area.only || area.only->contains(tile)) tiles.push_back(tile);
  std::vector<geometry::PlanBox> read;
  for (const auto& part : area.parts) read.push_back(within_window(part, inputs.located.projection));
  // What counts for an area lies within this (kHalo), however far boxes of boxes reach.
  constexpr double kBent = 100;  // m: sides of windows are, in the projection
  const georef::GeoBox halo = georef::with_halo(area.id, kHalo - kBent);
  const geometry::PlanBox most =
      within_window({halo.west, halo.south, halo.east, halo.north}, inputs.located.projection);
  for (const auto& [tile, reach] : reaches_of(inputs, tiles)) {
    records[tile].reach = reach;
    if (!area.only) continue;
    const geometry::PlanBox needed =
        common(most, needed_around(reach, rules_reach(inputs.book), area.other_network.contains(tile)));
    if (std::ranges::none_of(read, [&](const geometry::PlanBox& part) { return holds(part, needed); }))
      throw WindowTooSmall("tile " + text_of(tile) + " hears of more");
  }
}

void note_shown(std::span<const TileToTell> todo, const OpenOutputs& open, AreaRecord& records) {
  for (const TileToTell& t : todo) {
    std::string shown;
    for (const auto& output : open.list) shown += output->reads_of_tile(t.place);
    TileRecord& record = records.at(t.tile);
    if (!t.shard && record.shown != shown) throw WindowTooSmall("pictures show tile " + text_of(t.tile));
    record.shown = std::move(shown);
  }
}

std::vector<TileToTell> tiles_to_tell(std::span<const footprints::Shard> shards,
                                      std::span<const std::size_t> looked_into, const AreaAsTold* area,
                                      const AreaRecord& records) {
  std::vector<TileToTell> out;
  if (!area) {
    for (const std::size_t shard : looked_into) out.push_back({shards[shard].tile, shard, shard, {}});
    return out;
  }
  std::map<model::TileId, std::size_t> looked;
  for (const std::size_t shard : looked_into) looked[shards[shard].tile] = shard;
  for (std::size_t place = 0; place < area->shards.size(); ++place) {
    TileToTell& t = out.emplace_back(TileToTell{area->shards[place].tile, place, {}, {}});
    if (const auto shard = looked.find(t.tile); shard != looked.end())
      t.shard = shard->second;
    else
      t.key = records.at(t.tile).key;
  }
  return out;
}

}  // namespace blockrand::run
