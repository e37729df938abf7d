// The level of detail that a building was read in.
#pragma once

#include <algorithm>
#include <vector>

#include "importers/reference/reference_model.h"

namespace blockrand::importers::reference::test {

/// Highest level of detail with a face; -1 without geometry.
inline int lod_of(const Building& building) {
  int highest = -1;
  const auto raise = [&](const std::vector<Geometry>& geometries) {
    for (const Geometry& g : geometries)
      if (!g.faces.empty()) highest = std::max(highest, g.lod);
  };
  raise(building.geometries);
  for (const Surface& s : building.surfaces) {
    raise(s.geometries);
    for (const Opening& o : s.openings) raise(o.geometries);
  }
  return highest;
}

}  // namespace blockrand::importers::reference::test
