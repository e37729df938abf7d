// `blockrand compare`: a model against hand-built or surveyed ones, in numbers and pictures.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

settings::CommandText compare_text();

/// \param arguments  after the command's name
/// \returns the exit code: 0, or 3 where --fail-if-worse finds a measure worse than the baseline; errors are thrown
int run_compare(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
