#include "pipeline/run/area_changes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/footprints/shard.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::run {
namespace {

using geometry::PlanBox;
using model::TileId;

/// Kinds of features that nothing around houses is made of (surroundings::kind_of).
constexpr std::uint32_t kNotAround = [] {
  using enum model::FeatureKind;
  std::uint32_t bits = 0;
  for (const model::FeatureKind kind : {entrance, address, shop, roof_line, roof_apex, place, boundary})
    bits |= static_cast<std::uint32_t>(kind);
  return bits;
}();

AreaChanges look_into_all(std::string why) { return {{}, {}, {}, {}, std::move(why)}; }

double size(const PlanBox& box) {
  return box.empty() ? 0 : (box.maximum.x - box.minimum.x) * (box.maximum.y - box.minimum.y);
}
double size(const std::array<double, 4>& w) { return std::max(0.0, w[2] - w[0]) * std::max(0.0, w[3] - w[1]); }

PlanBox around(PlanBox box, const PlanBox& other) {
  box.include(other);
  return box;
}

/// Boxes that hold all of these, of which each lies in one: those that cost less together become one.
std::vector<PlanBox> joined(std::vector<PlanBox> boxes) {
  // Of what both would read: what lies in two boxes is read once, and there is work for each box.
  constexpr double kWorthIt = 1.1;
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t k = i + 1; k < boxes.size();) {
        const PlanBox both = around(boxes[i], boxes[k]);
        if (size(both) > kWorthIt * (size(boxes[i]) + size(boxes[k]) - size(common(boxes[i], boxes[k])))) {
          ++k;
          continue;
        }
        boxes[i] = both;
        boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(k));
        again = true;
      }
  }
  return boxes;
}

TileId tile_at(double lon, double lat) {
  constexpr double kUnits = 1e7;
  return georef::tile_of(
      {static_cast<std::int32_t>(std::lround(lon * kUnits)), static_cast<std::int32_t>(std::lround(lat * kUnits))},
      footprints::kTileLevel);
}

bool is_within(const importers::osm::ChangedObject& change, const std::array<double, 4>& window) {
  return change.box[0] <= window[2] && change.box[2] >= window[0] && change.box[1] <= window[3] &&
         change.box[3] >= window[1];
}

}  // namespace

AreaChanges concerned_tiles(const TileChoice& area, const AreaReach& reaches,
                            std::span<const importers::osm::ChangedObject> changes, const RulesReach& rules,
                            bool surroundings, const georef::Projection& projection) {
  AreaChanges out;
  std::vector<PlanBox> needed;
  const georef::GeoBox own = georef::bounds(area.id);
  const auto& all = area.window;
  for (const importers::osm::ChangedObject& change : changes) {
    if (change.placeless && area.placeless) return look_into_all("objects without a place");
    if (change.placeless && change.box == std::array<double, 4>{}) continue;
    // Somewhere else: no tile here reaches further than what is read for the area.
    if (!is_within(change, all)) continue;
    const geometry::PlanBox box = projected_box(change.box, projection);
    const double beyond = std::max(change.network ? kNetworkReach : 0, change.kinds != 0 ? rules.metres : 0);
    const bool look_only = change.look_only && !(rules.asks_look && change.kinds != 0);
    // These are heard of from farther away than reaches say (SurroundingsFinder::reach).
    if (surroundings && change.coast) return look_into_all("the coast, " + change.id.text());
    if (surroundings && (change.kinds & ~kNotAround) != 0 &&
        std::max(change.box[2] - change.box[0], change.box[3] - change.box[1]) > importers::osm::kWholeSpan)
      return look_into_all(change.id.text() + " spans much of it");
    constexpr double kBent = 1;  // m: sides of the box of an object in the projection
    for (const auto& [tile, reach] : reaches)
      if (look_only ? reach.look.near(box, kBent)
          : change.is_surrounding
              ? reach.around.near(box, kBent)
              : (change.building && reach.far.near(box, kBent)) || reach.near.near(box, beyond + kBent)) {
        out.tiles.insert(tile);
        if (change.network) out.other_network.insert(tile);
      }
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
          out.tiles.insert(tile);
          if (change.network) out.other_network.insert(tile);
          const georef::GeoBox b = georef::bounds(tile);
          const geometry::PlanBox ground = projected_box({b.west, b.south, b.east, b.north}, projection);
          const CellRuns alone{{}, ground};
          needed.push_back(around(needed_around({alone, ground, alone, alone, alone}, rules.metres, true), box));
        }
  }
  if (out.tiles.empty()) return {};
  for (const TileId& tile : out.tiles)
    if (const auto reach = reaches.find(tile); reach != reaches.end())
      needed.push_back(needed_around(reach->second, rules.metres, out.other_network.contains(tile)));
  // Outlines that changed may reach a little further than before.
  constexpr double kMore = 150;  // m
  for (PlanBox& box : needed) {
    box.minimum = {box.minimum.x - kMore, box.minimum.y - kMore};
    box.maximum = {box.maximum.x + kMore, box.maximum.y + kMore};
  }
  double read = 0;
  for (const PlanBox& box : joined(std::move(needed))) {
    const std::array<double, 4> asked = window_around(box, projection);
    const std::array<double, 4> part{std::max(asked[0], all[0]), std::max(asked[1], all[1]), std::min(asked[2], all[2]),
                                     std::min(asked[3], all[3])};
    if (part[0] > part[2] || part[1] > part[3]) continue;
    read += size(part);
    if (out.parts.empty()) out.window = part;
    out.window = {std::min(out.window[0], part[0]), std::min(out.window[1], part[1]), std::max(out.window[2], part[2]),
                  std::max(out.window[3], part[3])};
    out.parts.push_back(part);
  }
  // Of what is read for the area: above it little is saved, and sometimes it is looked into twice.
  constexpr double kMostOfAll = 0.85;
  if (read > kMostOfAll * size(all)) return look_into_all("most of it is concerned");
  return out;
}

}  // namespace blockrand::run
