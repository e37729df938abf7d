// What an operator asks of a region beside its runs: how it stands, whether it is whole, back to an earlier build.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_metrics.h"
#include "pipeline/run/region_plan.h"
#include "pipeline/run/region_state.h"
#include "pipeline/run/replication.h"
#include "pipeline/run/update_region.h"
#include "pipeline/run/work_cache.h"

namespace blockrand::run {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

RegionHealth check_region(const std::string& folder, bool break_lock, base::Progress& progress) {
  const RegionFolder region(folder);
  if (!region.exists())
    throw base::UsageError(folder + " is no region. 'blockrand update " + folder + " EXTRACT.osm.pbf' makes one.");
  const RegionLock lock(region, break_lock, progress);
  refuse_while_planned(region);  // its workers use the kept work
  RegionHealth health;
  std::error_code error;
  progress.begin("check work");
  if (fs::exists(region.cache() + "/program", error)) {
    const CacheFigures work = verify_cache(region.cache(), progress);
    health.words += fmt::format("kept work: {} pieces are whole, {} were damaged and are removed\n",
                                base::with_thousands(work.entries), base::with_thousands(work.removed));
  }
  progress.begin("check data");
  const std::optional<int> current = region.current();
  if (!current) {
    health.published = false, health.words += "no build is published\n";
    return health;
  }
  const std::string data = region.data(*current);
  health.data_whole =
      fs::is_regular_file(data, error) && base::sha256_file(data) == DataState::read(region.state(*current)).sha256;
  health.words += fmt::format("data of build {}: {}\n", *current, health.data_whole ? "whole" : "damaged");
  return health;
}

RegionStatus region_status(const std::string& folder, const RegionOptions& options) {
  const RegionFolder region(folder);
  if (!region.exists())
    throw base::UsageError(folder + " is no region. 'blockrand update " + folder + " EXTRACT.osm.pbf' makes one.");
  RegionStatus status;
  status.current = region.current(), status.published = region.passed();
  DataState state;
  if (status.current) {
    const Json record = read_json(region.build(*status.current) + "/build.json"),
               run = read_json(region.build(*status.current) + "/run.json");
    status.data_time = data_time_of(region);
    if (record.contains("counts")) status.models = record["counts"].value("models", std::uint64_t{0});
    if (run.contains("seconds") && run["seconds"].is_number()) status.seconds = run["seconds"].get<double>();
    state = DataState::read(region.state(*status.current));
    status.sequence = state.sequence;
  }
  status.plan = plan_status(region);
  status.too_old = too_old(region, options, static_cast<double>(std::time(nullptr)));
  std::ifstream runs(folder + "/log/runs.jsonl", std::ios::binary);
  for (std::string line; std::getline(runs, line);)
    if (!line.empty()) status.last_run = line;
  if (!options.replication.empty() && status.current) try {
      for (const ReplicationFile& file :
           replication_files(options.replication, next_sequence(options, state.sequence, region)))
        status.waiting.push_back(file.path);
    } catch (const base::InputError& error) {
      status.waiting_problem = error.what();
    }
  return status;
}

int roll_back(const std::string& folder, std::optional<int> to, bool break_lock, base::Progress& progress) {
  const RegionFolder region(folder);
  if (!region.exists()) throw base::UsageError(folder + " is no region.");
  const RegionLock lock(region, break_lock, progress);
  const std::vector<int> builds = region.passed();
  // A `current` that leads nowhere is a reason to go back, not an obstacle.
  std::optional<int> now;
  try {
    now = region.current();
  } catch (const base::InputError&) {
  }
  const auto is_there = [&](int number) { return std::ranges::find(builds, number) != builds.end(); };
  if (!to && now) {
    const std::optional<int> replaced = DataState::read(region.state(*now)).replaced;
    if (replaced && is_there(*replaced)) to = replaced;
  }
  if (!to) {
    for (const int number : builds)
      if (!now || number < *now) to = number;
    if (!to) throw base::UsageError(folder + " has no earlier build to go back to.");
  }
  if (!is_there(*to)) {
    std::string known;
    for (const int number : builds) known += (known.empty() ? "" : ", ") + std::to_string(number);
    throw base::UsageError(fmt::format("{} has no build {}. It has {}.", folder, *to, known.empty() ? "none" : known));
  }
  region.publish(*to);
  append_run(region, {{"run", *to}, {"ended", now_utc()}, {"state", "rolled back"}}, progress);
  return *to;
}

}  // namespace blockrand::run
