// What the page's templates are filled with, one function for each section. Internal to this folder. Each returns the
// values of the template that bears its name (report/head.html, …); nothing where the section would be empty.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/template.h"
#include "pipeline/outputs/report/report_facts.h"
#include "pipeline/outputs/report/report_map.h"
#include "pipeline/outputs/report/report_page.h"

namespace blockrand::outputs {

using base::Values;

/// What was built, from what: key figures.
Values head_values(const ReportFacts& facts);
std::optional<Values> picture_values(const ReportFacts& facts);
/// Classes of appearance and eras, and what they rest on; nothing where no building was classified.
std::optional<Values> style_values(const StyleCounts& counts);
/// Gross floor areas by use, style, era and block; nothing where none was measured.
/// \param block_number  as block_numbers
std::optional<Values> floor_area_values(const MapFootprints& footprints, const ReportFacts& facts, const ReportMap& map,
                                        const std::vector<std::uint32_t>& block_number, const ReportOptions& options);
/// Parallel to footprints.names: the number of the block of that id, from 1; 0 for what is no block.
std::vector<std::uint32_t> block_numbers(const MapFootprints& footprints, const ReportFacts& facts);
/// Where attributes come from: one stacked bar for each.
Values source_values(const ReportFacts& facts);
/// Storeys, roofs, areas, volumes.
Values statistics_values(const ReportFacts& facts, const ReportMap& map);
/// Where the files are, how to open them, how to ask for one building.
Values file_values(const ReportFacts& facts);
/// Nothing where neither repair nor context has anything to say.
std::optional<Values> context_values(const ReportFacts& facts);

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

Values issue_values(const MapFootprints& footprints, const Issues& issues, const ReportMap& map,
                    const ReportFacts& facts, const ReportOptions& options);
/// \param styles  buildings were classified: the map begins with their styles
Values map_values(const MapFootprints& footprints, const ReportMap& map, const ReportFacts& facts, bool styles);

/// A stacked bar: shares of `all`, each in the colour of a CSS class.
struct BarPart {
  std::string css_class, name;
  std::uint64_t count = 0;
};
/// Values of report/bar.html. \param all  what the whole width stands for  \param sum  of which percentages are told
Values bar_values(const std::vector<BarPart>& parts, std::uint64_t all, std::uint64_t sum);

}  // namespace blockrand::outputs
