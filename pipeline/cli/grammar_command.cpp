#include "pipeline/cli/grammar_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "importers/facade_rules/read_facade_rules.h"
#include "pipeline/base/error.h"
#include "pipeline/base/text.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/grammar_run.h"
#include "pipeline/cli/rule_files.h"
#include "pipeline/cli/staged_file.h"
#include "pipeline/settings/command_line.h"
#include "styles/grammar/language/bilke_import.h"
#include "styles/grammar/language/check.h"
#include "styles/grammar/language/program.h"

namespace blockrand::cli {

namespace {

using settings::Settings;
namespace fs = std::filesystem;

constexpr const char* kSeverities[] = {"note", "warning", "error"};

/// As compilers do: the message, the line, and where in it.
void print(const grammar::Diagnostic& d, const grammar::Program& program, const Settings& s) {
  if (s.quiet && d.severity == grammar::Severity::note) return;
  if (s.log_format == base::LogFormat::json) {
    nlohmann::ordered_json line;
    line["level"] = kSeverities[static_cast<std::size_t>(d.severity)];
    line["file"] = d.location.file < program.files.size() ? program.files[d.location.file].path : "";
    line["line"] = d.location.line;
    line["column"] = d.location.column;
    line["code"] = d.code;
    line["message"] = d.message;
    line["text"] = d.text;
    line["suggestion"] = d.suggestion;
    fmt::print(stderr, "{}\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  fmt::print(stderr, "{}\n", grammar::format(d, program.files));
  if (d.location.line == 0 || d.location.file >= program.files.size()) return;
  std::string_view rest = program.files[d.location.file].text;
  for (std::uint32_t line = 1; line < d.location.line; ++line) {
    const std::size_t end = rest.find_first_of("\r\n");
    if (end == std::string_view::npos) return;
    rest.remove_prefix(end + (rest.substr(end, 2) == "\r\n" ? 2 : 1));
  }
  rest = rest.substr(0, rest.find_first_of("\r\n"));
  constexpr std::size_t kWidest = 160;
  if (rest.size() > kWidest) return;
  std::string mark;
  std::uint32_t column = 1;
  for (const char c : rest) {
    if (column == d.location.column) break;
    if ((static_cast<unsigned char>(c) & 0xc0U) == 0x80U) continue;
    mark += c == '\t' ? '\t' : ' ';
    ++column;
  }
  fmt::print(stderr, "  {}\n  {}^\n", rest, mark);
}

/// What one file tells.
struct Count {
  std::size_t errors = 0, warnings = 0;
};

Count check_file(const Settings& s, const std::string& file) {
  const grammar::Program program = grammar::load(file, rule_load_options(s, file));
  std::vector<grammar::Diagnostic> all = program.diagnostics;
  // What could not be read would make checks tell of what follows from that only.
  if (!grammar::has_errors(all)) {
    const std::vector<grammar::Diagnostic> checked =
        grammar::check(program, rule_check_options(rule_elements(s, file)));
    all.insert(all.end(), checked.begin(), checked.end());
  }
  std::stable_sort(all.begin(), all.end(), [](const grammar::Diagnostic& a, const grammar::Diagnostic& b) {
    return std::tie(a.location.file, a.location.line, a.location.column) <
           std::tie(b.location.file, b.location.line, b.location.column);
  });
  Count count;
  for (const grammar::Diagnostic& d : all) {
    print(d, program, s);
    if (d.severity == grammar::Severity::error) ++count.errors;
    if (d.severity == grammar::Severity::warning) ++count.warnings;
  }
  return count;
}

int check(const Settings& s) {
  Count sum;
  for (const std::string& file : s.rule_files) {
    const Count count = check_file(s, file);
    sum.errors += count.errors;
    sum.warnings += count.warnings;
  }
  if (!s.quiet)
    fmt::print("{} {} checked: {} {}, {} {}\n", base::with_thousands(s.rule_files.size()),
               s.rule_files.size() == 1 ? "file" : "files", base::with_thousands(sum.errors),
               sum.errors == 1 ? "error" : "errors", base::with_thousands(sum.warnings),
               sum.warnings == 1 ? "warning" : "warnings");
  return sum.errors > 0 ? kInvalidInput : kSuccess;
}

int import(const Settings& s) {
  if (s.rule_files.size() != 1)
    throw base::UsageError("grammar import needs one file. Try 'blockrand grammar --help'.");
  const std::string& target = s.build.output;
  std::error_code none;
  if (!target.empty() && fs::exists(target, none) && !s.build.force)
    throw base::UsageError(target + " exists already. Choose another file with -o, or --force");
  const grammar::ImportedRules rules =
      grammar::rule_text_of(importers::facade_rules::read_facade_rules(s.rule_files.front()));
  for (const std::string& note : rules.notes) fmt::print(stderr, "{}\n", note);
  if (target.empty())
    std::fputs(rules.text.c_str(), stdout);
  else
    StagedFile(target).publish(rules.text);
  return kSuccess;
}

/// The tasks, in the order of help. A new one needs its name in settings' TASK, too.
struct Task {
  const char* name;
  int (*run)(const Settings&);
};
constexpr Task kTasks[] = {{"check", check}, {"run", run_grammar_run}, {"test", run_grammar_test}, {"import", import}};

}  // namespace

settings::CommandText grammar_text() {
  return {
      .name = "grammar",
      .summary = "rule files: checked, run, tested, and translated from other rules",
      .usage = "check FILE... | run FILE --lot 12x10 | test FILE... | import FILE.xml",
      .description =
          "Rule files (CGA shape, as CityEngine reads them) say how facades are made. 'check' reads rule files "
          "with all that "
          "they import and tells what is wrong or looks wrong, with file, line and column. 'import' translates the "
          "facade "
          "rules in XML of Bilke's CityGenerator into a rule file.\n"
          "'run' derives a rule file on a rectangular lot and prints what it prints, its reports and its leaves; with "
          "-o FILE.glb it writes the model, a material for each colour. 'test' derives what the comments of rule files "
          "expect, lines such as '// expect: lot 10x20; leaves W 4; report area sum 1800' (docs/grammar_tests.md), and "
          "tells what differs.",
      .options = settings::kGrammar,
      .examples = {{"blockrand grammar check facade.cga", ""},
                   {"blockrand grammar check --roots shared,/ESRI.lib=/data/esri rules/*.cga",
                    "with places for imports"},
                   {"blockrand grammar run facade.cga --lot 14x11 --storeys 5 --seed 7 -o facade.glb", ""},
                   {"blockrand grammar test facade.cga", ""},
                   {"blockrand grammar import FacadeStructure.xml -o facade.cga", ""}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"4", "output could not be written or internal error"}}};
}

int run_grammar(const std::vector<std::string>& arguments) {
  const settings::CommandLine line = settings::read_command_line(settings::kGrammar, arguments);
  if (line.help) {
    std::fputs(settings::command_help(grammar_text()).c_str(), stdout);
    return kSuccess;
  }
  settings::refuse_unread(line, settings::kGrammar, line.settings.task,
                          {{"configs", {"check", "run"}},
                           {"lot", {"run"}},
                           {"storeys", {"run"}},
                           {"attr", {"run"}},
                           {"rule", {"run"}},
                           {"tree", {"run"}},
                           {"seed", {"run"}},
                           {"output", {"run", "import"}},
                           {"force", {"run", "import"}}});
  for (const Task& task : kTasks)
    if (line.settings.task == task.name) return task.run(line.settings);
  return kWrongUsage;
}

}  // namespace blockrand::cli
