// The manual page blockrand(1), from the tables that make --help.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::settings {

/// What the manual says beyond commands and options; each row is a name and its meaning.
struct ManualText {
  std::string version;
  std::string summary;                                       ///< for NAME: one line without a full stop
  std::string description;                                   ///< paragraphs, each one line, separated by '\n'
  std::vector<std::pair<std::string, std::string>> outputs;  ///< what a build's folder holds
  std::vector<std::pair<std::string, std::string>> files;    ///< what the program reads by itself
};

/// The page as roff with man(7) macros: ASCII, no date (it would be the clock's), the same bytes each time.
std::string manual(const ManualText& text, std::span<const CommandText> commands);

}  // namespace blockrand::settings
