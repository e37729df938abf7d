#include "pipeline/settings/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "pipeline/base/error.h"
#include "pipeline/base/toml_file.h"
#include "pipeline/settings/config_file.h"

namespace blockrand::settings {
namespace {

std::string shown(const Option& option) {
  return option.positional() ? std::string(option.name) : "--" + std::string(option.name);
}

[[noreturn]] void wrong_usage(const std::string& what, Commands command) {
  throw base::UsageError(fmt::format("{} Try 'blockrand {} --help'.", what, name(command)));
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
  for (const Option& o : options()) {
    if (o.positional() || !given.starts_with("--") || (word != o.name && word != "no-" + std::string(o.name))) continue;
    std::string whose;
    for (const Commands c : kAllCommands)
      if (o.commands & c) whose += fmt::format("{}{}", whose.empty() ? "" : ", ", name(c));
    wrong_usage(fmt::format("--{} is an option of {}, which {} does not read.", word, whose, name(command)), command);
  }
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

}  // namespace

void refuse_unread(const CommandLine& line, Commands command, std::string_view action,
                   const std::vector<Reader>& readers) {
  for (const Reader& reader : readers) {
    if (std::ranges::find(line.given, reader.option) == line.given.end() ||
        std::ranges::find(reader.actions, action) != reader.actions.end())
      continue;
    std::string who;
    for (const std::string_view a : reader.actions)
      who += fmt::format("{}{} {}", who.empty() ? "" : " and ", name(command), a);
    wrong_usage(fmt::format("--{} is read by {}, not by {} {}.", reader.option, who, name(command), action), command);
  }
}

CommandLine read_command_line(Commands command, const std::vector<std::string>& arguments, Settings before) {
  CommandLine line;
  line.settings = std::move(before);
  CLI::App app;
  app.set_help_flag("-h,--help");
  app.allow_extras();
  std::vector<std::pair<const Option*, CLI::Option*>> parsed;
  for (const Option& o : options()) {
    if (!(o.commands & command)) continue;
    CLI::Option* option = nullptr;
    if (o.positional()) {
      option = app.add_option(std::string(o.name));
      if (o.several) option->expected(1, CLI::detail::expected_max_vector_size);
    } else {
      std::string names = o.letter.empty() ? "" : "-" + std::string(o.letter) + ",";
      names += "--" + std::string(o.name);
      // Every flag can be taken back, for what a config file sets.
      option =
          o.type == OptionType::flag ? app.add_flag(names + ",!--no-" + std::string(o.name)) : app.add_option(names);
      option->multi_option_policy(o.several ? CLI::MultiOptionPolicy::TakeAll : CLI::MultiOptionPolicy::TakeLast);
    }
    // Else "[a,b]" would be split, in file names too.
    option->allow_extra_args(o.several && o.positional());
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
  std::string taken;
  for (const auto& [o, option] : parsed)
    if (o->positional() && option->count() > 0)
      taken += fmt::format("{}{} is {}", taken.empty() ? "" : ", ", o->name, option->results().front());
  for (const std::string& extra : app.remaining()) {
    if (extra == "--") continue;
    if (extra.size() > 1 && extra.starts_with('-')) unknown_option(extra, command);
    wrong_usage(fmt::format("unexpected argument {}{}.", extra, taken.empty() ? "" : ": " + taken + " already"),
                command);
  }
  for (const auto& [o, option] : parsed)
    if (!o->positional() && option->count() > 0) line.given.emplace_back(o->name);
  // The file first, so that the command line is stronger.
  for (const auto& [o, option] : parsed) {
    if (o->name != "config" || option->count() == 0) continue;
    line.settings.config = option->results().back();
    read_config(line.settings.config, line.settings);
  }
  for (const auto& [o, option] : parsed)
    if (o->several) {
      for (const std::string& value : option->results()) set(*o, line.settings, value);
    } else if (option->count() > 0) {
      set(*o, line.settings, option->results().back());
    }
  for (const auto& [o, option] : parsed)
    if (!o->if_missing.empty() && !(o->optional_for & command) && o->show(line.settings).empty())
      wrong_usage(std::string(o->if_missing), command);
  return line;
}

}  // namespace blockrand::settings
