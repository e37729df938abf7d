// A command of the program: what it is called, what help and manual say about it, what it does.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

struct Command {
  settings::CommandText text;
  /// \param arguments  after the command's name
  /// \returns the exit code; errors are thrown
  int (*run)(const std::vector<std::string>& arguments) = nullptr;
};

/// The one list of commands, in the order of help, manual and completion.
const std::vector<Command>& commands();

/// \returns nullptr where there is no such command
const Command* find_command(const std::string& name);

/// What help, manual and completion need of the commands.
const std::vector<settings::CommandText>& command_texts();

}  // namespace blockrand::cli
