// Walls around flat roofs.
#pragma once

#include <span>
#include <vector>

#include "pipeline/model/polygon.h"
#include "pipeline/model/roof_line.h"
#include "styles/roofs/plan_cells.h"
#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// Measures of parapets: a wall of height h and width b on all edges without a connection
/// (docs/sources.md, Finkenzeller 3.4.1).
struct ParapetOptions {
  double height = 0.50;          ///< m above the roof. 0.4 to 0.6 on houses of today (docs/style_measures.md 2.3, [K]).
  double width = 0.30;           ///< m, inwards from the wall's face: a wall with its insulation [P].
  double party_wall_height = 0;  ///< m, on party walls; 0 leaves them open: the edge where a neighbour attaches
                                 ///< (docs/sources.md, Finkenzeller 3.4.1).
  double least_length = 0.10;    ///< m. Shorter stretches between open ends have none.
  bool on_gables = false;        ///< also where a deck ends in a gable: there the verge runs through [P]
  bool around_decks = false;     ///< also where a deck's edge is the break of a sloped roof, not a wall
};

/// Parapets on all level surfaces of a roof, along their borders on the walls: a closed ring body (with a hole) where
/// all of the border has one, else a body for each run. Mitred at corners, cut along the next wall at open ends. Where
/// the roof is narrower than two widths, both become one. `asked` counts borders of level surfaces on plan edges.
/// \param edges  one per plan edge, ring by ring; empty for all open
/// \param bare  one per plan edge: true where something else stands on it; empty for none
/// \param keep_clear  convex pieces of the plan (counter-clockwise) where other things stand: firewalls, gables.
/// Parapets end
///                    before them.
BuiltElements parapets(const model::Polygon& plan, const Roof& roof, std::span<const model::RoofEdge> edges,
                       const std::vector<bool>& bare, std::span<const std::vector<model::Point2>> keep_clear,
                       const ParapetOptions& options = {});

}  // namespace blockrand::roofs
