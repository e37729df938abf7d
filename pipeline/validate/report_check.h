// report.json and report.html read back.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "pipeline/validate/build_record.h"

namespace blockrand::validate {

/// What report.json says, as far as other checks need it.
struct Report {
  std::uint64_t objects = 0;
  std::map<std::string, std::string> states;  ///< id → "reported", "duplicate"
  std::set<std::string> mended;               ///< objects with any row: their corners may have been moved
};

/// Reads FOLDER/report.json and compares it with build.json, row by row: REPORT_WRONG, COUNTS_DIFFER.
/// \return nothing where it cannot be read
std::optional<Report> read_report(const std::string& folder, const BuildRecord& record, FindingLog& log);

}  // namespace blockrand::validate
