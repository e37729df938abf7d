#include "pipeline/settings/reference.h"

#include <fmt/format.h>

#include "pipeline/settings/options.h"

namespace blockrand::settings {
namespace {

std::string commands_text(unsigned commands) {
  std::string text;
  for (const Commands command : kAllCommands)
    if (commands & command) text += fmt::format("{}{}", text.empty() ? "" : ", ", name(command));
  return text;
}

}  // namespace

std::string options_markdown() {
  std::string text =
      "# Options\n"
      "\n"
      "Printed by `blockrand help options --markdown`; do not edit: a test compares this file with the program.\n"
      "\n"
      "Every option with a key can stand in a file that `--config FILE.toml` names, in the section given here; "
      "the command line is stronger than the file. Relative paths in the file start at the file's folder. "
      "`blockrand help options --toml` prints such a file with every default. "
      "Every flag can be taken back with `--no-` before its name; a flag that is on unless you say so stands here by "
      "that "
      "name, but its key is the plain one: `report = false`.\n";
  for (const base::OptionSection& section : sections()) {
    text +=
        fmt::format("\n## {}{}\n\n", section.title, in_config(section) ? fmt::format(" (`[{}]`)", section.name) : "");
    text += "| option | key | commands | default | range | meaning |\n|---|---|---|---|---|---|\n";
    for (const Option& o : options()) {
      if (o.section != section) continue;
      std::string names;
      if (o.positional()) {
        names = fmt::format("`{}`", o.name);
      } else {
        if (!o.letter.empty()) names = fmt::format("`-{}`, ", o.letter);
        names += fmt::format("`{}{}{}`", shown_name(o), o.argument.empty() ? "" : " ", o.argument);
      }
      const std::string value = default_text(o);
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", names, o.key.empty() ? "" : fmt::format("`{}`", o.key),
                          commands_text(o.commands), value.empty() ? "" : fmt::format("`{}`", value), range_text(o),
                          shown_help(o));
    }
  }
  return text;
}

}  // namespace blockrand::settings
