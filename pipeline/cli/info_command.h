// blockrand info: what is in an extract, and what a build of it would take.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

/// \param arguments  after the command's name
/// \returns the exit code; errors are thrown
int run_info(const std::vector<std::string>& arguments);

settings::CommandText info_text();

}  // namespace blockrand::cli
