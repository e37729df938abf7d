// The one table of all options: the command line, the config file, the help and the reference are read from it.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/region/build.h"

namespace blockrand::settings {

/// Everything that a user can set.
struct Settings {
  region::BuildOptions build;
  std::string config;  ///< the config file, for the record; its values are in the other fields
  bool json = false;   ///< `info` prints JSON
  base::ProgressStyle progress = base::ProgressStyle::automatic;
  base::LogFormat log_format = base::LogFormat::text;
  bool quiet = false;  ///< warnings and errors only
};

/// Which commands know an option; bits.
enum Commands : unsigned { kBuild = 1, kInfo = 2 };

/// Where an option stands in the help and the reference; the first three are the sections of the config file.
enum class Section { build, repair, generate, messages };
std::string_view name(Section section);   ///< "build"
std::string_view title(Section section);  ///< "What is built"

enum class OptionType { text, path, integer, number, flag, list };

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
  /// Sets the value from text; of flags "true" or "false". \throws ValueError
  std::function<void(Settings&, const std::string&)> set{};
  /// The value as text that `set` understands; empty where nothing is set. Of a fresh Settings: the default.
  std::function<std::string(const Settings&)> show{};

  bool positional() const { return !name.empty() && name[0] >= 'A' && name[0] <= 'Z'; }
};

/// All options in the order of help and reference.
const std::vector<Option>& options();

/// The value that holds when nobody sets one, as people read it.
std::string default_text(const Option& option);

}  // namespace blockrand::settings
