// The page's style sheet and its script. Internal to this folder.
#pragma once

#include <string_view>

namespace blockrand::outputs {

/// What the page needs beside base::kPageStyle. Neither holds < or &, so that the page is XML as it stands.
extern const std::string_view kReportStyle;
/// Adds conveniences only: zoom of the map, search in the lists. Nothing on the page depends on it.
extern const std::string_view kPageScript;

}  // namespace blockrand::outputs
