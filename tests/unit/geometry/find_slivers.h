// All slivers of a ring, for tests that want to see none.
#pragma once

#include <optional>
#include <vector>

#include "pipeline/geometry/slivers.h"

namespace blockrand::geometry {

inline std::vector<Sliver> find_slivers(const model::Ring& ring, double width) {
  std::vector<Sliver> out;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (const std::optional<Sliver> sliver = sliver_from(ring, i, width)) out.push_back(*sliver);
  return out;
}

}  // namespace blockrand::geometry
