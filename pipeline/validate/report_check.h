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
  std::map<std::string, std::string> states;  ///< of those that are not in the model: id → "reported", "duplicate"
  std::map<std::string, std::string> all;     ///< id → state and code: "reported NODE_ONLY", "represented "
  std::set<std::string> mended;  ///< objects with rows that leave corners anywhere, or that say nothing of them
  /// Objects with a row that tells of an overlap with another part or building: PARTS_OVERLAP, OVERLAP_KEPT.
  std::set<std::string> overlapping;
  std::set<std::string> moved;  ///< objects with rows of repairs that move corners by a stated length at most
};

/// Reads FOLDER/report.json and compares it with build.json, row by row: REPORT_WRONG, COUNTS_DIFFER.
/// \return nothing where it cannot be read
std::optional<Report> read_report(const std::string& folder, const BuildRecord& record, FindingLog& log);

/// Reads FOLDER/report.html: well-formed, loads nothing from elsewhere, and its numbers are those of build.json; the
/// map shows each building once (or, of a large build, none by its id). REPORT_WRONG, FILE_UNREADABLE. \param buildings
/// ids of all buildings of the model that have something to show; null: not compared \return how many numbers and
/// footprints were compared
std::uint64_t check_report_page(const std::string& folder, const BuildRecord& record,
                                const std::set<std::string>* buildings, FindingLog& log);

}  // namespace blockrand::validate
