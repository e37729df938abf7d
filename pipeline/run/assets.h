// Pages that a build of many areas and an update write: files of this folder that are part of the program.
#pragma once

#include <string_view>

namespace blockrand::run {

/// The content of a file. \param name  as pipeline/run/CMakeLists.txt lists it: "overview.html"
/// \throws std::logic_error  there is none of that name
std::string_view asset(std::string_view name);

}  // namespace blockrand::run
