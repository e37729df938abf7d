// blockrand publish: a build to where people read it.
#pragma once

#include <string>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/settings/command_text.h"
#include "pipeline/settings/options.h"

namespace blockrand::cli {

/// \param arguments  after the command's name
/// \returns the exit code; errors are thrown
int run_publish(const std::vector<std::string>& arguments);

settings::CommandText publish_text();

/// After an update: sends the published build to the places of region.toml, where it names any.
/// \returns  whether nothing is left to do; what failed is told as a warning
bool publish_after_update(const settings::Settings& settings, base::Progress& progress);

}  // namespace blockrand::cli
