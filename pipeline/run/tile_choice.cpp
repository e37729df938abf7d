#include "pipeline/run/tile_choice.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/georef/tiles.h"

namespace blockrand::run {

namespace {

using model::MappedBuilding;

constexpr int kMaxLevel = 20;  // 19 m: smaller tiles are all halo

/// What the images showed of the whole, from the file beside the pinned build.json.
std::optional<outputs::ReadImagery> read_imagery(const std::string& pinned, const std::string& sha256) {
  if (sha256.empty()) return std::nullopt;
  const std::string path = (std::filesystem::path(pinned).parent_path() / "imagery.json").string();
  constexpr const char* kRemedy = "Let it lie beside the build.json of --pinned, as the build of the whole wrote it.";
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  if (!file) throw base::InputError(path, "", "cannot be read", kRemedy);
  if (base::sha256_file(path) != sha256) throw base::InputError(path, "", "is not what build.json lists", kRemedy);
  try {
    return outputs::read_imagery_json(bytes);
  } catch (const std::exception& e) {
    throw base::InputError(path, "", std::string("is damaged (") + e.what() + ")", kRemedy);
  }
}

}  // namespace

model::TileId parse_tile(const std::string& text, std::string_view option, int lowest) {
  std::int64_t numbers[3];
  const char* at = text.data();
  const char* const end = at + text.size();
  bool ok = true;
  for (int i = 0; i < 3 && ok; ++i) {
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    ok = error == std::errc() && (i == 2 ? next == end : next != end && *next == '/');
    at = next + 1;
  }
  ok = ok && numbers[0] >= lowest && numbers[0] <= kMaxLevel && numbers[1] >= 0 && numbers[1] < (2LL << numbers[0]) &&
       numbers[2] >= 0 && numbers[2] < (1LL << numbers[0]);
  if (!ok)
    throw base::UsageError(
        std::string(option) + " " + text +
        " is no tile. Write level/x/y as in the file names below tiles/, for example 15/35207/25941; level from " +
        std::to_string(lowest) + " to " + std::to_string(kMaxLevel));
  return {static_cast<int>(numbers[0]), static_cast<std::uint32_t>(numbers[1]), static_cast<std::uint32_t>(numbers[2])};
}

std::string text_of(const model::TileId& tile) {
  return std::to_string(tile.level) + "/" + std::to_string(tile.x) + "/" + std::to_string(tile.y);
}

TileRange tiles_in(const georef::GeoBox& box, int level) {
  const auto tile_at = [&](double lon, double lat) {
    constexpr double kUnits = 1e7;
    return georef::tile_of({static_cast<std::int32_t>(std::lround(std::clamp(lon, -180.0, 180.0) * kUnits)),
                            static_cast<std::int32_t>(std::lround(std::clamp(lat, -90.0, 90.0) * kUnits))},
                           level);
  };
  TileRange range{tile_at(box.west, box.south), tile_at(box.east, box.north)};
  // Across 180 degrees: what lies between them is everything.
  if (box.east > 180 || box.west < -180 || box.west > box.east)
    range.low.x = 0, range.high.x = (std::uint32_t{2} << level) - 1;
  return range;
}

std::optional<TileRange> common(const TileRange& a, const TileRange& b) {
  TileRange out = a;
  out.low.x = std::max(a.low.x, b.low.x), out.low.y = std::max(a.low.y, b.low.y);
  out.high.x = std::min(a.high.x, b.high.x), out.high.y = std::min(a.high.y, b.high.y);
  if (out.low.x > out.high.x || out.low.y > out.high.y) return std::nullopt;
  return out;
}

TileChoice choose_area(const model::TileId& area, RegionFacts facts) {
  TileChoice choice;
  choice.id = area;
  choice.tile_level = footprints::kTileLevel;
  choice.facts = std::move(facts);
  choice.region = tiles_in(choice.facts.box, choice.tile_level);
  // Every area is the same whatever stands at the other end of the region. The box chooses among PROJ's operations.
  georef::GeoBox& box = choice.facts.box;
  constexpr double kSteps = 10;  // of a degree
  box = {std::floor(box.west * kSteps) / kSteps, std::floor(box.south * kSteps) / kSteps,
         std::ceil(box.east * kSteps) / kSteps, std::ceil(box.north * kSteps) / kSteps};
  choice.facts.centre = georef::centre(area);
  const georef::GeoBox window = georef::with_halo(area, kHalo);
  choice.window = {window.west, window.south, window.east, window.north};
  return choice;
}

std::optional<TileChoice> choose_tile(const BuildOptions& options) {
  if (options.tile.empty()) {
    if (!options.pinned.empty() && options.area.empty())
      throw base::UsageError("--pinned is of use with --tile and --area only");
    return std::nullopt;
  }
  if (options.pinned.empty())
    throw base::UsageError(
        "--tile needs --pinned build.json of a build of the whole extract: a tile alone cannot choose the CRS");
  const bool shows_images = options.outputs.ground == outputs::GroundChoice::imagery;
  if (!options.imagery.images.empty() && !shows_images)
    throw base::UsageError(
        "--tile takes what the images show from the build of --pinned (its imagery.json): leave out --imagery");
  if (options.bbox) throw base::UsageError("--tile and --bbox contradict each other");
  if (!options.crs.empty()) throw base::UsageError("--tile takes the CRS of --pinned: leave out --crs");
  TileChoice choice;
  choice.id = parse_tile(options.tile, "--tile");
  choice.tile_level = choice.id.level;
  choice.facts = read_region_facts(options.pinned, options);
  choice.imagery = read_imagery(options.pinned, choice.facts.imagery_sha256);
  const std::size_t shown = choice.imagery ? choice.imagery->images.size() : 0;
  if (shows_images && shown != options.imagery.images.size())
    throw base::UsageError("--ground imagery shows a tile in the images of the build of --pinned, which had " +
                           std::to_string(shown) + ": name the same with --imagery, in the same order");
  const georef::GeoBox window = georef::with_halo(choice.id, kHalo);
  choice.window = {window.west, window.south, window.east, window.north};
  return choice;
}

std::vector<std::size_t> shards_to_build(std::span<const footprints::Shard> shards,
                                         const std::optional<TileChoice>& tile) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < shards.size(); ++i)
    if (!tile || (georef::contains(tile->id, shards[i].tile) && (!tile->only || tile->only->contains(shards[i].tile))))
      out.push_back(i);
  return out;
}

