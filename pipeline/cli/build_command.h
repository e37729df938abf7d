// blockrand build: an extract in, a build out.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

/// \param arguments  after the command's name
/// \returns the exit code; errors are thrown
int run_build(const std::vector<std::string>& arguments);

settings::CommandText build_text();

}  // namespace blockrand::cli
