// `blockrand view`: a build in the browser.
#pragma once

#include <string>
#include <vector>

#include "pipeline/settings/command_text.h"

namespace blockrand::cli {

settings::CommandText view_text();
/// Serves until it is interrupted, or writes the site.
int run_view(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
