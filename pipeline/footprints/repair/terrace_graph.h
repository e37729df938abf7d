// From the topology of a row back to footprints, valid ones.
#pragma once

#include <vector>

#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair/terrace_row.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

/// Where a vertex of a footprint ended, and where it was mapped. Metres.
struct SaidPoint {
  model::Point2 at, said;
  friend auto operator<=>(const SaidPoint&, const SaidPoint&) = default;
};

/// Writes the corners' positions back into the footprints of `row`, rounded to the grid, and fills moved, mean_shift and
/// max_shift of their records (of what each footprint said itself; corners put into its walls do not count).
///
/// Every footprint is checked: strictly simple, area changed by no more than `max_area_change`, no corner farther than
/// `max_shift` from what it said (but for the rounding). Where it fails, first the corners concerned go back to `start`,
/// then all of the building's, then the corners concerned are split off to where the footprint said, then all
/// (SHARED_WALL_CONFLICT; REPAIR_BOUNDED when nothing is left of the repair). Neighbours are checked again until nothing
/// changes: at worst a footprint is exactly as it came. Vertices keep their node; corners put into a wall have node 0.
/// `graph` ends as it was written.
/// \param[out] said  for each building, what its vertices said; sorted
void apply_terrace_graph(TerraceGraph& graph, TerraceRow& row, const RepairOptions& options, model::Report& report,
                         std::vector<std::vector<SaidPoint>>& said);

}  // namespace blockrand::repair
