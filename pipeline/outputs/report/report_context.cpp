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

std::uint64_t sum_of(const auto& counts) {
  std::uint64_t all = 0;
  for (const std::uint64_t n : counts) all += n;
  return all;
}

Values plan_values(const ContextFacts& c) {
  Values v;
  std::string png;
  append_base64(png, c.plan->png);
  v.set("note", c.plan_note).set("caption", c.plan->caption).set("png", std::move(png));
  v.set("width", std::to_string(c.plan->width)).set("height", std::to_string(c.plan->height));
  for (int k = 0; k < model::kWallSegmentKindCount; ++k) {
    const auto kind = static_cast<model::WallSegmentKind>((k + 1) % model::kWallSegmentKindCount);  // unknown last
    if (kind == model::WallSegmentKind::unknown && c.edges[0] == 0) continue;
    v.add("key", Values().set("colour", model::text(model::colour_of(kind))).set("name", spaced(model::name(kind))));
  }
  return v;
}

Values edge_values(const ContextFacts& c) {
  Values v;
  double length = 0;
  for (const double l : c.edge_length) length += l;
  for (std::size_t i = 0; i < c.edges.size(); ++i) {
    const std::size_t k = (i + 1) % c.edges.size();
    if (c.edges[k] == 0) continue;
    const auto kind = static_cast<model::WallSegmentKind>(k);
    Values row;
    row.set("colour", model::text(model::colour_of(kind))).set("name", spaced(model::name(kind)));
    row.set("meaning", model::meaning(kind)).set("count", with_thousands(c.edges[k]));
    row.set("length", rounded(c.edge_length[k]));
    row.set("share",
            percent(static_cast<std::uint64_t>(c.edge_length[k] + 0.5), static_cast<std::uint64_t>(length + 0.5)));
    v.add("rows", std::move(row));
  }
  return v;
}

Values position_values(const ContextFacts& c) {
  Values v;
  for (std::size_t i = 0; i < c.positions.size(); ++i) {
    const std::size_t k = (i + 1) % c.positions.size();
    if (c.positions[k] == 0) continue;
    const auto position = static_cast<model::BuildingPosition>(k);
    Values row;
    row.set("name", spaced(model::name(position))).set("meaning", meaning(position));
    row.set("count", with_thousands(c.positions[k])).set("share", percent(c.positions[k], sum_of(c.positions)));
    v.add("rows", std::move(row));
  }
  return v;
}

}  // namespace

std::optional<Values> context_values(const ReportFacts& f) {
  const ContextFacts& c = f.context;
  const bool edges = sum_of(c.edges) > 0, positions = sum_of(c.positions) > c.positions[0];
  if (c.repair.empty() && !c.plan && !edges && !positions) return std::nullopt;
  Values v;
  const auto add = [&](std::string_view name, bool there, auto make) {
    if (there)
      v.add(name, make());
    else
      v.set(name, false);
  };
  add("plan", c.plan.has_value(), [&] { return plan_values(c); });
  add("repair", !c.repair.empty(), [&] {
    Values repair;
    for (const auto& [label, value] : c.repair) repair.add("rows", Values().set("label", label).set("value", value));
    return repair;
  });
  add("positions", positions, [&] { return position_values(c); });
  add("edges", edges, [&] { return edge_values(c); });
  return v;
}

}  // namespace blockrand::outputs
