#include "pipeline/run/before_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "pipeline/attributes/overrides.h"
#include "pipeline/base/error.h"
#include "pipeline/base/publish.h"
#include "pipeline/context/height_reference.h"

namespace blockrand::run {

const std::string& checked_output(const BuildOptions& options) {
  std::vector<std::string> inputs = {options.input,  options.terrain, options.overrides,
                                     options.pinned, options.configs, options.districts};
  for (const importers::imagery::ImageSource& image : options.imagery.images) inputs.push_back(image.path);
  base::refuse_inputs_in(options.output, inputs);
  if (!options.cache.empty()) {
    std::error_code error;
    const std::string out = std::filesystem::weakly_canonical(options.output, error).string() + "/",
                      cache = std::filesystem::weakly_canonical(options.cache, error).string() + "/";
    if (cache.starts_with(out))
      throw base::UsageError("--cache " + options.cache +
                             " lies in the output folder, which is replaced: name another one");
  }
  return options.output;
}

void warn_of_unread(const BuildOptions& options, base::Progress& progress) {
  for (const std::string& warning : outputs::unread_options(options.outputs, options.lod)) progress.warn(warning);
}

void warn_of_heights(const BuildOptions& options, const BuildInputs& inputs, const georef::LonLat& centre,
                     base::Progress& progress) {
  if (!inputs.terrain && !options.ground_height) progress.warn(context::ground_warning(centre));
  for (const std::string& warning : inputs.heights.warnings) progress.warn(warning);
}

model::Report override_extract(const BuildOptions& options, BuildInputs& inputs, model::Extract& extract,
                               base::Progress& progress) {
  model::Report report;
  attributes::apply_overrides(inputs.overrides, extract, report);
  if (options.lod < 2 &&
      std::ranges::any_of(inputs.overrides.entries, [](const auto& e) { return e.model.has_value(); }))
    progress.warn(options.overrides + ": models replace their buildings from --lod 2 on; nothing reads them here");
  if (inputs.tile) report.rows.clear();
  if (!report.rows.empty())
    progress.warn(fmt::format(
        "{}: {} of {} entries match nothing in the extract, the first in {}; report.json lists them", options.overrides,
        report.rows.size(), inputs.overrides.entries.size(), report.rows.front().detail));
  return report;
}

}  // namespace blockrand::run
