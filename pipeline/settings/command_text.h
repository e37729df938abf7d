// What help, manual and completion say about a command: one description for all of them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::settings {

struct Example {
  std::string command;  ///< the whole line
  std::string meaning;  ///< what it does; may be empty
};

/// A word that can stand as a command's first argument.
struct Topic {
  std::string name;
  std::string summary;
  std::vector<std::string> forms{};  ///< words that may follow it
  bool form_needed = false;          ///< one of them must
};

struct ExitCode {
  std::string code;     ///< begins with its number: "0", "128 + N"
  std::string meaning;  ///< "all well"
};

struct CommandText {
  std::string name;         ///< "build"
  std::string summary;      ///< one line of up to 70 characters, without a full stop
  std::string usage;        ///< what follows the name: "INPUT -o FOLDER [options]"
  std::string description;  ///< paragraphs, each one line, separated by '\n'
  unsigned options = 0;     ///< bit of settings::Commands; 0 where it knows no option of the table
  std::vector<Topic> topics{};
  bool takes_command = false;  ///< another command's name can be the first argument, too
  std::vector<Example> examples{};
  std::vector<ExitCode> exit_codes{};
};

/// The option part of a command's --help. Tuning options of [repair] and [generate] are left to the reference.
/// \param command  bit of settings::Commands
std::string option_help(unsigned command);

/// The whole --help of a command, at most 100 columns wide.
std::string command_help(const CommandText& command);

/// The codes of all commands in ascending order, each once. Where commands mean different things by a
/// code, each meaning names its commands.
std::vector<ExitCode> merged_exit_codes(std::span<const CommandText> commands);

/// "Exit codes: 0 all well, 1 wrong usage …", at most 100 columns wide.
std::string exit_code_help(std::span<const ExitCode> codes);

/// `text` broken at spaces into lines of at most `width` characters.
std::vector<std::string> wrapped(std::string_view text, std::size_t width);

}  // namespace blockrand::settings
