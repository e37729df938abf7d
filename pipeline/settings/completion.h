// Completion scripts for shells, from the tables that make --help.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::settings {

/// Names of the shells that a script can be made for.
const std::vector<std::string>& completion_shells();

/// The script that completes commands, topics, options, their fixed values, files and folders. Needs nothing but the
/// shell itself (bash 4.4, zsh 5, fish 3). The same bytes each time.
/// \param shell  one of completion_shells()
std::string completion(std::string_view shell, std::span<const CommandText> commands);

}  // namespace blockrand::settings
