#include "pipeline/outputs/report/report_page.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipeline/base/assets.h"
#include "pipeline/outputs/assets.h"
#include "pipeline/outputs/report/houses.h"
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
    for (std::uint32_t* name : {&b.name, &b.address, &b.use, &b.block})
      if (*name > 0) *name += names;
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

namespace {

/// Outlines of all blocks that the page may list.
std::vector<MapOutline> outlines_of(const ReportFacts& facts) {
  constexpr std::size_t kMost = 1'000;  // 60 bytes each
  std::vector<MapOutline> out;
  for (std::size_t i = 0; i < std::min(facts.blocks.size(), kMost); ++i) {
    MapOutline outline{static_cast<std::uint32_t>(i + 1), {}};
    for (const auto& ring : facts.blocks[i].rings) {
      outline.rings.emplace_back();
      for (const auto& [x, y] : ring)
        outline.rings.back().push_back({static_cast<std::int32_t>(std::lround(x * kMapUnitsPerMetre)),
                                        static_cast<std::int32_t>(std::lround(y * kMapUnitsPerMetre))});
    }
    out.push_back(std::move(outline));
  }
  return out;
}

}  // namespace

std::string ReportBuilder::html(const ReportFacts& facts, const ReportOptions& options) const {
  const Issues issues = collect_issues(footprints_, facts, options);
  const ReportMap map = report_map(footprints_, issues.of_building, issues.listed, outlines_of(facts),
                                   {options.map_bytes, options.single_footprints});
  const std::vector<std::uint32_t> blocks = block_numbers(footprints_, facts);
  Values page;
  page.set("version", facts.program_version).set("title", facts.name).set("attribution", facts.attribution);
  page.set("page_css", base::asset("page.css")).set("report_css", asset("report/report.css"));
  page.set("report_js", asset("report/report.js"));
  Values head = head_values(facts);
  // In the order in which planners ask: what stands there, of what kind, how much of it; then how it is known.
  const auto section = [&](std::string_view name, std::string_view id, std::string_view title,
                           std::optional<Values> values) {
    if (!values) {
      page.set(name, false);
      return;
    }
    head.add("nav", Values().set("id", id).set("name", title));
    page.add(name, std::move(*values));
  };
  std::optional<Values> styles = style_values(styles_);
  const bool classified = styles.has_value();
  section("pictures", "pictures", "Pictures", picture_values(facts));
  if (facts.model)
    section("model", "model", "Model in 3D",
            Values()
                .set("bytes", base::with_byte_unit(facts.model->files.size()))
                .set("viewer", facts.model->viewer)
                .set("model_js", asset("report/model.js")));
  section("map", "map", "Map", map_values(footprints_, map, facts, classified));
  section("houses", "houses", "Houses", house_values(footprints_, map, blocks));
  section("styles", "styles", "Styles and eras", std::move(styles));
  section("floor_areas", "floor-areas", "Floor areas", floor_area_values(footprints_, facts, map, blocks, options));
  section("statistics", "statistics", "Storeys and roofs", statistics_values(facts, map));
  section("sources", "sources", "Where values come from", source_values(facts));
  section("issues", "issues", "What fell back", issue_values(footprints_, issues, map, facts, options));
  section("context", "context", "Footprints and context", context_values(facts));
  section("files", "files", "Files", file_values(facts));
  page.add("head", std::move(head));
  std::string html = base::filled(asset, "report/page.html", std::move(page));
  if (facts.model) {  // up to 20 MB: put in last, so that no template carries them about
    constexpr std::string_view kPlace = "<!-- model -->";
    html.replace(html.find(kPlace), kPlace.size(), facts.model->files);
  }
  return html;
}

}  // namespace blockrand::outputs
