// blockrand build: an extract in, a build out.
#pragma once

#include <string>
#include <vector>

namespace blockrand::cli {

/// \param arguments  after the command's name
/// \returns the exit code; errors are thrown
int run_build(const std::vector<std::string>& arguments);

std::string build_help();

}  // namespace blockrand::cli
