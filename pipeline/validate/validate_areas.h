// A build in areas read back: each area as the build that it is, and the documents that lead to them.
#pragma once

#include <string>

#include "pipeline/base/progress.h"
#include "pipeline/validate/validate_build.h"

namespace blockrand::validate {

/// Whether the folder's build.json lists areas.
bool is_in_areas(const std::string& folder);

/// As validate(); findings name files below the folder.
Validation validate_areas(const ValidateOptions& options, base::Progress& progress);

}  // namespace blockrand::validate
