#include "pipeline/settings/completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "pipeline/settings/options.h"

namespace blockrand::settings {
namespace {

constexpr std::string_view kHelpMeaning = "print the help of the command",
                           kVersionMeaning = "print version and licence";

using Texts = std::span<const CommandText>;

std::string joined(const std::vector<std::string>& words, std::string_view between = " ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? std::string_view() : between), text += word;
  return text;
}

std::vector<const Option*> options_of(unsigned commands, bool positional) {
  std::vector<const Option*> found;
  for (const Option& o : options())
    if ((o.commands & commands) && o.positional() == positional) found.push_back(&o);
  return found;
}

unsigned known_commands(Texts commands) {
  unsigned known = 0;
  for (const CommandText& command : commands) known |= command.options;
  return known;
}

std::vector<std::string> names_of(Texts commands) {
  std::vector<std::string> names;
  for (const CommandText& command : commands) names.push_back(command.name);
  return names;
}

/// What can stand first after a command with topics: name and meaning.
std::vector<std::pair<std::string, std::string>> first_words(const CommandText& command, Texts commands) {
  std::vector<std::pair<std::string, std::string>> words;
  if (command.takes_command)
    for (const CommandText& other : commands) words.emplace_back(other.name, other.summary);
  for (const Topic& topic : command.topics) words.emplace_back(topic.name, topic.summary);
  return words;
}

std::string replaced(std::string_view text, std::string_view what, std::string_view by) {
  std::string result;
  for (std::size_t at; (at = text.find(what)) != std::string_view::npos; text.remove_prefix(at + what.size()))
    result.append(text.substr(0, at)).append(by);
  return result.append(text);
}

/// In single quotes for bash and zsh.
std::string quoted(std::string_view text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

// ---- bash

std::string bash_value(const Option& o) {
  if (!o.choices.empty())
    return fmt::format("{} \"{}\"", o.type == OptionType::list ? "__blockrand_items" : "__blockrand_words",
                       joined(o.choices));
  if (o.type == OptionType::folder) return "__blockrand_paths -d";
  if (o.type == OptionType::path) return "__blockrand_paths -f";
  return ":";
}

std::string bash(Texts commands) {
  std::string values, with_value;
  for (const Option* o : options_of(known_commands(commands), false)) {
    if (o->argument.empty()) continue;
    const std::string names = (o->letter.empty() ? "" : "-" + std::string(o->letter) + "|") + shown_name(*o);
    with_value += (with_value.empty() ? "" : "|") + names;
    values += fmt::format("    {}) {}; return ;;\n", names, bash_value(*o));
  }
  std::string flags, positions, forms;
  for (const CommandText& command : commands) {
    std::vector<std::string> names = {"--help"};
    for (const Option* o : options_of(command.options, false)) names.push_back(shown_name(*o));
    flags += fmt::format("      {}) __blockrand_words \"{}\" ;;\n", command.name, joined(names));
    int place = 0;
    for (const Option* o : options_of(command.options, true))
      positions += fmt::format("    '{} {}') {} ;;\n", command.name, place++, bash_value(*o));
    std::vector<std::string> words;
    for (const auto& [word, meaning] : first_words(command, commands)) words.push_back(word);
    if (!words.empty())
      positions += fmt::format("    '{} 0') __blockrand_words \"{}\" ;;\n", command.name, joined(words));
    for (const Topic& topic : command.topics)
      if (!topic.forms.empty())
        forms += fmt::format("    '3 {} {}') __blockrand_words \"{}\"; return ;;\n", command.name, topic.name,
                             joined(topic.forms));
  }
  return "# Completion of blockrand for bash, printed by 'blockrand help completion bash'.\n"
         "\n"
         "__blockrand_words() { mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$cur\"); }\n"
         "\n"
         "# A list separated by commas: completes its last item.\n"
         "__blockrand_items() {\n"
         "  local before=\n"
         "  [[ $cur == *,* ]] && before=${cur%,*},\n"
         "  mapfile -t COMPREPLY < <(compgen -P \"$before\" -W \"$1\" -- \"${cur##*,}\")\n"
         "}\n"
         "\n"
         "__blockrand_paths() {\n"
         "  compopt -o filenames 2>/dev/null\n"
         "  mapfile -t COMPREPLY < <(compgen \"$1\" -- \"$cur\")\n"
         "}\n"
         "\n"
         "_blockrand() {\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} i place=0\n"
         "  COMPREPLY=()\n"
         "  # --option=value comes as three words.\n"
         "  if [[ $cur == = ]]; then\n"
         "    cur=\n"
         "  elif [[ $prev == = && COMP_CWORD -gt 2 ]]; then\n"
         "    prev=${COMP_WORDS[COMP_CWORD-2]}\n"
         "  fi\n"
         "  if (( COMP_CWORD == 1 )); then\n"
         "    __blockrand_words \"" +
         joined(names_of(commands)) +
         " --help --version\"\n"
         "    return\n"
         "  fi\n"
         "  case $prev in\n" +
         values +
         "  esac\n"
         "  case \"$COMP_CWORD ${COMP_WORDS[1]} ${COMP_WORDS[2]}\" in\n" +
         forms +
         "  esac\n"
         "  if [[ $cur == -* ]]; then\n"
         "    case ${COMP_WORDS[1]} in\n" +
         flags +
         "    esac\n"
         "    return\n"
         "  fi\n"
         "  for (( i = 2; i < COMP_CWORD; i++ )); do\n"
         "    case ${COMP_WORDS[i]} in\n"
         "      " +
         with_value +
         ")\n"
         "        [[ ${COMP_WORDS[i+1]} == = ]] && (( i++ ))\n"
         "        (( i++ )) ;;\n"
         "      -*) ;;\n"
         "      *) (( place++ )) ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"${COMP_WORDS[1]} $place\" in\n" +
         positions +
         "  esac\n"
         "}\n"
         "\n"
         "complete -F _blockrand blockrand\n";
}

// ---- zsh

/// For the description in an _arguments spec, and for names and meanings of _describe.
std::string zsh_escaped(std::string_view text) {
  std::string escaped(text);
  for (const std::string_view special : {"\\", ":", "[", "]"})
    escaped = replaced(escaped, special, "\\" + std::string(special));
  return escaped;
}

std::string zsh_value(const Option& o) {
  std::string action = " ";
  if (!o.choices.empty())
    action = o.type == OptionType::list ? fmt::format("_values -s , {} {}", o.argument, joined(o.choices))
                                        : "(" + joined(o.choices) + ")";
  else if (o.type == OptionType::folder)
    action = "_files -/";
  else if (o.type == OptionType::path)
    action = "_files";
  return fmt::format(":{}:{}", zsh_escaped(o.argument), action);
}

std::string zsh(Texts commands) {
  const auto described = [](const auto& words) {
    std::string text;
    for (const auto& [word, meaning] : words) text += "\n    " + quoted(zsh_escaped(word) + ":" + zsh_escaped(meaning));
    return text;
  };
  std::vector<std::pair<std::string, std::string>> words;
  for (const CommandText& command : commands) words.emplace_back(command.name, command.summary);
  words.emplace_back("--help", kHelpMeaning);
  words.emplace_back("--version", kVersionMeaning);
  std::string cases;
  for (const CommandText& command : commands) {
    cases += fmt::format("    {})\n", command.name);
    if (const auto first = first_words(command, commands); !first.empty()) {
      cases += "      if (( CURRENT == 2 )); then\n        words_here=(" + described(first) +
               "\n        )\n        _describe -t topics topic words_here\n";
      for (const Topic& topic : command.topics)
        if (!topic.forms.empty())
          cases += fmt::format("      elif [[ CURRENT -eq 3 && $words[2] == {} ]]; then\n        compadd -- {}\n",
                               topic.name, joined(topic.forms));
      cases += "      fi\n";
    } else {
      cases += "      _arguments \\\n        '(- *)'{-h,--help}" + quoted(fmt::format("[{}]", kHelpMeaning));
      for (const Option* o : options_of(command.options, false)) {
        const std::string meaning = fmt::format("[{}]", zsh_escaped(shown_help(*o)));
        const std::string value = o->argument.empty() ? "" : zsh_value(*o);
        const std::string equals = o->argument.empty() ? "" : "=";
        const std::string name = shown_name(*o), both = fmt::format("(-{} {})", o->letter, name);
        if (o->letter.empty()) {
          cases += " \\\n        " + quoted(name + equals + meaning + value);
        } else {
          cases += " \\\n        " + quoted(fmt::format("{}-{}", both, o->letter) + meaning + value);
          cases += " \\\n        " + quoted(both + name + equals + meaning + value);
        }
      }
      int place = 0;
      for (const Option* o : options_of(command.options, true))
        cases += " \\\n        " + quoted(fmt::format("{}{}", ++place, zsh_value(*o)));
      cases += "\n";
    }
    cases += "      ;;\n";
  }
  return "#compdef blockrand\n"
         "# Completion of blockrand for zsh, printed by 'blockrand help completion zsh'.\n"
         "\n"
         "_blockrand() {\n"
         "  local -a words_here\n"
         "  if (( CURRENT == 2 )); then\n"
         "    words_here=(" +
         described(words) +
         "\n    )\n"
         "    _describe -t commands command words_here\n"
         "    return\n"
         "  fi\n"
         "  shift words\n"
         "  (( CURRENT-- ))\n"
         "  case $words[1] in\n" +
         cases +
         "  esac\n"
         "}\n"
         "\n"
         "# As a file of $fpath this is the function's body; sourced, it registers the function.\n"
         "if [[ $funcstack[1] == _blockrand ]]; then\n"
         "  _blockrand \"$@\"\n"
         "else\n"
         "  compdef _blockrand blockrand\n"
         "fi\n";
}

// ---- fish

std::string fish_quoted(std::string_view text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

std::string fish(Texts commands) {
  std::string functions, lines;
  const auto add = [&lines](const std::string& condition, const std::string& what, std::string_view meaning) {
    lines += fmt::format("complete -c blockrand -n {} {}{}\n", fish_quoted(condition), what,
                         meaning.empty() ? "" : " -d " + fish_quoted(meaning));
  };
  for (const CommandText& command : commands) add("__blockrand_word 1", "-a " + command.name, command.summary);
  add("__blockrand_word 1", "-l version -s V", kVersionMeaning);
  lines += fmt::format("complete -c blockrand -l help -s h -d {}\n", fish_quoted(kHelpMeaning));
  for (const Option* o : options_of(known_commands(commands), false)) {
    std::string where;
    for (const CommandText& command : commands)
      if (command.options & o->commands) where += " " + command.name;
    std::string what = "-l " + shown_name(*o).substr(2);
    if (!o->letter.empty()) what += " -s " + std::string(o->letter);
    if (!o->choices.empty() && o->type == OptionType::list) {
      functions += fmt::format("function __blockrand_{}\n  printf '%s\\n' {}\nend\n\n", o->name, joined(o->choices));
      what += fmt::format(" -x -a '(__fish_complete_list , __blockrand_{})'", o->name);
    } else if (!o->choices.empty()) {
      what += " -x -a " + fish_quoted(joined(o->choices));
    } else if (o->type == OptionType::folder) {
      what += " -x -a '(__fish_complete_directories)'";
    } else if (o->type == OptionType::path) {
      what += " -r -F";
    } else if (!o->argument.empty()) {
      what += " -x";
    }
    add("__blockrand_command" + where, what, shown_help(*o));
  }
  for (const CommandText& command : commands) {
    for (const Option* o : options_of(command.options, true)) {
      if (o->type == OptionType::path) add("__blockrand_command " + command.name, "-F", "");
      if (o->type == OptionType::folder)
        add("__blockrand_command " + command.name, "-a '(__fish_complete_directories)'", "");
    }
    for (const auto& [word, meaning] : first_words(command, commands))
      add(fmt::format("__blockrand_command {}; and __blockrand_word 2", command.name), "-a " + word, meaning);
    for (const Topic& topic : command.topics)
      if (!topic.forms.empty())
        add(fmt::format("__blockrand_command {}; and __blockrand_word 3 {}", command.name, topic.name),
            "-a " + fish_quoted(joined(topic.forms)), "");
  }
  return "# Completion of blockrand for fish, printed by 'blockrand help completion fish'.\n"
         "\n"
         "# The command is one of these.\n"
         "function __blockrand_command\n"
         "  set -l words (commandline -opc)\n"
         "  test (count $words) -gt 1; and contains -- $words[2] $argv\n"
         "end\n"
         "\n"
         "# The word at the cursor has this number, and the one before it is the second argument, where that is "
         "given.\n"
         "function __blockrand_word\n"
         "  set -l words (commandline -opc)\n"
         "  test (count $words) -eq $argv[1]; or return 1\n"
         "  test (count $argv) -eq 1; or test $words[-1] = $argv[2]\n"
         "end\n"
         "\n" +
         functions + "complete -c blockrand -f\n" + lines;
}

}  // namespace

const std::vector<std::string>& completion_shells() {
  static const std::vector<std::string> shells = {"bash", "zsh", "fish"};
  return shells;
}

std::string completion(std::string_view shell, std::span<const CommandText> commands) {
  if (shell == "bash") return bash(commands);
  if (shell == "zsh") return zsh(commands);
  if (shell == "fish") return fish(commands);
  throw std::invalid_argument("no completion for this shell");
}

}  // namespace blockrand::settings
