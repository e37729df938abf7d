// What a finished build tells the user.
#pragma once

#include <string>

#include "pipeline/region/build.h"

namespace blockrand::cli {

/// A table for people: objects in and what became of them, models by level of detail, coded reasons, speed, size, and
/// where the result is. Ends with a line break.
std::string build_report(const region::BuildOptions& options, const region::BuildSummary& summary);

/// The same as one line of JSON.
std::string build_report_json(const region::BuildOptions& options, const region::BuildSummary& summary);

/// Objects that went in and came out in no state at all; 0 in a program without bugs (DESIGN law 1).
std::int64_t unaccounted(const region::BuildSummary& summary);

}  // namespace blockrand::cli
