#include "pipeline/footprints/repair/repair_terrace_row.h"

#include <algorithm>
#include <numeric>

#include "pipeline/footprints/repair/arcs.h"
#include "pipeline/footprints/repair/ground_overlaps.h"
#include "pipeline/footprints/repair/shared_walls.h"
#include "pipeline/footprints/repair/square.h"
#include "pipeline/footprints/repair/terrace_graph.h"
#include "pipeline/footprints/repair/terrace_records.h"

namespace blockrand::repair {

namespace {

void repair_sorted_terrace_row(TerraceRow& row, const RepairOptions& options, model::Report& report) {
  std::vector<std::vector<model::Polygon>> mapped;
  if (row.buildings.size() > 1)
    for (const TerraceBuilding& b : row.buildings) mapped.push_back(b.polygons);
  TerraceGraph graph = build_terrace_graph(row, options);
  std::vector<double> direction(row.buildings.size(), -1);
  if (options.square) square_terrace_row(graph, row, options, direction);
  std::vector<std::vector<SaidPoint>> said;
  apply_terrace_graph(graph, row, options, report, said);
  if (options.resolve_overlaps) resolve_overlaps(row, options, report);
  record_walls(row, mapped, said, report);
  for (std::size_t b = 0; b < row.buildings.size(); ++b) {
    row.buildings[b].record.direction = direction[b];
    if (options.arcs) row.buildings[b].arcs = find_arcs(row.buildings[b].polygons);
  }
}

}  // namespace

void repair_terrace_row(TerraceRow& row, const RepairOptions& options, model::Report& report) {
  std::vector<std::size_t> order(row.buildings.size());
  std::iota(order.begin(), order.end(), 0);
  const auto by_id = [&](std::size_t a, std::size_t b) { return row.buildings[a].id < row.buildings[b].id; };
  if (std::is_sorted(order.begin(), order.end(), by_id)) {
    repair_sorted_terrace_row(row, options, report);
    return;
  }
  std::stable_sort(order.begin(), order.end(), by_id);
  std::vector<TerraceBuilding> buildings(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) buildings[i] = std::move(row.buildings[order[i]]);
  row.buildings = std::move(buildings);
  repair_sorted_terrace_row(row, options, report);
  buildings.assign(order.size(), {});
  for (std::size_t i = 0; i < order.size(); ++i) buildings[order[i]] = std::move(row.buildings[i]);
  row.buildings = std::move(buildings);
}

}  // namespace blockrand::repair
