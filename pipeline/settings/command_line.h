// Options from the command line, and what --help says about them.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/options.h"

namespace blockrand::settings {

struct CommandLine {
  Settings settings;
  bool help = false;  ///< -h or --help is among the arguments: nothing was checked, `settings` means nothing
};

/// Reads the arguments of a command (without program and command), and the config file that --config names first.
/// \throws base::UsageError  unknown options (with the nearest known one), missing or wrong values, no INPUT
/// \throws base::InputError  from the config file
CommandLine read_command_line(Commands command, const std::vector<std::string>& arguments);

/// The option part of a command's --help. Tuning options of [repair] and [generate] are left to the reference.
std::string option_help(Commands command);

}  // namespace blockrand::settings
