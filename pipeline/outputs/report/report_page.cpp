#include "pipeline/outputs/report/report_page.h"

#include <algorithm>
#include <iterator>

#include "pipeline/base/assets.h"
#include "pipeline/outputs/assets.h"
#include "pipeline/outputs/report/html_text.h"
#include "pipeline/outputs/report/report_map.h"
#include "pipeline/outputs/report/report_sections.h"

namespace blockrand::outputs {

void ReportBuilder::add(ReportTile&& tile) {
  MapFootprints& from = tile.footprints;
  const auto rings = static_cast<std::uint32_t>(footprints_.ring_ends.size());
  const auto corners = static_cast<std::uint32_t>(footprints_.corners.size());
  const auto buildings = static_cast<std::uint32_t>(footprints_.buildings.size());
  const auto names = static_cast<std::uint32_t>(footprints_.names.size());
  for (MapBuilding b : from.buildings) {
    b.first_ring += rings;
    if (b.name > 0) b.name += names;
    footprints_.buildings.push_back(b);
  }
  for (const std::uint32_t end : from.ring_ends) footprints_.ring_ends.push_back(end + corners);
  footprints_.corners.insert(footprints_.corners.end(), from.corners.begin(), from.corners.end());
  std::move(from.names.begin(), from.names.end(), std::back_inserter(footprints_.names));
  for (const auto& [part, building] : from.parts) footprints_.parts.emplace_back(part, building + buildings);
  footprints_.bodies += from.bodies;
  styles_.add(tile.styles);
}

std::uint64_t ReportBuilder::buildings_built() const {
  return static_cast<std::uint64_t>(std::count_if(footprints_.buildings.begin(), footprints_.buildings.end(),
                                                  [](const MapBuilding& b) { return b.built; }));
}

std::string ReportBuilder::html(const ReportFacts& facts, const ReportOptions& options) const {
  const Issues issues = collect_issues(footprints_, facts, options);
  const ReportMap map =
      report_map(footprints_, issues.of_building, issues.listed, {options.map_bytes, options.single_footprints});
  std::string out;
  out.reserve(map.svg.size() + 2'000'000);
  out +=
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<meta name=\"generator\" "
      "content=\"Blockrand " +
      escaped(facts.program_version) +
      "\"/>\n<link rel=\"icon\" href=\"data:,\"/>\n<title>Blockrand report: " + escaped(facts.name) +
      "</title>\n<style>";
  out += base::asset("page.css");
  out += asset("report/report.css");
  out += "</style>\n</head>\n<body>\n";
  out += head_section(facts, has_styles(styles_));
  out += "<main>\n";
  out += picture_section(facts);
  out += map_section(map, facts);
  out += context_section(facts);
  out += style_section(styles_);
  out += source_section(facts);
  out += issue_section(footprints_, issues, map.marks, facts, options);
  out += statistics_section(facts);
  out += file_section(facts);
  out += "</main>\n<footer>Map data <a href=\"https://www.openstreetmap.org/copyright\">" + escaped(facts.attribution) +
         "</a>. Made by Blockrand " + escaped(facts.program_version) +
         "; this page loads nothing from elsewhere.</footer>\n<script>";
  out += asset("report/report.js");
  out += "</script>\n</body>\n</html>\n";
  return out;
}

}  // namespace blockrand::outputs
