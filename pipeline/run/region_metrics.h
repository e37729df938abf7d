// What a run of a region did and how the region stands: for Prometheus (docs/operations.md) and as a page of text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_options.h"

namespace blockrand::run {

/// When the data of the published build were newest, ISO 8601: the newest object of the build, or the newest change file that was
/// applied, which may have brought nothing. Empty: nobody knows, or there is no build.
std::string data_time_of(const RegionFolder& region);

/// Seconds since 1970 of "2026-11-26T03:00:00Z"; NaN where it is no such text.
double seconds_of(const std::string& time);

/// "the data of build 7 are 31 hours old (2026-11-26T03:00:00Z); max_age_hours is 26", "nobody knows how old …"; empty where they are
/// young enough, or may have any age. \param now  seconds since 1970
std::string too_old(const RegionFolder& region, const RegionOptions& options, double now);

/// Figures of a finished build, from its build.json and run.json. \param name  label "region" of all samples
std::string build_metrics(const std::string& folder, const std::string& name);

/// Those of the published build, the disk, all runs in log/runs.jsonl, and the last run.
/// \param last  the last run, as log/runs.jsonl has it
std::string region_metrics(const RegionFolder& region, const RegionOptions& options, const std::string& version,
                           const nlohmann::ordered_json& last);

/// Where the time went, the slowest tiles, the most frequent fallbacks and reports: log/N.report.txt.
/// \param build  its folder
std::string run_report(const RegionFolder& region, const std::string& build, const nlohmann::ordered_json& run);

}  // namespace blockrand::run
