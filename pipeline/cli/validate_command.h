// `blockrand validate`: everything that a build wrote is read back and checked.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

settings::CommandText validate_text();

/// \param arguments  after the command's name
/// \returns the exit code: 0 sound, 2 findings; errors are thrown
int run_validate(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
