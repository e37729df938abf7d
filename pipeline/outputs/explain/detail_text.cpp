#include "pipeline/outputs/explain/detail_text.h"

#include <fmt/format.h>

#include <utility>

#include "pipeline/outputs/placed_element.h"

namespace blockrand::outputs {
namespace {

std::string counted(std::uint64_t n, const char* one) { return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s"); }

std::string list(const std::map<std::string_view, std::uint64_t>& counts) {
  std::string text;
  for (const auto& [kind, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kind);
  return text;
}

}  // namespace

void add_detail(const model::Region& region, const model::Detail& detail, DetailCounts& counts) {
  std::uint64_t portals = 0;
  for (const model::Opening& o : detail.openings) {
    counts.windows += o.kind == model::OpeningKind::window;
    counts.doors += o.kind == model::OpeningKind::door;
    portals += o.kind == model::OpeningKind::passage;
  }
  counts.passages += portals / 2;
  for (const model::Placement& p : detail.placements)
    if (const model::Element& e = *region.elements.at(p.element).element; has_shape(e)) ++counts.elements[e.kind];
  for (const model::WallInstallation& i : detail.installations) ++counts.installations[i.kind];
  for (const model::RoofElementKind kind : detail.roof_elements) ++counts.roof_elements[model::name(kind)];
  for (const model::RoofInstallation& i : detail.roof_installations) ++counts.installations[model::name(i.kind)];
}

std::string detail_text(const DetailCounts& counts) {
  std::string text = counted(counts.windows, "window") + ", " + counted(counts.doors, "door");
  if (counts.passages > 0) text += ", " + counted(counts.passages, "passage");
  if (!counts.elements.empty()) text += "; placed " + list(counts.elements);
  if (!counts.roof_elements.empty()) text += "; in its roof: " + list(counts.roof_elements);
  if (!counts.installations.empty()) text += "; bodies on walls and roofs: " + list(counts.installations);
  return text;
}

void append_detail(JsonText& json, const model::Region& region, const model::Detail& detail) {
  DetailCounts counts;
  add_detail(region, detail, counts);
  json.key("detail");
  json.open('{');
  json.number("windows", static_cast<double>(counts.windows));
  json.number("doors", static_cast<double>(counts.doors));
  json.number("passages", static_cast<double>(counts.passages));
  for (const auto& [name, kinds] : {std::pair("elements", &counts.elements),
                                    {"roof_elements", &counts.roof_elements},
                                    {"installations", &counts.installations}}) {
    json.key(name);
    json.open('{');
    for (const auto& [kind, count] : *kinds) json.number(kind, static_cast<double>(count));
    json.close('}');
  }
  json.close('}');
}

}  // namespace blockrand::outputs
