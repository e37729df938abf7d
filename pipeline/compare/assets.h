// Style sheets and scripts of this folder that are part of the program.
#pragma once

#include <string_view>

namespace blockrand::compare {

/// The content of a file. \param name  as pipeline/compare/CMakeLists.txt lists it
/// \throws std::logic_error  there is none of that name
std::string_view asset(std::string_view name);

}  // namespace blockrand::compare
