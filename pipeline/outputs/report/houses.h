// The houses one by one: the table and the search of report.html, and buildings.csv. Internal to this folder.
#pragma once

#include <string>

#include "pipeline/base/template.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"
#include "pipeline/outputs/report/report_map.h"
#include "pipeline/outputs/report/report_tile.h"

namespace blockrand::outputs {

/// "Gründerzeit", "1919 to 1945"; "" for kNotClassified.
std::string_view style_label(std::uint8_t style);
std::string_view era_label(std::uint8_t era);
/// "apartments"; underscores become blanks, "yes" is "" since it says nothing.
std::string use_label(std::string_view use);

struct HouseLimits {
  std::size_t searched = 20'000;  ///< houses that the page knows; of larger builds those that have an address or a name
  std::size_t rows = 25;  ///< of the table before the page's script runs, which adds the others as they are asked for
};

/// \param block_number  parallel to footprints.names: the number of the block of that id, 0 for none
/// Values of the template report/houses.html, with the houses as JSON that stands in XML as it is.
base::Values house_values(const MapFootprints& footprints, const ReportMap& map,
                          const std::vector<std::uint32_t>& block_number, const HouseLimits& limits = {});

/// The first line of buildings.csv, behind the mark that tells spreadsheets of UTF-8.
std::string csv_head();
/// One line for each owned building of a finished tile (RFC 4180). A text that a spreadsheet would take for a formula
/// begins with an apostrophe. Pure: safe for different tiles at the same time.
std::string csv_lines(const model::Region& region, const ReportTile& tile, const georef::Projection& projection);

}  // namespace blockrand::outputs
