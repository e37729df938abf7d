// What repair did to the footprints of a row, in figures.
#pragma once

#include <vector>

#include "pipeline/footprints/repair/terrace_graph.h"
#include "pipeline/footprints/repair/terrace_row.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

/// Fills vertices, area, shared_walls and gaps_closed of the records: a shared wall is a maximal chain of edges that one
/// neighbour at the same level has point for point; a closed gap is one of them where a corner of either footprint was
/// mapped more than 2 cm off the other's boundary (SHARED_WALL_MADE).
/// \param mapped  the buildings' polygons before repair, as many as the row has buildings
/// \param said    from apply_terrace_graph
void record_walls(TerraceRow& row, const std::vector<std::vector<model::Polygon>>& mapped,
                  const std::vector<std::vector<SaidPoint>>& said, model::Report& report);

}  // namespace blockrand::repair