bool lies_in(const model::Extract& extract, const MappedBuilding& object, const TileChoice& tile) {
  const std::optional<model::Location> place =
      object.rings.count > 0 ? footprints::box_centre(extract, object) : object.place;
  return place ? georef::tile_of(*place, tile.id.level) == tile.id : tile.placeless;
}

void forget_others(model::Extract& extract, const TileChoice& tile,
                   const std::function<bool(const MappedBuilding&)>& is_here, std::vector<model::ReportRow>& rows) {
  std::set<model::OsmId> others, features;
  std::vector<MappedBuilding> buildings;
  for (const MappedBuilding& b : extract.buildings)
    if (is_here(b))
      buildings.push_back(b);
    else
      others.insert(b.id);
  for (const model::Feature& f : extract.features) {
    if (f.rings.count == 0 || extract.rings[f.rings.first].vertices.count == 0) continue;
    const model::Location first = extract.vertices_of(extract.rings[f.rings.first]).front();
    if (georef::tile_of(first, tile.id.level) == tile.id) features.insert(f.id);
  }
  std::erase_if(rows, [&](const model::ReportRow& row) {
    if (others.contains(row.object)) return true;
    const bool is_building = std::ranges::binary_search(buildings, row.object, {}, &MappedBuilding::id);
    return !is_building && !features.contains(row.object);
  });
  extract.buildings = std::move(buildings);
}

}  // namespace blockrand::run
