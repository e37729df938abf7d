// Exceptions become messages and exit codes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/base/progress.h"

namespace blockrand::cli {

/// Calls `command` and returns its exit code; an exception is shown on stderr as `blockrand: error: …` and becomes the
/// exit code of its kind.
int guarded(base::LogFormat format, const std::function<int()>& command);

/// The log format that the arguments ask for, found without checking them: for errors in the arguments themselves.
base::LogFormat early_log_format(const std::vector<std::string>& arguments);

}  // namespace blockrand::cli
