#include "pipeline/cli/build_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "pipeline/base/error.h"
#include "pipeline/base/progress.h"
#include "pipeline/cli/build_report.h"
#include "pipeline/cli/configs_folder.h"
#include "pipeline/cli/errors.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/path_kinds.h"
#include "pipeline/cli/plan_report.h"
#include "pipeline/cli/signals.h"
#include "pipeline/cli/spooled_input.h"
#include "pipeline/run/build.h"
#include "pipeline/run/plan_build.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_metrics.h"
#include "pipeline/settings/command_line.h"

namespace blockrand::cli {

namespace {

int build(const settings::Settings& s, base::Progress& progress) {
  const run::BuildSummary summary = run::build(s.build, progress);
  progress.end();
  if (!s.metrics.empty()) run::write_whole(s.metrics, run::build_metrics(summary.folder, run::name_of(s.build)));
  if (s.log_format == base::LogFormat::json)
    std::fputs(build_report_json(s.build, summary).c_str(), stdout);
  else if (!s.quiet)
    std::fputs(build_report(s.build, summary, s.verbose).c_str(), stdout);
  if (!summary.unaccounted.empty()) {
    progress.error(unaccounted_text(s.build, summary));
    return kInternalError;
  }
  if (summary.images_misfit > 0 && s.build.strict) {
    progress.error(std::to_string(summary.images_misfit) +
                   " of the aerial images do not fit the map (--strict); imagery.json says by how much");
    return kBelowQuality;
  }
  if (summary.below_quality && s.build.strict) {
    progress.error("some buildings are below the asked quality (--strict); report.json lists them");
    return kBelowQuality;
  }
  return kSuccess;
}

/// Nothing is written.
int plan(const settings::Settings& s, base::Progress& progress) {
  const run::BuildPlan found = run::plan_build(s.build, progress);
  if (s.log_format == base::LogFormat::json)
    std::fputs(plan_report_json(s.build, found).c_str(), stdout);
  else if (!s.quiet)
    std::fputs(plan_report(s.build, found).c_str(), stdout);
  return kSuccess;
}

}  // namespace

settings::CommandText build_text() {
  return {
      .name = "build",
      .summary = "an extract in; georeferenced 3D Tiles, CityGML, CityJSON and GeoPackage out",
      .usage = "INPUT -o FOLDER [options]",
      .description =
          "Rebuilds the buildings of an OpenStreetMap extract in 3D: georeferenced 3D Tiles (GLB), CityGML, CityJSON "
          "and GeoPackage, with a report. Missing heights, storeys and roofs are inferred, and every value says where "
          "it came from.\n"
          "The output folder appears, or is replaced, when everything in it is complete; never before.\n"
          "As INPUT, - reads the extract from standard input.",
      .options = settings::kBuild,
      .examples = {{"blockrand build leipzig.osm.pbf -o out/leipzig",
                    "everything, in all formats, with facades (LoD 3)"},
                   {"blockrand build berlin.osm.pbf -o out/mitte --bbox 13.37,52.51,13.41,52.53 --formats gltf",
                    "one quarter of a city, 3D Tiles only"},
                   {"blockrand build town.osm -o out --terrain dem.tif --terrain-height-reference EPSG:7837 --force",
                    "on real ground, whose heights the raster does not explain, in place of an earlier build"},
                   {"blockrand build leipzig.osm.pbf -o out/leipzig --dry-run",
                    "what that would build and take; writes nothing"},
                   {"osmium extract -b 12.3,51.3,12.4,51.4 saxony.osm.pbf -f pbf -o - | blockrand build - -o out",
                    "what another program cuts out"},
                   {"blockrand build --config town.toml --lod 1", "options from a file; blocks instead of facades"}},
      .exit_codes = {
          {"0", "all well"},
          {"1", "wrong usage"},
          {"2", "unreadable or invalid input"},
          {"3", "buildings below the asked quality, or an aerial image that does not fit (only with --strict)"},
          {"4", "output could not be written or internal error"},
          {"128 + N", "ended by signal N"}}};
}

int run_build(const std::vector<std::string>& arguments) {
  settings::CommandLine line = settings::read_command_line(settings::kBuild, arguments);
  if (line.help) {
    std::fputs(settings::command_help(build_text()).c_str(), stdout);
    return kSuccess;
  }
  settings::Settings& s = line.settings;
  s.build.configs = configs_folder(s.build.configs, program_file());
  clean_up_on_signals(s.log_format);
  s.build.outputs.imagery = !s.build.imagery.images.empty();
  expect_extract(s.build.input);
  base::Progress progress(s.progress, s.log_format, s.quiet);
  const std::optional<SpooledInput> piped = take_standard_input(s.build.input, s.build.output, progress);
  if (piped) {
    s.build.input_told = kStandardInput;
    if (s.build.name.empty()) s.build.name = "stdin";
  }
  return with_input_told(piped, [&] { return s.dry_run ? plan(s, progress) : build(s, progress); });
}

}  // namespace blockrand::cli
