// All that is done for one tile, its stages and its files, and the same taken from an earlier run.
#pragma once

#include <any>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/outputs/output.h"
#include "pipeline/outputs/statistics.h"
#include "pipeline/run/account.h"
#include "pipeline/run/outcome.h"
#include "pipeline/run/tile_stages.h"
#include "pipeline/run/work_cache.h"
#include "pipeline/surroundings/surroundings.h"

namespace blockrand::run {

/// The formats that a build writes, and what they want to be given.
struct OpenOutputs {
  explicit OpenOutputs(const outputs::OutputContext& context);
  std::vector<std::unique_ptr<outputs::Output>> list;
  std::vector<bool> names_files;  ///< parallel to list: OutputFormat::names_files
  bool takes_regions = false, keeps_whole = false;
};

/// A tile between its work and its turn.
struct TileResult {
  Outcomes outcomes;
  std::vector<model::ReportRow> rows;
  outputs::TileStatistics statistics;
  std::vector<std::any> products;  ///< parallel to OpenOutputs::list
  std::vector<base::PublishedFile> files;
  model::Region region;               ///< kept only for files of the whole build
  std::string key;                    ///< under which it is kept; empty: it is not
  bool kept = false;                  ///< it is from an earlier run
  bool may_be_kept = true;            ///< it is what its key says
  std::uint64_t microseconds = 0;     ///< of one thread, that the work took when it was done
  std::vector<std::string_view> why;  ///< it is not (BuildSummary::tiles_built_for)
};

/// All stages and all outputs of a tile. Safe for different tiles at the same time. Its outcomes are those of objects of `told`.
/// \param place  index of the tile among the shards that outputs know
/// \param told   that of the account; for an area not that of the inputs
/// \param around  null: no surroundings
TileResult work_on_tile(std::size_t shard, std::size_t place, const TileInputs& inputs,
                        const surroundings::SurroundingsFinder* around, const OpenOutputs& open, const Account& account,
                        const model::Extract& told);

/// Keeps a tile's work for the next run. Safe for different tiles at the same time. \param folder  where its files lie
void keep_tile(const std::string& key, const TileResult& result, const OpenOutputs& open, const model::Extract& extract,
               const std::string& folder, WorkCache& cache);

/// Whether kept_tile would find it. Safe for different tiles at the same time.
bool tile_is_kept(const std::string& key, WorkCache& cache);

/// The work of an earlier run, its files put into `folder`; nothing where there is none. Safe for different tiles at the same
/// time.
std::optional<TileResult> kept_tile(const std::string& key, const OpenOutputs& open, const model::Extract& extract,
                                    base::StagedFolder& folder, WorkCache& cache);

}  // namespace blockrand::run
