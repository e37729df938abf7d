// The page's style sheet and its script. Internal to this folder.
#pragma once

#include <string_view>

namespace blockrand::export_ {

/// Neither holds < or &, so that the page is XML as it stands.
extern const std::string_view kPageStyle;
/// Adds conveniences only: zoom of the map, search in the lists. Nothing on the page depends on it.
extern const std::string_view kPageScript;

}  // namespace blockrand::export_
