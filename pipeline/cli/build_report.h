// What a finished build tells the user.
#pragma once

#include <string>

#include "pipeline/run/build.h"

namespace blockrand::cli {

/// A table for people: objects in and what became of them, models by level of detail, coded reasons, speed, size, and
/// where the result is. Ends with a line break.
/// \param verbose  gauges for developers as well: the object store, tiles in flight, how roofs stand in their rows
std::string build_report(const run::BuildOptions& options, const run::BuildSummary& summary, bool verbose = false);

/// The same as one line of JSON.
std::string build_report_json(const run::BuildOptions& options, const run::BuildSummary& summary);

/// Of a build with objects that are unaccounted for (ARCHITECTURE.md, law 1): which, and where the build lies.
std::string unaccounted_text(const run::BuildOptions& options, const run::BuildSummary& summary);

}  // namespace blockrand::cli
