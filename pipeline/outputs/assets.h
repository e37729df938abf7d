// Style sheets, scripts and pages that outputs are made of: files of this folder that are part of the program.
#pragma once

#include <string_view>

namespace blockrand::outputs {

/// The content of a file. \param name  as pipeline/outputs/CMakeLists.txt lists it: "report/report.css"
/// \throws std::logic_error  there is none of that name
std::string_view asset(std::string_view name);

}  // namespace blockrand::outputs
