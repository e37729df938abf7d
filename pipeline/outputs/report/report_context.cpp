// The section "Footprints and context": what repair did, what walls face, how buildings stand, a plan.
#include <algorithm>

#include "pipeline/base/text.h"
#include "pipeline/model/wall_segment_colours.h"
#include "pipeline/outputs/report/html_text.h"
#include "pipeline/outputs/report/report_sections.h"

namespace blockrand::outputs {
namespace {

using base::with_thousands;

std::string spaced(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

std::string swatch(model::Colour colour) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 10 10\" aria-hidden=\"true\"><rect width=\"10\" "
         "height=\"10\" "
         "fill=\"" +
         model::text(colour) + "\"/></svg>";
}

std::string_view meaning(model::BuildingPosition position) {
  constexpr std::string_view meanings[model::kBuildingPositionCount] = {
      "not known",
      "shares no wall",
      "shares walls on one side",
      "shares walls on two sides",
      "has fronts on two streets that meet",
      "stands inside the block, without a front on a street",
      "stands inside the block, along the border of its lot",
  };
  return meanings[static_cast<int>(position)];
}

std::string plan_figure(const ContextFacts& c) {
  if (!c.plan) return {};
  std::string out = "<h3>Plan</h3>\n";
  if (!c.plan_note.empty()) out += "<p>" + escaped(c.plan_note) + "</p>\n";
  out += "<figure><img width=\"" + std::to_string(c.plan->width) + "\" height=\"" + std::to_string(c.plan->height) +
         "\" alt=\"" + escaped(c.plan->caption) + "\" src=\"data:image/png;base64,";
  append_base64(out, c.plan->png);
  out += "\"/><figcaption>" + escaped(c.plan->caption) + "</figcaption></figure>\n<ul class=\"key\">";
  for (int k = 0; k < model::kWallSegmentKindCount; ++k) {
    const auto kind = static_cast<model::WallSegmentKind>((k + 1) % model::kWallSegmentKindCount);  // unknown last
    if (kind == model::WallSegmentKind::unknown && c.edges[0] == 0) continue;
    out += "<li>" + swatch(model::colour_of(kind)) + spaced(model::name(kind)) + "</li>";
  }
  return out + "</ul>\n";
}

std::string edge_table(const ContextFacts& c) {
  std::uint64_t all = 0;
  double length = 0;
  for (std::size_t k = 0; k < c.edges.size(); ++k) {
    all += c.edges[k];
    length += c.edge_length[k];
  }
  if (all == 0) return {};
  std::string out =
      "<h3>What walls face</h3>\n<table class=\"edges\"><thead><tr><th>Kind</th><th class=\"n\">Stretches</th><th "
      "class=\"n\">Length</th><th class=\"n\">Of the length</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < c.edges.size(); ++i) {
    const std::size_t k = (i + 1) % c.edges.size();
    if (c.edges[k] == 0) continue;
    const auto kind = static_cast<model::WallSegmentKind>(k);
    out += "<tr><td><span class=\"key\">" + swatch(model::colour_of(kind)) + "</span>" + spaced(model::name(kind)) +
           " <span class=\"soft\">" + std::string(model::meaning(kind)) + "</span></td><td class=\"n\">" +
           with_thousands(c.edges[k]) + "</td><td class=\"n\">" + rounded(c.edge_length[k]) +
           "\u00a0m</td><td class=\"n\">" +
           percent(static_cast<std::uint64_t>(c.edge_length[k] + 0.5), static_cast<std::uint64_t>(length + 0.5)) +
           "</td></tr>\n";
  }
  return out + "</tbody></table>\n";
}

std::string position_table(const ContextFacts& c) {
  std::uint64_t all = 0;
  for (const std::uint64_t n : c.positions) all += n;
  if (all == c.positions[0]) return {};
  std::string out = "<h3>How buildings stand</h3>\n<table class=\"positions\"><tbody>\n";
  for (std::size_t i = 0; i < c.positions.size(); ++i) {
    const std::size_t k = (i + 1) % c.positions.size();
    if (c.positions[k] == 0) continue;
    const auto position = static_cast<model::BuildingPosition>(k);
    out += "<tr><td>" + spaced(model::name(position)) + " <span class=\"soft\">" + std::string(meaning(position)) +
           "</span></td><td class=\"n\">" + with_thousands(c.positions[k]) + "</td><td class=\"n soft\">" +
           percent(c.positions[k], all) + "</td></tr>\n";
  }
  return out + "</tbody></table>\n";
}

}  // namespace

bool has_context(const ReportFacts& f) {
  const ContextFacts& c = f.context;
  const auto any = [](const auto& counts, std::size_t first) {
    return std::any_of(counts.begin() + static_cast<std::ptrdiff_t>(first), counts.end(),
                       [](std::uint64_t n) { return n > 0; });
  };
  return !c.repair.empty() || c.plan || any(c.edges, 0) || any(c.positions, 1);
}

std::string context_section(const ReportFacts& f) {
  if (!has_context(f)) return {};
  const ContextFacts& c = f.context;
  std::string out =
      "<section id=\"context\">\n<h2>Footprints and context</h2>\n<p>Outlines are drawn by many hands: repair makes "
      "walls of "
      "neighbours one and almost right corners right. Then each stretch of an outline is told by what it faces. The "
      "GeoPackage "
      "has all of it as layers: <code>facade_edges</code>, <code>blocks</code>, <code>courtyards</code>, "
      "<code>cells</code>.</p>\n";
  out += plan_figure(c);
  if (!c.repair.empty()) {
    out += "<div class=\"pair\"><div>\n<h3>What repair did</h3>\n<table class=\"repair\"><tbody>\n";
    for (const auto& [label, value] : c.repair)
      out += "<tr><td>" + escaped(label) + "</td><td class=\"n\">" + escaped(value) + "</td></tr>\n";
    out += "</tbody></table></div>\n<div>" + position_table(c) + "</div></div>\n";
  } else {
    out += position_table(c);
  }
  return out + edge_table(c) + "</section>\n";
}

}  // namespace blockrand::outputs
