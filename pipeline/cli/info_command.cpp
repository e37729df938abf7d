#include "pipeline/cli/info_command.h"

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "importers/osm/read_extract.h"
#include "pipeline/base/progress.h"
#include "pipeline/cli/configs_folder.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/extract_summary.h"
#include "pipeline/cli/path_kinds.h"
#include "pipeline/cli/spooled_input.h"
#include "pipeline/georef/crs.h"
#include "pipeline/run/sample_walls.h"
#include "pipeline/settings/command_line.h"

namespace blockrand::cli {
namespace {

constexpr std::uint64_t kScale = 1000;  // steps of the progress bar

int info(const settings::Settings& s, base::Progress& progress) {
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
  model::Extract extract = importers::osm::read_extract(s.build.input, options);
  if (!s.build.input_told.empty()) extract.file = s.build.input_told;
  const double read_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  progress.begin("count");
  std::vector<footprints::Shard> shards;
  ExtractSummary summary = summarise(extract, &shards);
  std::error_code error;
  summary.file_bytes = std::filesystem::file_size(s.build.input, error);
  if (error) summary.file_bytes = 0;
  std::optional<CrsChoice> crs;
  if (summary.extent && summary.centre) {
    const std::string code =
        s.build.crs.empty() ? georef::choose_crs(summary.centre->lon, summary.centre->lat) : s.build.crs;
    const georef::Crs opened = georef::open_crs(code, *summary.extent);
    crs = CrsChoice{opened.authority_code, opened.name, opened.operation, opened.accuracy_m};
  }
  if (s.build.lod >= 3) progress.begin("measure facades");
  const std::uint64_t store_bytes = run::peak_memory();
  run::BuildOptions build = s.build;
  if (build.lod >= 3) build.configs = configs_folder(build.configs, program_file());
  const std::optional<double> per_wall = run::sample_walls(extract, shards, summary.size, build, read_seconds);
  progress.end();
  const BuildEstimate cost = run::estimate(summary.size, s.build, read_seconds, store_bytes, per_wall);
  const bool json = s.json || s.log_format == base::LogFormat::json;
  std::fputs((json ? summary_json(summary, crs, cost) : summary_text(summary, crs, cost)).c_str(), stdout);
  if (!summary.extent) progress.warn(run::told_input(s.build) + ": no building with an outline");
  return kSuccess;
}

}  // namespace

settings::CommandText info_text() {
  return {
      .name = "info",
      .summary = "what is in an extract, and what a build of it would take",
      .usage = "INPUT [options]",
      .description =
          "Reads an OpenStreetMap extract and says what is in it: buildings and parts, how well they are tagged, "
          "streets and other objects, the extent, the coordinate system that a build would choose, and what time, "
          "memory and disk a build would take. Of facades it builds up to three tiles, which are not written, since "
          "they "
          "differ much between towns. Writes nothing.\n"
          "The options on level of detail, formats and jobs are those of build: they say of which build the cost is "
          "told.",
      .options = settings::kInfo,
      .examples = {{"blockrand info leipzig.osm.pbf", ""},
                   {"blockrand info berlin.osm.pbf --bbox 13.37,52.51,13.41,52.53", ""},
                   {"blockrand info leipzig.osm.pbf --lod 2 --formats citygml --gzip", "what that build would cost"},
                   {"blockrand info leipzig.osm.pbf --json | jq .buildings.count", ""}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"4", "output could not be written or internal error"},
                     {"128 + N", "ended by signal N"}}};
}

int run_info(const std::vector<std::string>& arguments) {
  settings::CommandLine line = settings::read_command_line(settings::kInfo, arguments);
  if (line.help) {
    std::fputs(settings::command_help(info_text()).c_str(), stdout);
    return kSuccess;
  }
  settings::Settings& s = line.settings;
  if (!s.build.crs.empty()) georef::check_crs(s.build.crs);
  expect_extract(s.build.input);
  base::Progress progress(s.progress, s.log_format, s.quiet);
  const std::optional<SpooledInput> piped = take_standard_input(s.build.input, "", progress);
  if (piped) s.build.input_told = kStandardInput;
  return with_input_told(piped, [&] { return info(s, progress); });
}

}  // namespace blockrand::cli
