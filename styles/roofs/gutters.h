// Gutters before eaves and the pipes that lead their water down.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "styles/roofs/overhangs.h"
#include "styles/roofs/plan_cells.h"

namespace blockrand::roofs {

/// Measures, m.
struct GutterOptions {
  double width = 0.12;       ///< of a half-round gutter of nominal size 250 to 333 (DIN EN 612:2005): 0.105 to 0.153
  double depth = 0.08;       ///< at the board
  double below_roof = 0.02;  ///< its rim under the upper side of the roof's edge
  double board = 0.18;       ///< height of the eaves' board (OverhangOptions::thickness): pipes end below the soffit
  double pipe = 0.09;        ///< side of a downpipe: nominal 80 to 100 (DIN EN 612:2005)
  double pipe_off = 0.04;    ///< between wall and downpipe: clips; courses that stand out farther run into the pipe
  double least_run = 1.5;    ///< shorter gutters have no pipe of their own
  double from_end = 0.20;    ///< middle of the pipe from the end of the wall
  double most_to_pipe = 15;  ///< of gutter that comes together before a pipe (DIN 1986-100: about 150 m² of roof to a
                             ///< pipe of 100)
};

/// Says whether a pipe may come down a wall.
/// \param foot   where it would stand: a point of the wall's line
/// \param along  unit vector along the wall
/// \param half   m: half of the pipe's width
using MayComeDown = std::function<bool(model::Point2 foot, model::Point2 along, double half)>;

/// Gutters along the lines of `before.eaves`, joined at corners; pipes from them to z = `bottom`, at the ends of runs where `may` agrees.
/// Kinds gutter and downpipe. A gutter stands before the eaves' board and touches it; a pipe touches nothing.
/// `asked` counts lines, `refused` those without a valid body.
/// \param may  empty: no pipes at all
BuiltElements gutters(const BuiltOverhangs& before, double bottom, const MayComeDown& may,
                      const GutterOptions& options = {});

}  // namespace blockrand::roofs
