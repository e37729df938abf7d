// Where the presets lie that came with the program.
#pragma once

#include <string>

namespace blockrand::cli {

/// `given` if not empty; else the first of: `configs` or `share/blockrand/configs` in a folder above the program's
/// file, the source tree that it was built from. \throws base::UsageError when there is none
std::string presets_folder(const std::string& given);

}  // namespace blockrand::cli
