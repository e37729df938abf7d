// The reference of all options, for people.
#pragma once

#include <string>

namespace blockrand::settings {

/// docs/options.md.
std::string options_markdown();

}  // namespace blockrand::settings
