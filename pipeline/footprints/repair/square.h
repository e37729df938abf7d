// Squaring: walls of a row get the few directions that it has.
#pragma once

#include <vector>

#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair/terrace_row.h"

namespace blockrand::repair {

/// Moves Corner::position, so that walls which are almost parallel or at right angles to what dominates their building
/// and its row (directions.h) become exactly so; one least squares problem per connected row.
///
/// Every corner stays as near as possible to what the footprints say (Corner::said, each with the same weight; `start`
/// with less where none does); walls with a direction have it exactly (to about 1e-6 m); pieces of one ring wall stay
/// in line; corners of a curve keep their differences softly. Walls of no frame, curves, bays and chamfers keep their
/// shape but follow what their ends do.
///
/// Guarantees: fixed corners stay; a corner ends within `max_shift` (less a grid step for rounding) of everything that
/// is said of it, or of where it starts if nothing is or that is farther off: walls that would need more lose their
/// direction. No edge turns back. Corners in whose neighbourhood nothing is squared keep their start exactly, and so
/// does every corner of a row that is already right (to 1e-6 m, twice OSM's noise of rounding aside). Does not depend
/// on the order of buildings or where rings start; turns with the row. Cost about linear in corners.
///
/// `direction`, one per building of the row: degrees [0, 90) clockwise from north of its main walls; -1 where no wall
/// was given a direction.
void square_terrace_row(TerraceGraph& graph, const TerraceRow& row, const RepairOptions& options,
                        std::vector<double>& direction);

}  // namespace blockrand::repair
