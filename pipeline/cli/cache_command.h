// blockrand cache: the work that builds keep for later ones.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

/// \param arguments  after the command's name
/// \returns the exit code; errors are thrown
int run_cache(const std::vector<std::string>& arguments);
settings::CommandText cache_text();

}  // namespace blockrand::cli
