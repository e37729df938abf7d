// The builds of which a build in areas consists.
#pragma once

#include <string>
#include <vector>

namespace blockrand::outputs {

/// "areas/11/1093/805" of each, as the folder's build.json lists them; nothing for a build that has none, or where it cannot be read.
std::vector<std::string> area_folders(const std::string& folder);

}  // namespace blockrand::outputs
