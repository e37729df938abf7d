#include "pipeline/repair/repair.h"

#include "pipeline/repair/parts.h"
#include "pipeline/repair/rings.h"

namespace blockrand::repair {

namespace {

using model::Building;
using model::Polygon;
using model::Region;
using model::Ring;

void note_edges(Building& building) {
  building.edges.clear();
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      model::FacadeEdge edge;
      edge.from_node = ring.nodes[i];
      edge.to_node = ring.nodes[(i + 1) % ring.size()];
      building.edges.push_back(edge);
    }
  };
  for (const Polygon& polygon : building.outline) {
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
  }
}

void repair_building(Building& building, const RepairOptions& options, Region& region) {
  model::Report& report = region.report;
  if (!building.rings.rings.empty()) {
    RepairedRings outline = repair_rings(std::move(building.rings), building.osm, {}, options, report);
    building.rings = {};
    building.outline = std::move(outline.polygons);
    building.failure = outline.failure;
    note_edges(building);
  }
  const std::vector<Polygon> before = building.outline;
  fit_parts(building, before, {}, options, region.part_failures, report);
}

}  // namespace

void repair(Region& region, const RepairOptions& given) {
  // Which nodes neighbours share is not known here; without that no point of a wall may go.
  RepairOptions options = given;
  options.simplify = false;
  for (Building& building : region.buildings) repair_building(building, options, region);
}

}  // namespace blockrand::repair
