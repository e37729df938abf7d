#include "pipeline/run/area_surroundings.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipeline/georef/tiles.h"

namespace blockrand::run {
namespace {

using Json = nlohmann::ordered_json;
using model::Feature;
using surroundings::SharedOutcome;

/// m: how far out of its place an object is told of at most. A square of 125 m belongs to the tile of its middle; wires hang beside
/// their line.
constexpr double kToldBeside = 150;

}  // namespace

bool begins_in(const model::Extract& extract, const Feature& feature, const model::TileId& area, bool placeless) {
  for (const model::MappedRing& ring : extract.rings_of(feature.rings))
    if (const auto vertices = extract.vertices_of(ring); !vertices.empty())
      return georef::tile_of(vertices.front(), area.level) == area;
  return placeless;
}

std::function<std::optional<RecordedThing>(const Feature&)> thing_recorder(
    const model::Extract& extract, const surroundings::Catalogue& catalogue,
    const surroundings::SurroundingOptions& layers, const model::TileId& area) {
  const georef::GeoBox around = georef::with_halo(area, kToldBeside), own = georef::bounds(area);
  const double x = std::max(around.east - own.east, own.west - around.west),
               y = std::max(around.north - own.north, own.south - around.south);
  const auto is_within = [&extract, own, x, y](const Feature& feature) {
    constexpr double kUnit = 1e-7;
    for (const model::MappedRing& ring : extract.rings_of(feature.rings))
      for (const model::Location at : extract.vertices_of(ring)) {
        const double lon = kUnit * at.lon, lat = kUnit * at.lat;
        if (lon < own.west + x || lon > own.east - x || lat < own.south + y || lat > own.north - y) return false;
      }
    return true;
  };
  return [&extract, &catalogue, layers, is_within](const Feature& feature) -> std::optional<RecordedThing> {
    const surroundings::TagOf tag = [&](std::string_view key) { return extract.tag(feature.tags, key); };
    const std::optional<surroundings::SurroundingKind> kind = surroundings::kind_of(feature, tag, catalogue);
    if (!kind || !surroundings::is_asked(*kind, layers)) return std::nullopt;
    return RecordedThing{feature.id, static_cast<std::uint8_t>(*kind), is_within(feature)};
  };
}

std::vector<SharedOutcome> close_surroundings(std::span<const RecordedThing> things,
                                              surroundings::SurroundingAccount& account) {
  for (const RecordedThing& thing : things) account.take({thing.id, thing.kind, surroundings::kElsewhere});
  std::vector<SharedOutcome> out;
  for (const auto& [id, told] : account.outcomes()) {
    const auto thing = std::ranges::lower_bound(things, id, {}, &RecordedThing::id);
    if (thing == things.end() || thing->id != id || !thing->inside) out.push_back({id, told.kind, told.state});
  }
  return out;
}

Json shared_json(const std::vector<SharedOutcome>& outcomes) {
  Json out = Json::array();
  for (const SharedOutcome& o : outcomes)
    out.push_back({static_cast<int>(o.object.type), o.object.number, o.kind, o.state});
  return out;
}

bool read_shared(const Json& json, std::vector<SharedOutcome>& out) {
  if (!json.is_array()) return false;
  for (const Json& row : json) {
    if (!row.is_array() || row.size() != 4) return false;
    for (const Json& value : row)
      if (!value.is_number_integer()) return false;
    const auto type = row[0].get<std::int64_t>(), kind = row[2].get<std::int64_t>(), state = row[3].get<std::int64_t>();
    if (type < 0 || type > 2 || kind < 0 || static_cast<std::size_t>(kind) >= surroundings::kSurroundingKindCount ||
        state < 0 || static_cast<std::size_t>(state) >= surroundings::kToldStateCount)
      return false;
    out.push_back({{static_cast<model::OsmType>(type), row[1].get<std::int64_t>()},
                   static_cast<std::uint8_t>(kind),
                   static_cast<std::uint8_t>(state)});
  }
  return true;
}

Json surroundings_json(const surroundings::SurroundingCounts& counts) {
  Json out = Json::object();
  for (std::size_t k = 0; k < counts.size(); ++k) {
    Json of_kind = Json::object();
    for (std::size_t s = 0; s < counts[k].size(); ++s)
      if (counts[k][s] > 0) of_kind[std::string(surroundings::name_of_state(s))] = counts[k][s];
    if (!of_kind.empty()) out[std::string(surroundings::kSurroundingKindNames[k])] = std::move(of_kind);
  }
  return out;
}

void settle_surroundings(const std::vector<SharedOutcome>& shared, Json& sum) {
  surroundings::SurroundingCounts counts{};
  for (std::size_t k = 0; k < counts.size(); ++k)
    for (std::size_t s = 0; s < counts[k].size(); ++s)
      if (const auto kind = sum.find(std::string(surroundings::kSurroundingKindNames[k])); kind != sum.end())
        counts[k][s] = kind->value(std::string(surroundings::name_of_state(s)), std::uint64_t{0});
  surroundings::SurroundingAccount once;
  for (const SharedOutcome& o : shared) --counts[o.kind][o.state], once.take(o);
  const surroundings::SurroundingCounts merged = once.counts();
  for (std::size_t k = 0; k < counts.size(); ++k)
    for (std::size_t s = 0; s < counts[k].size(); ++s) counts[k][s] += merged[k][s];
  sum = surroundings_json(counts);
}

}  // namespace blockrand::run
