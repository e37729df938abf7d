// Eaves and verges: where the roof goes on beyond the wall.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "pipeline/model/polygon.h"
#include "pipeline/model/roof_line.h"
#include "styles/roofs/plan_cells.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// Measures of eaves and verges. A constant offset of the wall, never across party walls (docs/sources.md, Gunia 8.2).
struct OverhangOptions {
  double eaves = 0.40;      ///< m, horizontal. Eaves boards of houses after 1900: 0.3 to 0.6
                            ///< (docs/style_measures.md 2.5, [K]).
  double verge = 0.20;      ///< m, horizontal. Slight at the sides (docs/sources.md, Holtmeier 5.3); half of the eaves
                            ///< [P].
  double thickness = 0.18;  ///< m, upright: the height of the fascia board, rafters and tiles above it [P].
  double most_drop = 0.45;  ///< m. Steep slopes (mansards) go out no farther than they come down by this [P].
  double least = 0.05;      ///< m. What is shorter than that is none: a row of tiles.
  double before_eaves =
      0;  ///< m, horizontal: room that gutters take before eaves; 0: BuiltOverhangs::eaves stays empty
  double longest_mitre =
      3;  ///< times the overhang, from the corner: both ends are cut square beyond (corners below 39 degrees).
};

/// What limits the overhang of a plan edge.
struct OverhangRoom {
  model::RoofEdge edge = model::RoofEdge::open;  ///< party walls have none
  double room = 1e9;         ///< m to what stands before the wall, as far as the overhang may go; 0: none is asked for
  double gutter_room = 1e9;  ///< the same for the overhang with OverhangOptions::before_eaves
};

/// Where the eaves and verges on both sides of a point of the outline meet in one point: a hip or ridge goes on to
/// there.
struct OverhangCorner {
  model::Point3 inner, outer;   ///< m, of the upper side: on the wall; at the edge of the overhang
  model::Point2 before, after;  ///< unit vectors along the outer edge, in the ring's direction, before and after it
  double length_before = 0, length_after = 0;  ///< m, of the outer edges
};

/// An upper edge of an overhang over eaves: what a gutter hangs along.
struct EavesLine {
  model::Point3 from, to;            ///< m, of the upper side, in the ring's direction; both level but for rounding
  model::Point2 out_from, out_to;    ///< of what lies OverhangOptions::before_eaves farther out
  model::Point2 wall_from, wall_to;  ///< of the wall below
  model::Point2 along;               ///< unit vector
  double reach = 0;                  ///< m from the wall
  double steepness = 0;              ///< m up for each m towards the wall
  std::size_t strip = 0;             ///< into BuiltOverhangs::strips: its own
  bool joined_after = false;         ///< the next one begins where this one ends
};

struct BuiltOverhangs {
  BuiltElements elements;  ///< kinds eaves and verge; `asked` counts plan edges with room that are no party walls
  std::vector<OverhangCorner> corners;
  std::vector<std::pair<model::Point2, model::Point2>> walls;  ///< all plan edges, where `eaves` are asked for
  std::vector<std::vector<model::Point2>> strips;  ///< the plan of every overhang, where `eaves` are asked for
  std::vector<EavesLine>
      eaves;  ///< those that water comes down to, with OverhangOptions::before_eaves free before them, ring by ring
};

/// Continues the roof's surfaces in their planes beyond the walls: eaves where the upper end of a wall is level, verges
/// where it rises. Eaves and verges end in one another, at the ridge, at corners (mitred, outer and inner), square at
/// bare edges, and before the line of a party wall. Where two would meet (narrow courts, sharp inner corners) or one
/// would come into the building, both are halved until they do not, or left out. No body touches another or the
/// building but along its sides. \param rooms  one per plan edge, ring by ring; empty for all open
BuiltOverhangs overhangs(const model::Polygon& plan, const Roof& roof, std::span<const OverhangRoom> rooms,
                         const OverhangOptions& options = {});

}  // namespace blockrand::roofs
