#include "pipeline/run/tile_work.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "pipeline/base/pack.h"
#include "pipeline/base/parallel.h"
#include "pipeline/run/tile_key.h"

namespace blockrand::run {
namespace {

constexpr std::string_view kKind = "tiles";

/// An Outcome by the object's id: its index is that of one run.
struct KeptOutcome {
  model::OsmId object;
  model::ObjectState state = model::ObjectState::modelled;
  model::IssueCode code = model::IssueCode::none;
  model::OsmId related;
  std::int32_t lod = -1;
};

/// A TileResult as it lies in the cache, but for its files.
struct KeptTile {
  std::vector<KeptOutcome> outcomes;
  bool below_quality = false;
  std::vector<model::ReportRow> rows;
  outputs::TileStatistics statistics;
  std::vector<std::string> products;
  std::uint64_t microseconds = 0;
};

std::optional<std::uint32_t> index_in(const model::Extract& extract, model::OsmId id) {
  const auto object = std::ranges::lower_bound(extract.buildings, id, {}, &model::MappedBuilding::id);
  if (object == extract.buildings.end() || !(object->id == id)) return std::nullopt;
  return static_cast<std::uint32_t>(object - extract.buildings.begin());
}

}  // namespace

OpenOutputs::OpenOutputs(const outputs::OutputContext& context) {
  for (const outputs::OutputFormat& format : outputs::all_outputs()) {
    if (!format.asked(context.options)) continue;
    list.push_back(format.open(context));
    names_files.push_back(format.names_files);
    takes_regions = takes_regions || (format.takes_regions && format.takes_regions(context.options));
    keeps_whole = keeps_whole || (format.keeps_whole && format.keeps_whole(context.options));
  }
}

namespace {

/// Products and files, in the order of the outputs; each is written by whichever thread is free.
/// \param at_once  outputs beside each other: less time, more memory
void write_outputs(const outputs::FinishedTile& tile, const OpenOutputs& open, bool at_once, TileResult& result) {
  result.products.resize(open.list.size());
  std::vector<std::vector<base::PublishedFile>> written(open.list.size());
  const auto write = [&](std::size_t i, std::vector<base::PublishedFile> files) {
    outputs::FinishedTile own = tile;
    own.files = std::move(files);
    result.products[i] = open.list[i]->write_tile(own);
    return std::move(own.files);
  };
  const auto write_own = [&](std::size_t i) {
    if (!open.names_files[i]) written[i] = write(i, {});
  };
  if (at_once)
    base::share(open.list.size(), write_own);
  else
    for (std::size_t i = 0; i < open.list.size(); ++i) write_own(i);
  for (std::vector<base::PublishedFile>& files : written)
    result.files.insert(result.files.end(), std::make_move_iterator(files.begin()),
                        std::make_move_iterator(files.end()));
  for (std::size_t i = 0; i < open.list.size(); ++i)
    if (open.names_files[i]) result.files = write(i, std::move(result.files));
}

}  // namespace

TileResult work_on_tile(std::size_t shard, std::size_t place, const TileInputs& inputs,
                        const surroundings::SurroundingsFinder* around, const OpenOutputs& open, const Account& account,
                        const model::Extract& told) {
  const auto start = std::chrono::steady_clock::now();
  TileResult result;
  model::Region region = run_tile(shard, inputs);
  result.may_be_kept = positions_as_measured(region, inputs.repaired.first[shard], inputs.styles.facts);
  result.outcomes = decide_outcomes(region, inputs.lod);
  result.statistics = outputs::count_statistics(region);
  model::Surroundings surroundings;
  if (around) surroundings = around->around(region.tile);
  result.statistics.surroundings = std::move(surroundings.outcomes);
  const outputs::FinishedTile tile{
      .region = region,
      .surroundings = around ? &surroundings : nullptr,
      .shard = place,
      .name = outputs::tile_name(region.tile),
      .has_parts = std::ranges::any_of(region.buildings, [](const model::Building& b) { return !b.parts.empty(); }),
      .final_state = account.final_states(result.outcomes.list, inputs.extract),
      .files = {}};
  const bool in_area = &told != &inputs.extract;
  write_outputs(tile, open, !in_area, result);
  if (in_area)
    for (Outcome& o : result.outcomes.list) o.index = index_in(told, inputs.extract.buildings[o.index].id).value();
  result.rows = std::move(region.report.rows);
  if (open.takes_regions || open.keeps_whole) result.region = std::move(region);
  result.microseconds = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start).count());
  return result;
}

void keep_tile(const std::string& key, const TileResult& result, const OpenOutputs& open, const model::Extract& extract,
               const std::string& folder, WorkCache& cache) {
  KeptTile kept;
  for (const Outcome& o : result.outcomes.list)
    kept.outcomes.push_back({extract.buildings[o.index].id, o.state, o.code, o.related, o.lod});
  kept.below_quality = result.outcomes.below_quality;
  kept.rows = result.rows;
  kept.statistics = result.statistics;
  kept.microseconds = result.microseconds;
  for (std::size_t i = 0; i < open.list.size(); ++i)
    kept.products.push_back(open.list[i]->packed_product(result.products[i]));
  cache.keep(kKind, key, base::packed(kept), result.files, folder);
}

bool tile_is_kept(const std::string& key, WorkCache& cache) { return cache.find(kKind, key).has_value(); }

std::optional<TileResult> kept_tile(const std::string& key, const OpenOutputs& open, const model::Extract& extract,
                                    base::StagedFolder& folder, WorkCache& cache) {
  std::optional<WorkCache::Found> found = cache.find(kKind, key);
  if (!found) return std::nullopt;
  TileResult result;
  result.kept = true;
  try {
    KeptTile kept = base::unpacked<KeptTile>(found->bytes);
    if (kept.products.size() != open.list.size()) return std::nullopt;
    for (const KeptOutcome& o : kept.outcomes) {
      const std::optional<std::uint32_t> index = index_in(extract, o.object);
      if (!index) return std::nullopt;
      result.outcomes.list.push_back({*index, o.state, o.code, o.related, o.lod});
    }
    result.outcomes.below_quality = kept.below_quality;
    result.rows = std::move(kept.rows);
    result.statistics = std::move(kept.statistics);
    result.microseconds = kept.microseconds;
    for (std::size_t i = 0; i < open.list.size(); ++i)
      result.products.push_back(open.list[i]->unpacked_product(kept.products[i]));
  } catch (const base::UnpackError&) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < found->files.size(); ++i) folder.link(found->files[i], found->places[i]);
  result.files = std::move(found->files);
  return result;
}

}  // namespace blockrand::run
