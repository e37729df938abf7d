#include "pipeline/settings/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "pipeline/settings/options.h"

namespace blockrand::settings {
namespace {

/// `text` so that roff prints it as it stands: options with real hyphens, quotes that can be copied.
std::string literal(std::string_view text) {
  std::string roff;
  for (const char c : text) switch (c) {
      case '\\':
        roff += "\\e";
        break;
      case '-':
        roff += "\\-";
        break;
      case '\'':
        roff += "\\(aq";
        break;
      case '`':
        roff += "\\(ga";
        break;
      case '^':
        roff += "\\(ha";
        break;
      case '~':
        roff += "\\(ti";
        break;
      default:
        roff += c;
    }
  // A line that begins with a dot is a request.
  return roff.starts_with('.') ? "\\&" + roff : roff;
}

std::string bold(std::string_view text) { return "\\fB" + literal(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + literal(text) + "\\fR"; }

/// Sentences, each beginning a line, in short lines, as roff likes them.
std::string prose(std::string_view text) {
  std::string roff;
  while (!text.empty()) {
    std::size_t end = text.find(". ");
    while (end != std::string_view::npos && (end + 2 >= text.size() || text[end + 2] < 'A' || text[end + 2] > 'Z'))
      end = text.find(". ", end + 2);
    const bool last = end == std::string_view::npos;
    for (const std::string& line : wrapped(text.substr(0, last ? end : end + 1), 70)) roff += literal(line) + "\n";
    text.remove_prefix(last ? text.size() : end + 2);
  }
  return roff;
}

std::string section(std::string_view title) { return fmt::format(".SH {}\n", title); }

/// A paragraph that hangs below `tag`, which is roff already.
std::string hanging(const std::string& tag, const std::string& body) { return ".TP\n" + tag + "\n" + body; }

std::string paragraphs(std::string_view text) {
  std::string roff;
  for (bool first = true; !text.empty(); first = false) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    roff += (first ? "" : ".PP\n") + prose(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return roff;
}

/// "INPUT -o FOLDER [options]" with the words in capitals in italics and options in bold.
std::string usage(std::string_view text) {
  std::string roff;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    const bool option = word.starts_with('-');
    const bool variable = word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string_view::npos;
    roff += (roff.empty() ? "" : " ") + (option ? bold(word) : variable ? italic(word) : literal(word));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return roff;
}

bool of_several_commands(const base::OptionSection& section) {
  unsigned commands = 0;
  for (const Option& o : options())
    if (o.section == section) commands |= o.commands;
  return std::popcount(commands) > 1;
}

std::string option_entry(const Option& o, unsigned all_commands) {
  std::string tag;
  if (!o.letter.empty()) tag = bold("-" + std::string(o.letter)) + ", ";
  tag += o.positional() ? italic(o.name) : bold(shown_name(o));
  if (!o.positional() && !o.argument.empty()) tag += " " + italic(o.argument);
  std::string body(shown_help(o));
  body += ".";
  if (const std::string value = default_text(o); !value.empty()) body += " Default: " + value + ".";
  if (const std::string range = range_text(o); !range.empty()) body += " Range: " + range + ".";
  if (!o.key.empty()) body += fmt::format(" Key: {}{}.", o.key, on_by_default(o) ? " = false" : "");
  std::string commands;
  for (const Commands c : kAllCommands)
    if (o.commands & all_commands & c) commands += (commands.empty() ? "" : ", ") + std::string(name(c));
  if (of_several_commands(o.section)) body += " Commands: " + commands + ".";
  return hanging(tag, prose(body));
}

}  // namespace

std::string manual(const ManualText& text, std::span<const CommandText> commands) {
  unsigned known = 0;
  for (const CommandText& command : commands) known |= command.options;

  std::string roff =
      ".\\\" Printed by 'blockrand help man'; do not edit.\n"
      ".TH BLOCKRAND 1 \"\" \"blockrand " +
      text.version +
      "\" \"User Commands\"\n"
      ".ad l\n.nh\n";
  roff += section("NAME") + "blockrand \\- " + prose(text.summary);
  roff += section("SYNOPSIS");
  for (const CommandText& command : commands)
    roff += (&command == commands.data() ? "" : ".br\n") + bold("blockrand " + command.name) +
            (command.usage.empty() ? "" : " " + usage(command.usage)) + "\n";
  for (const char* option : {"--help", "--version"}) roff += ".br\n" + bold("blockrand " + std::string(option)) + "\n";
  roff += section("DESCRIPTION") + paragraphs(text.description);

  roff += section("COMMANDS");
  for (const CommandText& command : commands) {
    roff += fmt::format(".SS blockrand {}\n", literal(command.name)) + paragraphs(command.description);
    for (const Topic& topic : command.topics) {
      std::string tag = bold("blockrand " + command.name + " " + topic.name);
      for (std::size_t i = 0; i < topic.forms.size(); ++i)
        tag += (i > 0 ? " | " : topic.form_needed ? " " : " [") + bold(topic.forms[i]);
      roff += hanging(tag + (topic.forms.empty() || topic.form_needed ? "" : "]"), prose(topic.summary + "."));
    }
  }

  roff +=
      section("OPTIONS") +
      prose(
          "Every flag can be taken back with --no- before its name; a flag that is on unless you say so stands here "
          "by that name. The last of a repeated option counts. Long options also take their value after =.");
  roff += hanging(bold("-h") + ", " + bold("--help"), prose("print the help of the command."));
  roff += hanging(bold("-V") + ", " + bold("--version"), prose("print version and licence. Without a command only."));
  for (const base::OptionSection& part : sections()) {
    std::string entries;
    for (const Option& o : options())
      if (o.section == part && (o.commands & known)) entries += option_entry(o, known);
    if (!entries.empty()) roff += fmt::format(".SS {}\n", literal(part.title)) + entries;
  }

  roff +=
      section("CONFIG FILE") +
      paragraphs(
          "Options with a key can stand in a TOML file that --config names: those under \"What is built\" in its "
          "section [build], those that begin with --repair- in [repair], those that begin with --generate- in "
          "[generate]. The command line is stronger than the file. Relative paths in it start at the file's folder.\n"
          "'blockrand help options --toml' prints such a file with every key, its meaning and its default.");
  roff += section("OUTPUT") + prose("The folder that 'blockrand build' writes:");
  for (const auto& [name, meaning] : text.outputs) roff += hanging(bold(name), prose(meaning + "."));
  roff += section("FILES");
  for (const auto& [name, meaning] : text.files) roff += hanging(italic(name), prose(meaning + "."));
  roff += section("EXIT STATUS");
  for (const ExitCode& code : merged_exit_codes(commands)) roff += hanging(bold(code.code), prose(code.meaning + "."));
  roff += section("EXAMPLES");
  for (const CommandText& command : commands)
    for (const Example& example : command.examples)
      roff += hanging(bold(example.command),
                      example.meaning.empty() ? prose(command.summary + ".") : prose(example.meaning + "."));
  roff += section("COPYRIGHT") +
          prose(
              "Blockrand: GPL-3.0-or-later. Results made from OpenStreetMap data are subject to the ODbL; name their "
              "source: OpenStreetMap contributors.");
  roff += section("SEE ALSO") + "osmium(1), ogrinfo(1), xmllint(1)\n";
  return roff;
}

}  // namespace blockrand::settings
