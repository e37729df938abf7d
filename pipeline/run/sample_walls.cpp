#include "pipeline/run/sample_walls.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "pipeline/base/progress.h"
#include "pipeline/georef/tiles.h"
#include "pipeline/outputs/output.h"
#include "pipeline/run/build.h"

namespace blockrand::run {
namespace {

constexpr std::size_t kTiles = 3;
constexpr double kPatience = 15;  // s, for reading the extract again and again

/// The build of the facades of one tile: no report, no GeoPackage, whose sizes follow from the number of buildings.
BuildOptions of_tile(const model::TileId& tile, const BuildOptions& options) {
  BuildOptions one = options;
  const georef::GeoBox box = georef::bounds(tile);
  one.bbox = {box.west, box.south, box.east, box.north};
  if (options.bbox) {
    const auto& asked = *options.bbox;
    one.bbox = {std::max(box.west, asked[0]), std::max(box.south, asked[1]), std::min(box.east, asked[2]),
                std::min(box.north, asked[3])};
  }
  one.output = (std::filesystem::temp_directory_path() / ("blockrand-sample-" + std::to_string(::getpid()))).string();
  one.measure = true;
  one.tile = one.pinned = one.area = one.cache = one.terrain = one.terrain_height_reference = one.overrides = "";
  one.areas = 0, one.memory_limit = 0;
  one.ground_height = 0;
  one.imagery.images.clear();
  one.surroundings = {};  // their bytes are those of other things than walls
  one.outputs.imagery = one.outputs.report = one.outputs.explain = false;
  std::erase(one.outputs.formats, "gpkg");
  return one;
}

}  // namespace

std::optional<double> sample_walls(const model::Extract& extract, std::span<const footprints::Shard> shards,
                                   const TownSize& town, const BuildOptions& options, double read_seconds) {
  const BuildOptions any = of_tile({}, options);
  if (options.lod < 3 || town.all.walls <= 0 || outputs::output_size(any.outputs, options.lod).per_wall <= 0)
    return std::nullopt;
  const std::size_t wanted = std::min(kTiles, static_cast<std::size_t>(kPatience / std::max(0.01, read_seconds)));
  // Those in which an even share of all walls is reached, in their order, which is one through the town.
  std::set<std::size_t> chosen;
  std::vector<outputs::BuiltSize> sizes;
  double walls = 0;
  for (const footprints::Shard& shard : shards) sizes.push_back(town_size(extract, {&shard, 1}).all);
  for (std::size_t i = 0; i < shards.size(); ++i) {
    const double before = walls;
    walls += sizes[i].walls;
    for (std::size_t k = 0; k < wanted; ++k) {
      const double mark = (static_cast<double>(k) + 0.5) / static_cast<double>(wanted) * town.all.walls;
      if (before <= mark && mark < walls) chosen.insert(i);
    }
  }
  double bytes = 0, of_walls = 0;
  for (const std::size_t i : chosen) {
    const BuildOptions one = of_tile(shards[i].tile, options);
    base::Progress nobody(base::ProgressStyle::none, base::LogFormat::text, true, [](std::string_view) {});
    const BuildSummary summary = build(one, nobody);
    outputs::OutputSize bare = outputs::output_size(one.outputs, options.lod);
    bare.per_wall = 0;
    bytes += std::max(0.0, static_cast<double>(summary.bytes) - bare.bytes(sizes[i]));
    of_walls += sizes[i].walls;
  }
  return of_walls > 0 ? std::optional(bytes / of_walls) : std::nullopt;
}

}  // namespace blockrand::run
