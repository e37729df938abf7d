// Whose a region is: its nights run as that account.
#pragma once

#include <string>

#include "pipeline/base/progress.h"

namespace blockrand::cli {

/// The name of the owner of a folder; empty where it is not there, or its owner has none.
std::string owner_of(const std::string& folder);

/// Warns where root works in another one's region: files that root writes are in the way of its nights, which cannot remove them.
void warn_of_root(const std::string& folder, base::Progress& progress);

}  // namespace blockrand::cli
