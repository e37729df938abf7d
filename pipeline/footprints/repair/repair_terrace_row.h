// A terrace row of footprints repaired together.
#pragma once

#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair/terrace_row.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

/// Repairs the footprints of a row in place: walls of neighbours become one (shared_walls.h), almost right corners right
/// (square.h), the result is checked and written back (terrace_graph.h), ground that two claim is given to one of them
/// (ground_overlaps.h). Fills `arcs` and `record` (all but mapped_area, which the caller knows) of every building, and
/// adds rows to `report`: SHARED_WALL_MADE with the number of walls and the neighbours, SQUARED, OVERLAP_RESOLVED, ...
///
/// Requires strictly simple polygons on the 1/1024 m grid. Guarantees: polygons stay strictly simple; no corner moves
/// farther than `max_shift` (ground given to a neighbour aside); no building vanishes; what stays as mapped keeps its
/// exact points. The result does not depend on the order of buildings, nor on where rings start. Buildings are worked on in
/// the order of their ids and come back in the order they came.
/// Cost O(n log n) in edges.
void repair_terrace_row(TerraceRow& row, const RepairOptions& options, model::Report& report);

}  // namespace blockrand::repair
