// The look that all pages of this program share, page.css: colours of paper and ink (light and dark), headings, tables, figures.
// Style sheets and scripts hold neither < nor &, so that a page is XML as it stands.
#pragma once

#include <string_view>

namespace blockrand::base {

/// The content of a file. \param name  as pipeline/base/CMakeLists.txt lists it
/// \throws std::logic_error  there is none of that name
std::string_view asset(std::string_view name);

}  // namespace blockrand::base
