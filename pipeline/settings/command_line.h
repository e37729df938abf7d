// Options from the command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipeline/settings/options.h"

namespace blockrand::settings {

struct CommandLine {
  Settings settings;
  bool help = false;  ///< -h or --help is among the arguments: nothing was checked, `settings` means nothing
  std::vector<std::string> given{};  ///< long names of the options that stand on the command line
};

/// Who reads an option of a command that does several things.
struct Reader {
  std::string_view option;
  std::vector<std::string_view> actions;
};

/// \param action   what the command is asked to do
/// \param readers  the options that not all actions read
/// \throws base::UsageError  an option on the command line that the action would not read
void refuse_unread(const CommandLine& line, Commands command, std::string_view action,
                   const std::vector<Reader>& readers);

/// Reads the arguments of a command (without program and command), and the config file that --config names first.
/// \throws base::UsageError  unknown options (with the nearest known one), missing or wrong values, no INPUT or what
///                          else the command needs
/// \throws base::InputError  from the config file
/// \param before  what holds where the arguments say nothing
CommandLine read_command_line(Commands command, const std::vector<std::string>& arguments, Settings before = {});

}  // namespace blockrand::settings
