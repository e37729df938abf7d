#include "pipeline/settings/command_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "pipeline/settings/options.h"

namespace blockrand::settings {
namespace {

constexpr std::size_t kHelpColumn = 28, kHelpWidth = 100;

/// Those whose options a command's --help lists: its own first.
std::vector<base::OptionSection> sections_of_help(unsigned command) {
  std::vector<base::OptionSection> listed = sections();
  std::erase_if(listed, [](const base::OptionSection& section) { return section.tuning; });
  std::ranges::stable_partition(
      listed, [&](const base::OptionSection& section) { return section.name == name(static_cast<Commands>(command)); });
  return listed;
}

/// "  NAMES   meaning", the meaning broken at its own column.
std::string row(const std::string& names, const std::string& meaning) {
  std::string text = names.size() + 2 > kHelpColumn ? names + "\n" + std::string(kHelpColumn, ' ')
                                                    : names + std::string(kHelpColumn - names.size(), ' ');
  const std::vector<std::string> lines = wrapped(meaning, kHelpWidth - kHelpColumn);
  for (std::size_t i = 0; i < lines.size(); ++i)
    text += (i == 0 ? "" : std::string(kHelpColumn, ' ')) + lines[i] + "\n";
  return text;
}

std::string paragraph(std::string_view text) {
  std::string lines;
  for (const std::string& line : wrapped(text, kHelpWidth)) lines += line + "\n";
  return lines;
}

}  // namespace

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

std::string option_help(unsigned command) {
  std::string text;
  for (const base::OptionSection& section : sections_of_help(command)) {
    std::string rows;
    for (const Option& o : options()) {
      if (o.section != section || !(o.commands & command)) continue;
      std::string names = "  ";
      if (!o.positional()) names += o.letter.empty() ? "    " : "-" + std::string(o.letter) + ", ";
      names += shown_name(o);
      if (!o.positional() && !o.argument.empty()) names += " " + std::string(o.argument);
      std::string help(shown_help(o, command));
      const std::string fallback = default_text(o);
      if (!fallback.empty()) help += " [" + fallback + "]";
      rows += row(names, help);
    }
    std::string_view heading = section.title;
    if (section == base::kMainSection && command != kBuild) heading = command == kCompare ? "Output" : "Arguments";
    if (!rows.empty()) text += fmt::format("\n{}:\n{}", heading, rows);
  }
  return text;
}

std::string command_help(const CommandText& command) {
  std::string text =
      fmt::format("Usage: blockrand {}{}{}\n", command.name, command.usage.empty() ? "" : " ", command.usage);
  for (std::size_t start = 0; start < command.description.size();) {
    const std::size_t end = std::min(command.description.find('\n', start), command.description.size());
    text += "\n" + paragraph(std::string_view(command.description).substr(start, end - start));
    start = end + 1;
  }
  if (!command.topics.empty()) text += "\nTopics:\n";
  if (command.takes_command) text += row("  COMMAND", "the same as blockrand COMMAND --help");
  for (const Topic& topic : command.topics) {
    std::string name = "  " + topic.name, forms;
    for (const std::string& form : topic.forms) forms += (forms.empty() ? "" : "|") + form;
    if (!forms.empty()) name += topic.form_needed ? " " + forms : " [" + forms + "]";
    text += row(name, topic.summary);
  }
  if (command.options != 0) text += option_help(command.options);
  if (std::ranges::any_of(options(),
                          [&](const Option& o) { return o.section.tuning && (o.commands & command.options); }))
    text += "\nOptions that tune repair and inference: blockrand help options\n";
  if (!command.examples.empty()) text += "\nExamples:\n";
  for (const Example& example : command.examples) {
    text += "  " + example.command + "\n";
    if (!example.meaning.empty())
      for (const std::string& line : wrapped(example.meaning, kHelpWidth - 6)) text += "      " + line + "\n";
  }
  return text + "\n" + exit_code_help(command.exit_codes);
}

std::vector<ExitCode> merged_exit_codes(std::span<const CommandText> commands) {
  struct Meaning {
    std::string text, commands;
  };
  std::vector<std::pair<std::string, std::vector<Meaning>>> merged;
  for (const CommandText& command : commands)
    for (const ExitCode& code : command.exit_codes) {
      auto entry = std::ranges::find(merged, code.code, [](const auto& m) { return m.first; });
      if (entry == merged.end()) entry = merged.insert(merged.end(), {code.code, {}});
      auto meaning = std::ranges::find(entry->second, code.meaning, &Meaning::text);
      if (meaning == entry->second.end()) meaning = entry->second.insert(meaning, {code.meaning, ""});
      meaning->commands += (meaning->commands.empty() ? "" : ", ") + command.name;
    }
  std::ranges::stable_sort(merged, {}, [](const auto& m) { return std::stoi(m.first); });
  std::vector<ExitCode> codes;
  for (const auto& [code, meanings] : merged) {
    std::string text;
    for (const Meaning& m : meanings)
      text += meanings.size() == 1 ? m.text : fmt::format("{}{}: {}", text.empty() ? "" : "; ", m.commands, m.text);
    codes.push_back({code, text});
  }
  return codes;
}

std::string exit_code_help(std::span<const ExitCode> codes) {
  std::string text = "Exit codes: ";
  for (std::size_t i = 0; i < codes.size(); ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", codes[i].code, codes[i].meaning);
  return paragraph(text + ".");
}

}  // namespace blockrand::settings
