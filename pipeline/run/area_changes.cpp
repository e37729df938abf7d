#include "pipeline/run/area_changes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/footprints/shard.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::run {
namespace {

using model::TileId;

AreaChanges look_into_all(std::string why) { return {{}, {}, std::move(why)}; }

TileId tile_at(double lon, double lat) {
  constexpr double kUnits = 1e7;
  return georef::tile_of(
      {static_cast<std::int32_t>(std::lround(lon * kUnits)), static_cast<std::int32_t>(std::lround(lat * kUnits))},
      footprints::kTileLevel);
}

}  // namespace

AreaChanges concerned_tiles(const TileChoice& area, const AreaReach& reaches,
                            std::span<const importers::osm::ChangedObject> changes, const RulesReach& rules,
                            const georef::Projection& projection) {
  std::set<TileId> tiles;
  geometry::PlanBox needed;
  const georef::GeoBox own = georef::bounds(area.id);
  const auto& all = area.window;
  for (const importers::osm::ChangedObject& change : changes) {
    if (change.placeless && area.placeless) return look_into_all("objects without a place");
    if (change.placeless && change.box == std::array<double, 4>{}) continue;
    // Somewhere else: no tile here reaches further than what is read for the area.
    if (change.box[0] > all[2] || change.box[2] < all[0] || change.box[1] > all[3] || change.box[3] < all[1]) continue;
    const geometry::PlanBox box = projected_box(change.box, projection);
    const double beyond = std::max(change.network ? kNetworkReach : 0, change.kinds != 0 ? rules.metres : 0);
    const bool look_only = change.look_only && !(rules.asks_look && change.kinds != 0);
    constexpr double kBent = 1;  // m: sides of the box of an object in the projection
    for (const auto& [tile, reach] : reaches)
      if (look_only ? reach.look.near(box, kBent)
                    : (change.building && reach.far.near(box, kBent)) || reach.near.near(box, beyond + kBent))
        tiles.insert(tile);
    // Tiles that may tell of it for the first time.
    const std::array<double, 4> here{std::max(change.box[0], own.west), std::max(change.box[1], own.south),
                                     std::min(change.box[2], own.east), std::min(change.box[3], own.north)};
    if (here[0] > here[2] || here[1] > here[3]) continue;
    const TileId low = tile_at(here[0], here[1]), high = tile_at(here[2], here[3]);
    constexpr std::uint64_t kMostTiles = 64;  // as many as an area has: it is looked into as a whole
    if ((high.x - low.x + std::uint64_t{1}) * (high.y - low.y + std::uint64_t{1}) > kMostTiles)
      return look_into_all(change.id.text() + " spans much of it");
    for (std::uint32_t y = low.y; y <= high.y; ++y)
      for (std::uint32_t x = low.x; x <= high.x; ++x)
        if (const TileId tile{footprints::kTileLevel, x, y}; georef::contains(area.id, tile)) {
          tiles.insert(tile);
          const georef::GeoBox b = georef::bounds(tile);
          const geometry::PlanBox ground = projected_box({b.west, b.south, b.east, b.north}, projection);
          const CellRuns alone{{}, ground};
          needed.include(needed_around({alone, alone, alone}, rules.metres));
          needed.include(box);
        }
  }
  if (tiles.empty()) return {};
  for (const TileId& tile : tiles)
    if (const auto reach = reaches.find(tile); reach != reaches.end())
      needed.include(needed_around(reach->second, rules.metres));
  // Outlines that changed may reach a little further than before.
  constexpr double kMore = 300;  // m
  needed.minimum = {needed.minimum.x - kMore, needed.minimum.y - kMore};
  needed.maximum = {needed.maximum.x + kMore, needed.maximum.y + kMore};
  const std::array<double, 4> around = window_around(needed, projection);
  const std::array<double, 4> window{std::max(around[0], all[0]), std::max(around[1], all[1]),
                                     std::min(around[2], all[2]), std::min(around[3], all[3])};
  constexpr double kMostOfAll = 0.6;  // of what is read for the area: above it looking twice would cost more
  const auto size = [](const std::array<double, 4>& w) { return (w[2] - w[0]) * (w[3] - w[1]); };
  if (size(window) > kMostOfAll * size(all)) return look_into_all("most of it is concerned");
  return {std::move(tiles), window, {}};
}

}  // namespace blockrand::run
