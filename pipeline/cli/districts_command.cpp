#include "pipeline/cli/districts_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "importers/reference/triangle_model.h"
#include "pipeline/attributes/rule_sets.h"
#include "pipeline/base/error.h"
#include "pipeline/base/parallel.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/publish.h"
#include "pipeline/base/text.h"
#include "pipeline/cli/configs_folder.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/path_kinds.h"
#include "pipeline/cli/signals.h"
#include "pipeline/cli/spooled_input.h"
#include "pipeline/cli/staged_file.h"
#include "pipeline/facades/grammar_library.h"
#include "pipeline/georef/crs.h"
#include "pipeline/run/district_survey.h"
#include "pipeline/run/output_place.h"
#include "pipeline/settings/command_line.h"
#include "styles/classify/catalogue.h"
#include "styles/districts/presets.h"
#include "styles/districts/read_rule_set.h"

namespace blockrand::cli {

namespace {

using settings::Settings;
namespace rules = districts;

std::string summary(const rules::RuleSets& book) {
  std::string text;
  for (const rules::RuleSet& set : book.sets) {
    std::array<std::size_t, 4> levels{};
    for (const rules::Rule& rule : set.rules) ++levels[static_cast<std::size_t>(rule.level)];
    text += fmt::format("{:<24}{} rules ({} city, {} district, {} block, {} building), {}{}\n", set.name,
                        set.rules.size(), levels[0], levels[1], levels[2], levels[3],
                        set.polygon.empty() ? "anywhere" : fmt::format("a polygon of {} corners", set.polygon.size()),
                        set.prior.style || set.prior.era || !set.prior.substyle.empty() ? ", with priors" : "");
  }
  return text + fmt::format("{} presets known\n", book.presets.size());
}

/// Errors of the installed rule sets, one of each file at most.
std::vector<std::string> errors_of_all(const std::string& configs) {
  namespace fs = std::filesystem;
  std::vector<std::string> errors;
  rules::RuleSets book;
  book.presets = rules::read_presets((fs::path(configs) / "styles" / "presets.toml").string());
  const classify::Catalogue catalogue = classify::read_catalogue(configs);
  for (const classify::Style& style : catalogue.styles()) book.substyles.push_back(style.id);
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(configs) / "districts"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) try {
      rules::read_rule_set(file.string(), book);
    } catch (const base::InputError& error) {
      errors.emplace_back(error.what());
    }
  return errors;
}

/// Every file is checked, so that one call tells the first error of each.
int check(const Settings& s) {
  std::vector<std::string> errors;
  std::string text;
  const auto try_read = [&](const std::string& name) {
    try {
      const attributes::ReadRuleSets read = attributes::read_rule_sets(s.build.configs, name);
      text += summary(read.book);
      const facades::GrammarLibrary grammars =
          facades::read_grammars(s.build.configs, read.book.presets, importers::reference::read_triangle_model);
      text += fmt::format("{} kinds of elements, {} profiles\n", grammars.elements().kinds().size(),
                          grammars.elements().profiles().size());
      for (std::string& what : facades::unread_parameters(read.book, grammars)) errors.push_back(std::move(what));
      return true;
    } catch (const base::InputError& error) {
      errors.emplace_back(error.what());
    } catch (const base::UsageError& error) {
      errors.emplace_back(error.what());
    }
    return false;
  };
  if (!s.files.empty()) {
    for (const std::string& file : s.files) try_read(file);
  } else if (!try_read(s.build.districts) && s.build.districts.empty()) {
    try {
      if (std::vector<std::string> all = errors_of_all(s.build.configs); !all.empty()) errors = std::move(all);
    } catch (const std::exception&) {
      // Presets or the catalogue themselves cannot be read: that was told.
    }
  }
  for (const std::string& error : errors) fmt::print(stderr, "blockrand: error: {}\n", error);
  if (!errors.empty()) return kInvalidInput;
  if (!s.quiet) std::fputs(text.c_str(), stdout);
  return kSuccess;
}

std::string table(const run::DistrictView& view) {
  std::string text = fmt::format("{} buildings, {} without a preset\n\n{:<24}{:<36}{:<22}{:>10}\n",
                                 base::with_thousands(view.buildings), base::with_thousands(view.without), "rule set",
                                 "rule", "preset", "buildings");
  for (const run::DistrictCount& c : view.counts)
    text += fmt::format("{:<24}{:<36}{:<22}{:>10}\n", c.set,
                        c.rule.empty() ? c.preset.empty() ? "(none)" : "(tag)" : c.rule,
                        c.preset.empty() ? "(none)" : c.preset, base::with_thousands(c.buildings));
  if (!view.silent_rules.empty()) {
    text += "\nRules that hold for no building here\n";
    for (const std::string& rule : view.silent_rules) text += "  " + rule + "\n";
  }
  if (!view.idle_rules.empty()) {
    text += "\nRules that hold for some, but never choose the preset: stronger ones always do\n";
    for (const std::string& rule : view.idle_rules) text += "  " + rule + "\n";
  }
  return text;
}

int show(Settings& s) {
  if (s.files.size() != 1)
    throw base::UsageError("districts show needs one EXTRACT. Try 'blockrand districts --help'.");
  if (s.build.output.empty()) throw base::UsageError("districts show needs --output FOLDER.");
  s.build.input = s.files.front();
  clean_up_on_signals(s.log_format);
  base::refuse_inputs_in(s.build.output, {s.build.input, s.build.configs, s.build.districts});
  const auto foreign = [](const std::string& at) {
    return run::files_other_than({"districts.json", "districts.gpkg", "map.png"}, at);
  };
  base::StagedFolder folder(
      s.build.output, s.build.force,
      base::FolderKind{.name = "map of districts", .marker = "districts.json", .foreign = foreign});
  base::Progress progress(s.progress, s.log_format, s.quiet);
  tell_removed(folder, progress);
  const attributes::ReadRuleSets book = attributes::read_rule_sets(s.build.configs, s.build.districts);
  const auto survey = run::survey_districts(s.build, book, progress);
  const run::DistrictView view =
      run::show_districts(*survey, book.book, s.map_by == "rule", folder, base::worker_count(s.build.jobs), progress);
  for (const std::string& what : view.unanswered) progress.warn(what);
  if (const std::string left = folder.publish(); !left.empty())
    progress.warn("the earlier map could not be removed: " + left);
  if (!s.quiet) std::fputs(table(view).c_str(), stdout);
  return kSuccess;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

int diff(Settings& s) {
  if (s.files.size() != 3)
    throw base::UsageError(
        "districts diff needs two rule sets and an extract: A B EXTRACT. Try 'blockrand districts --help'.");
  const std::string& csv = s.build.output;
  std::error_code none;
  if (!csv.empty() && std::filesystem::exists(csv, none) && !s.build.force)
    throw base::UsageError(csv + " exists already. Choose another file with -o, or --force");
  std::optional<StagedFile> staged;
  if (!csv.empty()) staged.emplace(csv);
  s.build.input = s.files[2];
  base::Progress progress(s.progress, s.log_format, s.quiet);
  const attributes::ReadRuleSets a = attributes::read_rule_sets(s.build.configs, s.files[0]),
                                 b = attributes::read_rule_sets(s.build.configs, s.files[1]);
  const auto survey = run::survey_districts(s.build, a, progress);
  const std::vector<run::DistrictChange> changes =
      run::diff_districts(*survey, a.book, b.book, base::worker_count(s.build.jobs), progress);
  progress.end();

  std::map<std::pair<std::string, std::string>, std::uint64_t> presets;
  std::uint64_t parameters = 0;
  std::string rows = "id,preset_a,preset_b,rule_a,rule_b,parameters_a,parameters_b\n";
  for (const run::DistrictChange& c : changes) {
    if (c.preset_a != c.preset_b)
      ++presets[{c.preset_a, c.preset_b}];
    else
      ++parameters;
    rows += fmt::format("{},{},{},{},{},{},{}\n", c.id.text(), c.preset_a, c.preset_b, quoted(c.rule_a),
                        quoted(c.rule_b), quoted(c.parameters_a), quoted(c.parameters_b));
  }
  if (staged) staged->publish(rows);
  if (s.quiet) return kSuccess;
  fmt::print("{} of {} buildings change; {} of them in parameters only\n", base::with_thousands(changes.size()),
             base::with_thousands(survey->buildings().size()), base::with_thousands(parameters));
  std::vector<std::pair<std::pair<std::string, std::string>, std::uint64_t>> order(presets.begin(), presets.end());
  std::stable_sort(order.begin(), order.end(), [](const auto& x, const auto& y) { return x.second > y.second; });
  for (const auto& [change, n] : order)
    fmt::print("  {:<22}-> {:<22}{:>10}\n", change.first.empty() ? "(none)" : change.first,
               change.second.empty() ? "(none)" : change.second, base::with_thousands(n));
  constexpr std::size_t kListed = 20;
  for (std::size_t i = 0; i < std::min(kListed, changes.size()); ++i) {
    const run::DistrictChange& c = changes[i];
    if (c.preset_a != c.preset_b)
      fmt::print("{:<14}{} -> {}\n", c.id.text(), c.preset_a, c.preset_b);
    else
      fmt::print("{:<14}{}: {} -> {}\n", c.id.text(), c.preset_a, c.parameters_a, c.parameters_b);
  }
  if (changes.size() > kListed && csv.empty())
    fmt::print("... and {} more; -o FILE.csv lists all\n", changes.size() - kListed);
  return kSuccess;
}

}  // namespace

settings::CommandText districts_text() {
  return {
      .name = "districts",
      .summary = "district rules: checked, shown on a map, compared",
      .usage = "check [FILE...] | show EXTRACT -o FOLDER | diff A B EXTRACT [-o FILE.csv]",
      .description =
          "District rules choose the preset that a building's facades are made with. 'check' reads rule sets and tells "
          "what is wrong in them, with file and line. 'show' reads an extract as a build does, but builds nothing: it "
          "counts which rule fires how often and writes districts.gpkg, districts.json and map.png. 'diff' tells which "
          "buildings would change if rule set B held instead of A. The language: docs/districts.md.",
      .options = settings::kDistricts,
      .examples = {{"blockrand districts check", "the rule sets that came with the program"},
                   {"blockrand districts show leipzig.osm.pbf -o map", "each place by its own rule set"},
                   {"blockrand districts show leipzig.osm.pbf --districts mine.toml --by rule -o map", ""},
                   {"blockrand districts diff leipzig mine.toml leipzig.osm.pbf -o changes.csv",
                    "before a change goes live"}},
      .exit_codes = {{"0", "all well"},
                     {"1", "wrong usage"},
                     {"2", "unreadable or invalid input"},
                     {"4", "output could not be written or internal error"},
                     {"128 + N", "ended by signal N"}}};
}

int run_districts(const std::vector<std::string>& arguments) {
  settings::CommandLine line = settings::read_command_line(settings::kDistricts, arguments);
  if (line.help) {
    std::fputs(settings::command_help(districts_text()).c_str(), stdout);
    return kSuccess;
  }
  Settings& s = line.settings;
  const std::vector<std::string_view> both = {"show", "diff"};
  settings::refuse_unread(line, settings::kDistricts, s.action,
                          {{"bbox", both},
                           {"crs", both},
                           {"overrides", both},
                           {"seed", both},
                           {"jobs", both},
                           {"output", both},
                           {"force", both},
                           {"districts", {"show"}},
                           {"by", {"show"}}});
  s.build.configs = configs_folder(s.build.configs, program_file());
  if (s.action == "check") return check(s);
  if (!s.build.crs.empty()) georef::check_crs(s.build.crs);
  const std::size_t extract = s.action == "show" ? 0 : 2;
  if (s.files.size() <= extract) return s.action == "show" ? show(s) : diff(s);  // they say what is missing
  expect_extract(s.files[extract]);
  base::Progress progress(s.progress, s.log_format, s.quiet);
  const std::optional<SpooledInput> piped = take_standard_input(s.files[extract], s.build.output, progress);
  progress.end();
  if (piped) s.build.input_told = kStandardInput;
  return with_input_told(piped, [&] { return s.action == "show" ? show(s) : diff(s); });
}

}  // namespace blockrand::cli
