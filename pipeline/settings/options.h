// The one table of all options: the command line, the config file, the help and the reference are read from it.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/compare/compare.h"
#include "pipeline/run/build.h"
#include "pipeline/validate/options.h"

namespace blockrand::settings {

/// Everything that a user can set.
struct Settings {
  run::BuildOptions build;
  std::string config;  ///< the config file, for the record; its values are in the other fields
  std::string folder;  ///< a finished build, for the commands that read one
  blockrand::validate::ValidateOptions validation;  ///< but for its folder and jobs, which other commands have too
  blockrand::compare::CompareOptions comparison;  ///< but for its jobs, seed and CRS, which other commands have too
  blockrand::compare::ReportOptions comparison_report;
  std::string baseline;                 ///< compare.json of an earlier comparison
  std::optional<double> fail_if_worse;  ///< share: 0.02 is 2 %
  std::string action;                     ///< of `districts`: check, show, diff
  std::vector<std::string> files;         ///< of `districts`: what its action is about
  std::string task;                       ///< of `grammar`: check, run, test, import
  std::vector<std::string> rule_files;    ///< of `grammar`: what its task is about
  std::vector<std::string> rule_roots;    ///< of `grammar`: where imports are looked for; "/PREFIX=DIR" is one place for one prefix
  std::string rule_lot = "10x10";              ///< of `grammar run`: width and depth in metres
  std::optional<double> rule_storeys;          ///< of `grammar run`: building.storeys
  std::vector<std::string> rule_attributes;    ///< of `grammar run`: NAME=VALUE
  std::string start_rule;                      ///< of `grammar run`; empty: the rule file's own
  bool rule_tree = false;                      ///< `grammar run` prints all shapes, not only leaves
  std::string map_by = "preset";          ///< of `districts show`: what the map is coloured by
  std::string id;      ///< of the building that `explain` is asked about
  bool json = false;   ///< print JSON
  bool edges = false;  ///< `explain` lists the stretches of the outline
  bool style = false;  ///< `explain` lists all evidence for the style
  base::ProgressStyle progress = base::ProgressStyle::automatic;
  base::LogFormat log_format = base::LogFormat::text;
  bool quiet = false;  ///< warnings and errors only
};

/// Which commands know an option; bits.
enum Commands : unsigned { kBuild = 1, kInfo = 2, kExplain = 4, kValidate = 8, kCompare = 16, kDistricts = 32, kGrammar = 64 };
inline constexpr Commands kAllCommands[] = {kBuild, kInfo, kExplain, kValidate, kCompare, kDistricts, kGrammar};
std::string_view name(Commands command);  ///< "build"

/// Where an option stands in the help and the reference; the first three are the sections of the config file.
enum class Section { build, repair, generate, compare, messages };
std::string_view name(Section section);   ///< "build"
std::string_view title(Section section);  ///< "What is built"

enum class OptionType { text, path, folder, integer, number, flag, list };

/// Why a text cannot be the value of an option; the caller adds which option and where.
struct ValueError : std::runtime_error {
  ValueError(const std::string& what, std::string how) : std::runtime_error(what), remedy(std::move(how)) {}
  std::string remedy;
};

struct Option {
  std::string_view name{};      ///< long name without dashes; of a positional argument its name in capitals
  std::string_view letter{};    ///< short name without dash, or empty
  std::string_view key{};       ///< in the config file; empty: command line only
  std::string_view argument{};  ///< what the value is called; empty for flags
  OptionType type = OptionType::text;
  Section section = Section::build;
  unsigned commands = kBuild;
  double minimum = 0, maximum = 0;  ///< of integers and numbers
  std::string_view help{};          ///< one line, with the unit, without the default
  std::string_view without{};       ///< of a flag that is on by default: what --no-… leaves out; one line
  bool several = false;             ///< may be given more than once: each value is set in turn
  std::string_view if_missing{};    ///< what to say when it has no value; empty: it need not have one
  unsigned optional_for = 0;        ///< commands that do without it all the same
  std::vector<std::string> choices{};  ///< words that are a value (of a list: an item), for completion
  /// Sets the value from text; of flags "true" or "false". \throws ValueError
  std::function<void(Settings&, const std::string&)> set{};
  /// The value as text that `set` understands; empty where nothing is set. Of a fresh Settings: the default.
  std::function<std::string(const Settings&)> show{};

  bool positional() const { return !name.empty() && name[0] >= 'A' && name[0] <= 'Z'; }
};

/// All options in the order of help and reference.
const std::vector<Option>& options();

/// The value that holds when nobody sets one, as people read it; empty for flags, whose names say it (shown_name).
std::string default_text(const Option& option);

/// A flag that is set unless --no-… takes it back.
bool on_by_default(const Option& option);

/// The long name under which people meet an option: "--lod", of a flag that is on by default "--no-report", of a
/// positional argument "INPUT".
std::string shown_name(const Option& option);

/// "0 to 2", "from 0"; empty where any value will do.
std::string range_text(const Option& option);

/// What that name does, without the default.
std::string_view shown_help(const Option& option);

}  // namespace blockrand::settings
