// The page's sections. Internal to this folder; each returns well-formed HTML with its heading.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/outputs/report/report_facts.h"
#include "pipeline/outputs/report/report_map.h"
#include "pipeline/outputs/report/report_page.h"

namespace blockrand::outputs {

/// What was built, from what: title, key figures.
/// \param styles  the page has a section on styles
std::string head_section(const ReportFacts& facts, bool styles);
std::string picture_section(const ReportFacts& facts);
/// Classes of appearance and eras, and what they rest on; empty where nothing was classified.
std::string style_section(const StyleCounts& counts);
bool has_styles(const StyleCounts& counts);
/// Where attributes come from: one stacked bar for each.
std::string source_section(const ReportFacts& facts);
/// Roofs, areas, volumes.
std::string statistics_section(const ReportFacts& facts);
/// Where the files are, how to open them, how to ask for one building.
std::string file_section(const ReportFacts& facts);
/// Empty where neither repair nor context has anything to say.
std::string context_section(const ReportFacts& facts);
bool has_context(const ReportFacts& facts);

/// One line of the lists of issues: an object, and where it is on the map.
struct ListedRow {
  model::OsmId object;
  std::string detail;
  std::uint32_t building = model::kNoIndex;  ///< into the footprints
};

/// All rows of one code; `rows` holds the first of them, `count` tells how many there are.
struct CodeRows {
  model::IssueCode code = model::IssueCode::none;
  std::uint64_t count = 0;
  std::vector<ListedRow> rows;
};

/// Objects by code, at most `options.listed_objects` of each, in id order; and the gravest issue class of each building.
struct Issues {
  std::vector<CodeRows> codes;            ///< in the order of issue_codes.h, those that occur
  std::vector<std::uint8_t> of_building;  ///< issue class of report_map.h, parallel to the footprints
  std::vector<std::uint32_t> listed;      ///< buildings that appear in a list, ascending
};
Issues collect_issues(const MapFootprints& footprints, const ReportFacts& facts, const ReportOptions& options);

/// \param marks  buildings with a mark on the map, ascending
std::string issue_section(const MapFootprints& footprints, const Issues& issues,
                          const std::vector<std::uint32_t>& marks, const ReportFacts& facts,
                          const ReportOptions& options);
std::string map_section(const ReportMap& map, const ReportFacts& facts);

}  // namespace blockrand::outputs
