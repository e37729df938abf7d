#include "pipeline/cli/validate_command.h"

#include <cstdio>

#include "pipeline/base/progress.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/path_kinds.h"
#include "pipeline/cli/spooled_input.h"
#include "pipeline/settings/command_line.h"
#include "pipeline/validate/validate_build.h"

namespace blockrand::cli {

settings::CommandText validate_text() {
  return {
      .name = "validate",
      .summary = "reads a build back and checks everything in it",
      .usage = "FOLDER [options]",
      .description =
          "Reads every file of a build and checks it against the rules of its format, against the other formats and "
          "against the map: hashes, 3D Tiles and glTF rules, property tables, CityGML and CityJSON structure, the "
          "GeoPackage, reports and explanations; every solid by two judges; the same buildings, attributes, geometry "
          "and colours in every format; and 1,000 corners against their OpenStreetMap positions, through PROJ.\n"
          "No code that wrote the build takes part. Nothing is changed.",
      .options = settings::kValidate,
      .examples = {{"blockrand validate out/leipzig", ""},
                   {"blockrand validate out/berlin --sample 10", "every tenth tile only"},
                   {"blockrand validate out/leipzig --extract leipzig.osm.pbf --json | jq .findings", ""}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "findings, or an unreadable input"},
                     {"4", "output could not be written or internal error"}}};
}

int run_validate(const std::vector<std::string>& arguments) {
  settings::CommandLine line = settings::read_command_line(settings::kValidate, arguments);
  if (line.help) {
    std::fputs(settings::command_help(validate_text()).c_str(), stdout);
    return kSuccess;
  }
  settings::Settings& s = line.settings;
  expect_build(s.folder);
  base::Progress progress(s.progress, s.log_format, s.quiet);
  validate::ValidateOptions options = s.validation;
  options.folder = s.folder;
  options.jobs = s.build.jobs;
  const std::optional<SpooledInput> piped = take_standard_input(options.extract, "", progress);
  const validate::Validation validation = with_input_told(piped, [&] { return validate::validate(options, progress); });
  const bool json = s.json || s.log_format == base::LogFormat::json;
  if (s.quiet && !json && validation.sound()) return kSuccess;
  std::fputs((json ? validation_json(options, validation) : validation_text(options, validation)).c_str(), stdout);
  return validation.sound() ? kSuccess : kInvalidInput;
}

}  // namespace blockrand::cli
