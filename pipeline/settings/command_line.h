// Options from the command line.
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
/// \throws base::UsageError  unknown options (with the nearest known one), missing or wrong values, no INPUT or what
///                          else the command needs
/// \throws base::InputError  from the config file
/// \param before  what holds where the arguments say nothing
CommandLine read_command_line(Commands command, const std::vector<std::string>& arguments, Settings before = {});

}  // namespace blockrand::settings
