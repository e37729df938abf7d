// blockrand help, --help and --version.
#pragma once

#include <string>
#include <vector>

namespace blockrand::cli {

std::string general_help();
std::string version_text();

/// blockrand help [COMMAND | options [--markdown | --toml] | codes]
int run_help(const std::vector<std::string>& arguments);

/// Names of all commands, for suggestions.
std::vector<std::string> command_names();

}  // namespace blockrand::cli
