#include "pipeline/settings/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/settings/config_file.h"

namespace blockrand::settings {
namespace {

constexpr std::size_t kHelpColumn = 28, kHelpWidth = 100;

std::string shown(const Option& option) {
  return option.positional() ? std::string(option.name) : "--" + std::string(option.name);
}

[[noreturn]] void wrong_usage(const std::string& what, Commands command) {
  throw base::UsageError(fmt::format("{} Try 'blockrand {} --help'.", what, command == kBuild ? "build" : "info"));
}

[[noreturn]] void unknown_option(const std::string& given, Commands command) {
  std::vector<std::string> known = {"help"};
  for (const Option& o : options()) {
    if (!(o.commands & command) || o.positional()) continue;
    known.emplace_back(o.name);
    if (o.type == OptionType::flag) known.push_back("no-" + std::string(o.name));
  }
  std::string word = given.substr(given.find_first_not_of('-') == std::string::npos ? 0 : given.find_first_not_of('-'));
  word = word.substr(0, word.find('='));
  const std::string near = given.starts_with("--") ? base::nearest(word, known) : "";
  wrong_usage(fmt::format("unknown option {}.{}", given.substr(0, given.find('=')),
                          near.empty() ? "" : " Did you mean --" + near + "?"),
              command);
}

void set(const Option& option, Settings& settings, const std::string& value) {
  try {
    option.set(settings, value);
  } catch (const ValueError& error) {
    throw base::UsageError(shown(option) + ": " + error.what() + ". " + error.remedy);
  }
}

/// Breaks `text` at spaces into lines of at most `width` characters.
std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  while (text.size() > width) {
    std::size_t end = text.rfind(' ', width);
    if (end == std::string_view::npos) end = width;
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(text.size(), end + 1));
  }
  lines.emplace_back(text);
  return lines;
}

}  // namespace

CommandLine read_command_line(Commands command, const std::vector<std::string>& arguments) {
  CommandLine line;
  CLI::App app;
  app.set_help_flag("-h,--help");
  app.allow_extras();
  std::vector<std::pair<const Option*, CLI::Option*>> parsed;
  for (const Option& o : options()) {
    if (!(o.commands & command)) continue;
    CLI::Option* option = nullptr;
    if (o.positional()) {
      option = app.add_option(std::string(o.name));
    } else {
      std::string names = o.letter.empty() ? "" : "-" + std::string(o.letter) + ",";
      names += "--" + std::string(o.name);
      // Every flag can be taken back, for what a config file sets.
      option =
          o.type == OptionType::flag ? app.add_flag(names + ",!--no-" + std::string(o.name)) : app.add_option(names);
      option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    }
    // Else "[a,b]" would be split, in file names too.
    option->allow_extra_args(false);
    parsed.emplace_back(&o, option);
  }
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(reversed);
  } catch (const CLI::CallForHelp&) {
    line.help = true;
    return line;
  } catch (const CLI::ParseError& error) {
    wrong_usage(std::string(error.what()) + ".", command);
  }
  std::string input;
  for (const auto& [o, option] : parsed)
    if (o->positional() && option->count() > 0) input = option->results().front();
  for (const std::string& extra : app.remaining()) {
    if (extra == "--") continue;
    if (extra.size() > 1 && extra.starts_with('-')) unknown_option(extra, command);
    wrong_usage(fmt::format("unexpected argument {}: one input at a time{}.", extra,
                            input.empty() ? "" : " (it is " + input + ")"),
                command);
  }
  // The file first, so that the command line is stronger.
  for (const auto& [o, option] : parsed) {
    if (o->name != "config" || option->count() == 0) continue;
    line.settings.config = option->results().back();
    read_config(line.settings.config, line.settings);
  }
  for (const auto& [o, option] : parsed)
    if (option->count() > 0) set(*o, line.settings, option->results().back());
  if (line.settings.build.input.empty()) wrong_usage("no INPUT is given: name an OSM extract.", command);
  if (command == kBuild && line.settings.build.output.empty())
    wrong_usage("no output folder is given: name one with --output FOLDER.", command);
  return line;
}

std::string option_help(Commands command) {
  std::string text;
  for (const Section section : {Section::build, Section::messages}) {
    std::string rows;
    for (const Option& o : options()) {
      if (o.section != section || !(o.commands & command)) continue;
      std::string names = "  ";
      if (o.positional()) {
        names += std::string(o.name);
      } else {
        names += o.letter.empty() ? "    " : "-" + std::string(o.letter) + ", ";
        names += "--" + std::string(o.name);
        if (!o.argument.empty()) names += " " + std::string(o.argument);
      }
      std::string help(o.help);
      const std::string fallback = default_text(o);
      if (o.type != OptionType::flag && !fallback.empty()) help += " [" + fallback + "]";
      const std::vector<std::string> lines = wrapped(help, kHelpWidth - kHelpColumn);
      rows += names.size() + 2 > kHelpColumn ? names + "\n" + std::string(kHelpColumn, ' ')
                                             : names + std::string(kHelpColumn - names.size(), ' ');
      for (std::size_t i = 0; i < lines.size(); ++i)
        rows += (i == 0 ? "" : std::string(kHelpColumn, ' ')) + lines[i] + "\n";
    }
    if (!rows.empty()) text += fmt::format("\n{}:\n{}", title(section), rows);
  }
  return text;
}

}  // namespace blockrand::settings
