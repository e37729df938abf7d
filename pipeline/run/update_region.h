// The nightly job: new data into a region, a build of it, gates, and the switch to the new build.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/run/build.h"
#include "pipeline/run/build_changes.h"
#include "pipeline/run/region_options.h"
#include "pipeline/run/region_shards.h"

namespace blockrand::run {

/// A build against hand-built models.
struct ReferenceVerdict {
  std::string json;                ///< compare.json
  std::vector<std::string> worse;  ///< measures that are worse than the baseline allows, buildings that are lost
};

struct UpdateOptions {
  std::string folder;               ///< of the region
  std::vector<std::string> inputs;  ///< an extract first, or none; change files
  BuildOptions build;               ///< from region.toml; input, output and name are the region's
  RegionOptions region;
  bool dry_run = false;         ///< tell what would be done
  bool break_lock = false;      ///< take over the lock of another host
  std::string version;          ///< of the program
  std::string settings_sha256;  ///< of region.toml as it was read
  /// Compares a build with RegionOptions::reference. \param baseline  compare.json of another build, or empty
  std::function<ReferenceVerdict(const std::string& build, const std::string& baseline)> compare_with_reference;
};

enum class UpdateState {
  published,  ///< a new build stands
  unchanged,  ///< nothing to build: data, settings and program are those of the published build
  refused,    ///< built, but a gate is exceeded: not published
  planned,    ///< dry run
  shared      ///< planned: shards are to be worked on by others, then finished
};

struct UpdateSummary {
  UpdateState state = UpdateState::unchanged;
  int number = 0;                ///< of the run; of the published build where nothing changed
  std::optional<int> before;     ///< the build that was published
  std::string folder;            ///< where the new build lies
  std::vector<std::string> why;  ///< for what a build is made, in words
  std::uint64_t created = 0, modified = 0, deleted = 0, known = 0;  ///< OSM objects, by change files
  std::uint64_t outside = 0;                                        ///< of these files, beyond the region's polygon
  std::optional<std::uint64_t> sequence;                            ///< of the newest change file
  BuildChanges changes;
  std::vector<Gate> gates;
  std::uint64_t tiles_built = 0, tiles_kept = 0;         ///< worked on; taken from earlier runs
  std::map<std::string, std::uint64_t> tiles_built_for;  ///< BuildSummary::tiles_built_for
  std::uint64_t areas = 0, areas_kept = 0;               ///< of a region in areas: all, and those that stay as they are
  std::uint64_t linked = 0, linked_bytes = 0;            ///< files that are those of the build before
  std::uint64_t planned_areas = 0;                       ///< that shards are to build
  std::vector<TileTime> slowest_tiles;                   ///< BuildSummary::slowest_tiles
  std::uint64_t peak_rss_bytes = 0;                      ///< of the build and its processes; 0: nothing was built
  std::string too_old;          ///< why the published data are (max_age_hours); empty: they are not
  double expected_seconds = 0;  ///< that the run should take: of a dry run; 0: unknown
  double seconds = 0;
};

/// Builds and publishes, or leaves what is published as it is.
/// \throws base::UsageError   no data yet and no extract given; the region is locked
/// \throws base::InputError   unreadable data, a gap in the change files, damaged store
/// \throws base::OutputError  the disk is full or cannot be written
UpdateSummary update_region(const UpdateOptions& options, base::Progress& progress);

/// The same in three steps, of which any number of processes on hosts that share the region's disk do the middle one: what is built
/// is the same, byte by byte. `plan_region` prepares the data and gives each area to a shard; with nothing to build it ends as
/// `update_region` does. `finish_region` gates and publishes.
/// \throws base::UsageError  a plan is under way already (plan), there is none, settings or program are others than its own, or areas
///                           are missing (finish): says which shards
/// \throws as update_region
UpdateSummary plan_region(const UpdateOptions& options, int shards, base::Progress& progress);
SharedWork work_on_region(const UpdateOptions& options, const Shard& shard, base::Progress& progress);
UpdateSummary finish_region(const UpdateOptions& options, base::Progress& progress);
/// Gives a plan up, with what was built for it. What is published stays. \returns  its run
int drop_region_plan(const std::string& folder, bool break_lock, base::Progress& progress);

/// What `blockrand region repair` finds, after it has removed damaged work.
struct RegionHealth {
  bool published = true;   ///< a build is
  bool data_whole = true;  ///< its data are
  std::string words;       ///< a line each
};
/// \throws base::UsageError  no region; another run works on it
RegionHealth check_region(const std::string& folder, bool break_lock, base::Progress& progress);

/// What `blockrand status` tells.
struct RegionStatus {
  std::optional<PlanStatus> plan;  ///< that is under way
  std::optional<int> current;
  std::vector<int> published;
  std::string data_time;
  std::string too_old;  ///< why these data are too old (RegionOptions::max_age_hours); empty: they are not
  std::optional<std::uint64_t> sequence;
  std::uint64_t models = 0;
  double seconds = 0;                ///< that the build took
  std::string last_run;              ///< the newest line of log/runs.jsonl
  std::vector<std::string> waiting;  ///< change files that the next run will take
  std::string waiting_problem;       ///< why they cannot be taken
};
RegionStatus region_status(const std::string& folder, const RegionOptions& options);

/// Publishes an earlier build again. \param to  its number; nothing: the one before the current one
/// \returns  its number \throws base::UsageError  there is none
int roll_back(const std::string& folder, std::optional<int> to, bool break_lock, base::Progress& progress);

}  // namespace blockrand::run
