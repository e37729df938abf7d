#include "pipeline/picture/building_plan.h"

#include <algorithm>
#include <cmath>

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

}  // namespace blockrand::picture
