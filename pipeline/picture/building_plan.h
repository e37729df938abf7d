// The plan of a neighbourhood: what each wall segment of an outline faces, in colours.
#pragma once

#include <span>
#include <vector>

#include "pipeline/model/building.h"
#include "pipeline/model/region.h"
#include "pipeline/picture/plan.h"
#include "pipeline/picture/sheet.h"

namespace blockrand::picture {

/// A wall segment of an outline, the building on its left.
struct PlanEdge {
  model::Point2 from, to;  ///< m
  model::WallSegmentKind kind = model::WallSegmentKind::unknown;
};

struct PlanStreet {
  std::vector<model::Point2> line;  ///< m
  double width = 6;                 ///< m
};

/// What a plan shows of a tile: all that is kept of the tile when it is gone. Coordinates in metres, build CRS.
struct PlanTile {
  std::vector<model::Polygon> buildings;
  std::vector<PlanEdge> edges;
  // The caller adds what a tile's buildings do not say.
  std::vector<model::Polygon> blocks, courtyards;
  std::vector<PlanStreet> streets;
};

/// Outlines of the owned buildings (of parts, where a building has no outline) and their edges.
PlanTile plan_tile(const model::Region& region);

/// The box of the buildings of all tiles, `margin` metres wider; an empty box where there are none.
PlanBox box_of(std::span<const PlanTile> tiles, double margin = 20);

/// Draws tiles, in this order for all of them: streets, courtyards pale green, buildings light grey, borders of blocks as
/// thin lines, edges in the colours of model/wall_segment_colours.h along the inside of their walls.
void draw(Plan& plan, std::span<const PlanTile> tiles);

/// A legend of what draw() paints within a box, as it occurs: walls by what they face, then areas.
std::vector<LegendEntry> legend_of(std::span<const PlanTile> tiles, const PlanBox& box);

/// The colours of draw() besides those of edges, for legends.
inline constexpr model::Colour kPlanPaper{250, 249, 246}, kPlanStreet{237, 231, 214}, kPlanBuilding{220, 217, 213},
    kPlanCourtyard{226, 242, 222}, kPlanBlock{150, 120, 170};

}  // namespace blockrand::picture
