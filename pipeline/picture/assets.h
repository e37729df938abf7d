// Files of this folder that are part of the program.
#pragma once

#include <string_view>

namespace blockrand::picture {

/// The content of a file. \param name  as pipeline/picture/CMakeLists.txt lists it
/// \throws std::logic_error  there is none of that name
std::string_view asset(std::string_view name);

}  // namespace blockrand::picture
