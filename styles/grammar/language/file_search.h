// Where the files that rule files name are found (docs/rule_language.md §1.5, §7.2 number 21).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "styles/grammar/language/program.h"

namespace blockrand::grammar {

struct FoundFile {
  std::string path;  ///< lexically normal: two searches that find one file give one path
  std::string bytes;
  std::string written_otherwise;  ///< the path with the letters' case as the disk has it, where it had to be corrected
};

/// "a/b/../c" → "a/c"; backslashes become slashes.
std::string normal_path(std::string_view path);

/// \param from  the importing file; empty for the start file
std::optional<FoundFile> find_file(std::string_view path, std::string_view from, const LoadOptions& options);

}  // namespace blockrand::grammar
