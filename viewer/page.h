// The page that shows a build in the browser, as `npm run build` bundled it: index.html, viewer.js, viewer.css, LICENSES.txt.
#pragma once

#include <string_view>

namespace blockrand::viewer {

/// The content of one of these files. \throws std::logic_error  there is none of that name
std::string_view asset(std::string_view name);

}  // namespace blockrand::viewer
