// What a run of a region leaves behind when it has ended, however it ended: its line, its figures, words to its operator.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/base/progress.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_hook.h"
#include "pipeline/run/update_region.h"

namespace blockrand::run {

/// The line of a run in log/runs.jsonl.
nlohmann::ordered_json run_line(const UpdateSummary& summary, const base::Progress& progress);

/// Why a build was refused, in one line. Empty where no gate is exceeded.
std::string refusal(const std::vector<Gate>& gates);

/// Takes away what said how the run before ended: log/last_problem.env. To be called while the region is locked.
void begin_run(const RegionFolder& region);

/// Writes log/metrics.prom, where the run failed, was refused or left data that are too old log/last_problem.env (BLOCKRAND_STATE and
/// BLOCKRAND_REASON, for sh and as EnvironmentFile= of systemd), runs the hook, and where there is a problem `notify`. What cannot be
/// written is told and fails nothing.
/// \param line  of the run, as log/runs.jsonl has it
/// \returns  why the published data are too old; empty where they are not
std::string end_run(const UpdateOptions& options, const RegionFolder& region, RunEnd end,
                    const nlohmann::ordered_json& line, base::Progress& progress);

/// log/N.changes.json, .html and .gpkg. \throws base::OutputError
void write_changes(const RegionFolder& region, int number, const UpdateSummary& summary);

}  // namespace blockrand::run
