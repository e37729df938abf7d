// blockrand update, status, rollback, region repair: a region that is rebuilt again and again.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

/// \param arguments  after the command's name
/// \returns the exit code; errors are thrown
int run_update(const std::vector<std::string>& arguments);
int run_status(const std::vector<std::string>& arguments);
int run_rollback(const std::vector<std::string>& arguments);
int run_region(const std::vector<std::string>& arguments);

settings::CommandText update_text();
settings::CommandText status_text();
settings::CommandText rollback_text();
settings::CommandText region_text();

}  // namespace blockrand::cli
