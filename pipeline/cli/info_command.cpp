#include "pipeline/cli/info_command.h"

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "importers/osm/read_extract.h"
#include "pipeline/base/progress.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/extract_summary.h"
#include "pipeline/georef/crs.h"
#include "pipeline/settings/command_line.h"

namespace blockrand::cli {
namespace {

constexpr std::uint64_t kScale = 1000;  // steps of the progress bar

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

settings::CommandText info_text() {
  return {.name = "info",
          .summary = "what is in an extract, and what a build of it would take",
          .usage = "INPUT [options]",
          .description =
              "Reads an OpenStreetMap extract and says what is in it: buildings and parts, how well they are tagged, "
              "streets and other objects, the extent, the coordinate system that a build would choose, and how long a "
              "build would take. Writes nothing.",
          .options = settings::kInfo,
          .examples = {{"blockrand info leipzig.osm.pbf", ""},
                       {"blockrand info berlin.osm.pbf --bbox 13.37,52.51,13.41,52.53", ""},
                       {"blockrand info leipzig.osm.pbf --json | jq .buildings.count", ""}},
          .exit_codes = {{"0", "all well"},
                         {"1", "wrong usage"},
                         {"2", "unreadable or invalid input"},
                         {"4", "output could not be written or internal error"},
                         {"128 + N", "ended by signal N"}}};
}

int run_info(const std::vector<std::string>& arguments) {
  const settings::CommandLine line = settings::read_command_line(settings::kInfo, arguments);
  if (line.help) {
    std::fputs(settings::command_help(info_text()).c_str(), stdout);
    return kSuccess;
  }
  const settings::Settings& s = line.settings;
  base::Progress progress(s.progress, s.log_format, s.quiet);
  importers::osm::ReadOptions options;
  options.bbox = s.build.bbox;
  std::string phase;
  options.progress = [&](std::string_view name, double fraction) {
    if (name != phase) {
      phase = name;
      progress.begin(name, kScale);
    }
    progress.advance_to(static_cast<std::uint64_t>(fraction * static_cast<double>(kScale)));
  };
  const auto start = std::chrono::steady_clock::now();
  const model::Extract extract = importers::osm::read_extract(s.build.input, options);
  const double read_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  progress.begin("count");
  ExtractSummary summary = summarise(extract);
  std::error_code error;
  summary.file_bytes = std::filesystem::file_size(s.build.input, error);
  if (error) summary.file_bytes = 0;  // a pipe, for example
  std::optional<CrsChoice> crs;
  if (summary.extent && summary.centre) {
    const std::string code =
        s.build.crs.empty() ? georef::choose_crs(summary.centre->lon, summary.centre->lat) : s.build.crs;
    const georef::Crs opened = georef::open_crs(code, *summary.extent);
    crs = CrsChoice{opened.authority_code, opened.name, opened.operation, opened.accuracy_m};
  }
  progress.end();
  const BuildEstimate cost = estimate(summary, s.build, read_seconds, peak_memory());
  const bool json = s.json || s.log_format == base::LogFormat::json;
  std::fputs((json ? summary_json(summary, crs, cost) : summary_text(summary, crs, cost)).c_str(), stdout);
  if (!summary.extent) progress.warn(s.build.input + ": no building with an outline");
  return kSuccess;
}

}  // namespace blockrand::cli
