#include "pipeline/picture/building_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "pipeline/geometry/wall_segment.h"
#include "pipeline/model/wall_segment_colours.h"

namespace blockrand::picture {
namespace {

using model::Point2;
using model::WallSegmentKind;

constexpr double kEdgeWidth = 1.1;   // m: walls of neighbours stay apart
constexpr double kLeastWidth = 2.0;  // pixels: thinner lines lose their colour
constexpr double kBlockWidth = 1.3;  // pixels

/// A strip along the wall segment, in its building.
model::Polygon strip(const PlanEdge& e, double width) {
  const double dx = e.to.x - e.from.x, dy = e.to.y - e.from.y, length = std::sqrt(dx * dx + dy * dy);
  const Point2 n{-dy / length * width, dx / length * width};
  model::Polygon p;
  p.outer.points = {e.from, e.to, {e.to.x + n.x, e.to.y + n.y}, {e.from.x + n.x, e.from.y + n.y}};
  return p;
}

}  // namespace

PlanTile plan_tile(const model::Region& region) {
  PlanTile tile;
  for (const model::Building& b : region.buildings) {
    if (!b.owned || b.parts.empty()) continue;
    tile.buildings.insert(tile.buildings.end(), b.outline.begin(), b.outline.end());
    if (b.outline.empty())
      for (const model::BuildingPart& part : b.parts) tile.buildings.push_back(part.plan);
    for (const model::WallSegment& e : b.edges)
      if (const auto ends = geometry::ends_of(b, e)) tile.edges.push_back({ends->from, ends->to, e.kind});
  }
  return tile;
}

PlanBox box_of(std::span<const PlanTile> tiles, double margin) {
  PlanBox box;
  bool empty = true;
  for (const PlanTile& tile : tiles)
    for (const model::Polygon& polygon : tile.buildings)
      for (const Point2 p : polygon.outer.points) {
        if (empty) box = {p.x, p.y, p.x, p.y};
        empty = false;
        box = {std::min(box.min_x, p.x), std::min(box.min_y, p.y), std::max(box.max_x, p.x), std::max(box.max_y, p.y)};
      }
  if (empty) return box;
  return {box.min_x - margin, box.min_y - margin, box.max_x + margin, box.max_y + margin};
}

void draw(Plan& plan, std::span<const PlanTile> tiles) {
  const auto each = [&](auto member, const auto& paint) {
    for (const PlanTile& tile : tiles)
      for (const auto& thing : tile.*member) paint(thing);
  };
  each(&PlanTile::streets, [&](const PlanStreet& s) { plan.stroke(s.line, s.width, kPlanStreet); });
  each(&PlanTile::courtyards, [&](const model::Polygon& p) { plan.fill(p, kPlanCourtyard); });
  each(&PlanTile::buildings, [&](const model::Polygon& p) { plan.fill(p, kPlanBuilding); });
  each(&PlanTile::blocks, [&](const model::Polygon& p) {
    plan.stroke(p.outer.points, kBlockWidth * plan.metres_per_pixel(), kPlanBlock, true);
    for (const model::Ring& hole : p.holes)
      plan.stroke(hole.points, kBlockWidth * plan.metres_per_pixel(), kPlanBlock, true);
  });
  const double width = std::max(kEdgeWidth, kLeastWidth * plan.metres_per_pixel());
  // Unknown ones first: at corners what is known is over them. Party walls last, as they are between two buildings.
  for (const WallSegmentKind kind : {WallSegmentKind::unknown, WallSegmentKind::side, WallSegmentKind::courtyard,
                                     WallSegmentKind::street, WallSegmentKind::passage, WallSegmentKind::party_wall})
    each(&PlanTile::edges, [&](const PlanEdge& e) {
      if (e.kind == kind) plan.fill(strip(e, width), model::colour_of(kind));
    });
}

std::vector<LegendEntry> legend_of(std::span<const PlanTile> tiles, const PlanBox& box) {
  const auto meets = [&](std::span<const Point2> points) {
    PlanBox of{1e300, 1e300, -1e300, -1e300};
    for (const Point2 p : points)
      of = {std::min(of.min_x, p.x), std::min(of.min_y, p.y), std::max(of.max_x, p.x), std::max(of.max_y, p.y)};
    return of.min_x < box.max_x && of.max_x > box.min_x && of.min_y < box.max_y && of.max_y > box.min_y;
  };
  std::array<bool, model::kWallSegmentKindCount> walls{};
  bool buildings = false, courtyards = false, blocks = false, streets = false;
  const auto any = [&](const std::vector<model::Polygon>& polygons) {
    return std::ranges::any_of(polygons, [&](const model::Polygon& p) { return meets(p.outer.points); });
  };
  for (const PlanTile& tile : tiles) {
    for (const PlanEdge& e : tile.edges)
      if (bool& seen = walls[static_cast<std::size_t>(e.kind)]; !seen) seen = meets(std::array{e.from, e.to});
    buildings = buildings || any(tile.buildings);
    courtyards = courtyards || any(tile.courtyards);
    blocks = blocks || any(tile.blocks);
    streets = streets || std::ranges::any_of(tile.streets, [&](const PlanStreet& s) { return meets(s.line); });
  }
  std::vector<LegendEntry> out;
  for (int k = 0; k < model::kWallSegmentKindCount; ++k) {
    const auto kind = static_cast<WallSegmentKind>((k + 1) % model::kWallSegmentKindCount);  // unknown last
    if (walls[static_cast<std::size_t>(kind)])
      out.push_back({model::colour_of(kind), "Wall: " + std::string(model::short_meaning(kind)), LegendSign::line});
  }
  if (buildings) out.push_back({kPlanBuilding, "Building", LegendSign::area});
  if (courtyards) out.push_back({kPlanCourtyard, "Courtyard", LegendSign::area});
  if (streets) out.push_back({kPlanStreet, "Street", LegendSign::area});
  if (blocks) out.push_back({kPlanBlock, "Border of a block", LegendSign::thin_line});
  return out;
}

}  // namespace blockrand::picture
