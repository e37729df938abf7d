// blockrand help, --help and --version.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

std::string general_help();
std::string version_text();

/// blockrand help [COMMAND | TOPIC [FORM]]
int run_help(const std::vector<std::string>& arguments);

settings::CommandText help_text();

}  // namespace blockrand::cli
