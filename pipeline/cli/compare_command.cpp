#include "pipeline/cli/compare_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>

#include "pipeline/base/error.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/publish.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/signals.h"
#include "pipeline/compare/compare.h"
#include "pipeline/compare/comparison_report.h"
#include "pipeline/run/output_place.h"
#include "pipeline/settings/command_line.h"

namespace blockrand::cli {

namespace {

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw base::InputError(path, "", "cannot be read", "Name the compare.json of an earlier comparison");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Buildings of a model's files, those out of reach included.
std::size_t read_in(const compare::City& city) {
  std::size_t n = 0;
  for (const compare::CityFile& file : city.files) n += file.buildings;
  return n;
}

/// The options that a result depends on, as the user would write them.
compare::OptionList options_of(const settings::Settings& s) {
  compare::OptionList list;
  for (const settings::Option& o : settings::options()) {
    const bool of_comparison = o.section == compare::kCompareSection && o.record != base::OptionRecord::none;
    const bool measures = of_comparison || o.name == "crs" || o.name == "seed";
    if (!(o.commands & settings::kCompare) || !measures) continue;
    if (const std::string value = o.show(s); !value.empty()) list.emplace_back(std::string(o.name), value);
  }
  return list;
}

void write_report(const compare::Comparison& comparison, const settings::Settings& s,
                  const compare::OptionList& options, base::StagedFolder& folder, base::Progress& progress) {
  progress.begin("writing the report");
  folder.write("compare.json", compare::comparison_json(comparison, options));
  folder.write("compare.csv", compare::comparison_csv(comparison));
  compare::write_geopackage(comparison, folder.staging_path() + "/compare.gpkg");
  folder.adopt("compare.gpkg");
  folder.write("compare.html", compare::comparison_html(comparison, options, compare::distance_query(comparison),
                                                        s.comparison_report, s.build.jobs));
  progress.end();
  if (const std::string left = folder.publish(); !left.empty())
    progress.warn("the earlier comparison could not be removed and lies in " + left);
}

}  // namespace

settings::CommandText compare_text() {
  return {
      .name = "compare",
      .summary = "a model against hand-built or surveyed ones, in numbers and pictures",
      .usage = "MODEL REFERENCE... [-o FOLDER] [options]",
      .description =
          "Finds the buildings of both models that stand for each other and measures how well they agree: footprints, "
          "heights, volumes, surfaces both ways, roofs, facades with their openings, classes and validity. Reads "
          "CityGML "
          "0.4 to 2.0, CityJSON, glTF and 3D Tiles, of Blockrand and of anybody else.\n"
          "An offset between the models is estimated and reported, and taken off with --align only. Sides of the "
          "reference "
          "that show nothing (blank walls, walls against neighbours, undersides) are recognised; every measure is "
          "given "
          "without and with them.\n"
          "With --output a folder is written: compare.json, compare.csv, compare.gpkg and compare.html, a page with "
          "pictures that needs nothing else. With --baseline the measures are set against those of an earlier "
          "comparison.",
      .options = settings::kCompare,
      .examples = {{"blockrand compare out/leipzig handbuilt/*.gml -o report", ""},
                   {"blockrand compare surveyed.gml other.city.json --align horizontal",
                    "the tables only, on the terminal"},
                   {"blockrand compare out/leipzig handbuilt -o new --baseline old/compare.json --fail-if-worse 2%",
                    "a gate: exit code 3 when a measure got worse by more than 2 %"}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"3", "worse than the baseline (only with --fail-if-worse)"},
                     {"4", "output could not be written or internal error"},
                     {"128 + N", "ended by signal N"}}};
}

int run_compare(const std::vector<std::string>& arguments) {
  settings::CommandLine line = settings::read_command_line(settings::kCompare, arguments);
  if (line.help) {
    std::fputs(settings::command_help(compare_text()).c_str(), stdout);
    return kSuccess;
  }
  settings::Settings& s = line.settings;
  if (s.fail_if_worse && s.baseline.empty())
    throw base::UsageError("--fail-if-worse needs --baseline: name the compare.json of an earlier comparison.");
  clean_up_on_signals(s.log_format);
  // What can be wrong with outputs and baseline is told before the work of minutes.
  std::string baseline;
  if (!s.baseline.empty()) {
    baseline = read_file(s.baseline);
    compare::compare_with_baseline({}, baseline, s.baseline, 0);
  }
  std::optional<base::StagedFolder> folder;
  base::Progress progress(s.progress, s.log_format, s.quiet);
  if (!s.build.output.empty()) {
    std::vector<std::string> inputs = s.comparison.reference;
    inputs.insert(inputs.end(), {s.comparison.model, s.baseline});
    base::refuse_inputs_in(s.build.output, inputs);
    const auto foreign = [](const std::string& at) {
      return run::files_other_than({"compare.json", "compare.csv", "compare.gpkg", "compare.html"}, at);
    };
    folder.emplace(s.build.output, s.build.force,
                   base::FolderKind{.name = "comparison", .marker = "compare.json", .foreign = foreign});
    tell_removed(*folder, progress);
  }
  s.comparison.crs = s.build.crs;
  s.comparison.jobs = s.build.jobs;
  s.comparison.surface.seed = s.build.seed;
  const compare::Comparison comparison = compare::compare_models(s.comparison, progress);
  if (comparison.matches.empty())
    progress.warn(
        fmt::format("no building of {} stands where one of {} does: {} and {} buildings were read. Do both say the "
                    "right coordinate system? --model-crs and --reference-crs name others",
                    s.comparison.model, fmt::join(s.comparison.reference, ", "), read_in(comparison.model),
                    read_in(comparison.reference)));
  const compare::OptionList options = options_of(s);
  if (folder) write_report(comparison, s, options, *folder, progress);
  const bool json = s.json || s.log_format == base::LogFormat::json;
  if (json)
    std::fputs(compare::comparison_json(comparison, options).c_str(), stdout);
  else if (!s.quiet)
    std::fputs(compare::comparison_text(comparison).c_str(), stdout);
  if (s.baseline.empty()) return kSuccess;
  constexpr double kShownOnly = 0.02;  // without --fail-if-worse the marks in the table say what 2 % would have failed
  const compare::BaselineResult verdict =
      compare::compare_with_baseline(comparison, baseline, s.baseline, s.fail_if_worse.value_or(kShownOnly), options);
  if (!json && !s.quiet) std::fputs(compare::baseline_text(verdict).c_str(), stdout);
  if (s.fail_if_worse && verdict.worse()) {
    progress.error("worse than " + s.baseline + " (--fail-if-worse): " + compare::failed_text(verdict));
    return kBelowQuality;
  }
  return kSuccess;
}

}  // namespace blockrand::cli
