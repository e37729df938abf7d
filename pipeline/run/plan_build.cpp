#include "pipeline/run/plan_build.h"

#include <chrono>
#include <filesystem>
#include <set>
#include <vector>

#include "pipeline/attributes/overrides.h"
#include "pipeline/base/error.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/publish.h"
#include "pipeline/run/before_tiles.h"
#include "pipeline/run/build_areas.h"
#include "pipeline/run/build_inputs.h"
#include "pipeline/run/output_place.h"
#include "pipeline/run/prepare_extract.h"
#include "pipeline/run/sample_walls.h"

namespace blockrand::run {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// \param size  of what would be built: models cannot be more
void check_place(const BuildOptions& options, const outputs::BuiltSize& size, const base::StagedFolder& folder,
                 const BuildEstimate& estimate) {
  BuildSummary most;
  most.models = size.buildings;
  refuse_shrunk(options, most, earlier_models(folder.target_path()));
  check_free_space(options, estimate.disk_bytes, folder.free_bytes());
}

}  // namespace

BuildPlan plan_build(const BuildOptions& options, base::Progress& progress) {
  refuse_contradictions_of_areas(options);
  progress.begin("check");
  warn_of_unread(options, progress);
  if (!options.crs.empty()) georef::check_crs(options.crs);
  const base::StagedFolder folder(checked_output(options), options.force,
                                  {.foreign = foreign_files, .counts_only = true});
  BuildInputs inputs(options);
  const auto start = std::chrono::steady_clock::now();
  LocatedExtract located = locate_extract(options, inputs.tile, progress);
  const double read_seconds = seconds_since(start);
  const std::uint64_t store_bytes = current_memory();
  progress.begin("measure");
  if (located.area) warn_of_heights(options, inputs, located.facts.centre, progress);
  override_extract(options, inputs, located.extract, progress);
  model::Report unused;
  std::vector<footprints::Shard> shards =
      footprints::make_shards(located.extract, unused, inputs.tile ? inputs.tile->tile_level : footprints::kTileLevel);
  if (inputs.tile) {
    std::vector<footprints::Shard> asked;
    for (const std::size_t i : shards_to_build(shards, inputs.tile)) asked.push_back(shards[i]);
    shards = std::move(asked);
  }
  BuildPlan plan;
  plan.buildings = located.extract.counts.buildings(), plan.parts = located.extract.counts.parts();
  plan.size = town_size(located.extract, shards);
  if (options.areas > 0) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> areas;
    for (const footprints::Shard& shard : shards) {
      const int up = shard.tile.level - options.areas;
      if (up >= 0) areas.emplace(shard.tile.x >> up, shard.tile.y >> up);
    }
    plan.areas = areas.size();
  }
  plan.crs = located.crs;
  plan.heights = inputs.heights.words;
  plan.folder = folder.target_path();
  plan.replaces = std::filesystem::exists(plan.folder + "/build.json");
  plan.free_bytes = folder.free_bytes();
  const std::optional<double> per_wall = sample_walls(located.extract, shards, plan.size, options, read_seconds);
  plan.estimate = estimate(plan.size, options, read_seconds, store_bytes, per_wall);
  progress.end();
  check_place(options, plan.size.all, folder, plan.estimate);
  return plan;
}

}  // namespace blockrand::run
