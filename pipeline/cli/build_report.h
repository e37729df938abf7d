// What a finished build tells the user.
#pragma once

#include <string>

#include "pipeline/run/build.h"

namespace blockrand::cli {

/// A table for people: objects in and what became of them, models by level of detail, coded reasons, speed, size, and
/// where the result is. Ends with a line break.
std::string build_report(const run::BuildOptions& options, const run::BuildSummary& summary);

/// The same as one line of JSON.
std::string build_report_json(const run::BuildOptions& options, const run::BuildSummary& summary);

/// Objects that went in and came out in no state at all; 0 in a program without bugs (ARCHITECTURE.md, law 1).
std::int64_t unaccounted(const run::BuildSummary& summary);

}  // namespace blockrand::cli
