// A night of a region that several processes share: what `blockrand region plan` leaves for `region work` and `region finish`.
//
//   REGION/plan/plan.json   the run, its data, which shard builds which areas
//   REGION/plan/…           the work itself (shared_areas.h)
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_state.h"
#include "pipeline/run/shared_areas.h"

namespace blockrand::run {

struct UpdateSummary;

/// "2/8": the second of eight.
struct Shard {
  int number = 1, of = 1;
};
/// \throws base::UsageError
Shard parse_shard(const std::string& text);

struct RegionShards {
  int number = 0;  ///< of the run
  int shards = 1;
  std::optional<int> before;    ///< the build that was published
  DataState state;              ///< of the data that are built
  nlohmann::ordered_json told;  ///< of the summary: how the data came
  std::vector<PlannedArea> areas;

  /// \throws base::UsageError  there is no plan \throws base::InputError  it is damaged
  static RegionShards read(const RegionFolder& region);
  /// The last step of a plan: without it there is none. \throws base::OutputError
  void write(const RegionFolder& region) const;

  void note(const UpdateSummary& summary);
  void restore(UpdateSummary& summary) const;
  SharedAreas shared(const RegionFolder& region) const { return SharedAreas(region.plan()); }

  /// \param settings  settings_sha256 now
  /// \throws base::UsageError  settings, rules, program or the published build are not those of the plan
  void check_same(const RegionFolder& region, const std::string& settings) const;
  /// \throws base::UsageError  the plan has another number of shards
  void check_shard(const Shard& shard) const;
  /// \throws base::UsageError  areas are missing: which shards are to be run
  void check_done(const RegionFolder& region) const;
  /// Warns of processes that did not end. \returns  whether there are any
  bool tell_unended(const RegionFolder& region, base::Progress& progress) const;
};

/// What `blockrand status` tells of it.
struct PlanStatus {
  int number = 0, shards = 0;
  std::uint64_t areas = 0, done = 0;
};
std::optional<PlanStatus> plan_status(const RegionFolder& region);

/// \throws base::UsageError  a plan is under way
void refuse_while_planned(const RegionFolder& region);
void remove_plan(const RegionFolder& region);
/// What a plan left that was broken off, or processes that outlived theirs. \returns  whether there was anything
bool remove_broken_plan(const RegionFolder& region);

}  // namespace blockrand::run
