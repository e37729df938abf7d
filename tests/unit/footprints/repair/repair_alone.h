// Each building of a region repaired without its neighbours: what tests of later stages start from.
#pragma once

#include "pipeline/footprints/repair/parts.h"
#include "pipeline/footprints/repair/rings.h"
#include "pipeline/model/region.h"

namespace blockrand::repair::test {

inline void repair_alone(model::Region& region, const RepairOptions& given = {}) {
  // Which nodes neighbours share is not known here; without that no point of a wall may go.
  RepairOptions options = given;
  options.simplify = false;
  for (model::Building& building : region.buildings) {
    if (!building.rings.rings.empty()) {
      RepairedRings outline = repair_rings(std::move(building.rings), building.osm, {}, options, region.report);
      building.rings = {};
      building.outline = std::move(outline.polygons);
      building.failure = outline.failure;
    }
    const std::vector<model::Polygon> before = building.outline;
    fit_parts(building, before, {}, options, region.part_failures, region.settled_parts, region.report);
  }
}

}  // namespace blockrand::repair::test
