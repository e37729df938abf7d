// What every reader of `validate` promises of what it read.
#pragma once

#include <cstdlib>

#include "pipeline/validate/contents.h"
#include "pipeline/validate/detail_check.h"
#include "pipeline/validate/solids.h"

namespace blockrand::fuzz {

/// Numbers point to what is there; solids and details can be judged.
inline void check_contents(const validate::Contents& contents) {
  std::size_t judged = 0;
  for (const validate::ReadBody& body : contents.bodies) {
    for (const validate::ReadSolid& solid : body.solids)
      for (const validate::ReadPolygon& polygon : solid.polygons)
        if (polygon.rings.empty()) std::abort();
    for (const validate::ReadPlacement& placement : body.detail.placements)
      if (contents.elements.find(placement.element) == contents.elements.end()) std::abort();
    validate::check_detail(body, [](const std::string&, const std::string&) {});
    if (!validate::detail_difference(body, body).empty()) std::abort();
    // Judging a solid takes longer than reading it.
    for (const validate::ReadSolid& solid : body.solids)
      if (++judged == 1 && solid.polygons.size() <= 20) (void)validate::validator(solid);
  }
}

}  // namespace blockrand::fuzz
