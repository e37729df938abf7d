// What `build --dry-run` tells the user.
#pragma once

#include <string>

#include "pipeline/run/plan_build.h"

namespace blockrand::cli {

/// For people; ends with a line break.
std::string plan_report(const run::BuildOptions& options, const run::BuildPlan& plan);

/// The same as one line of JSON.
std::string plan_report_json(const run::BuildOptions& options, const run::BuildPlan& plan);

/// "about half a minute": a time in words that promise no more than is known.
std::string rough_time(double seconds);

}  // namespace blockrand::cli
