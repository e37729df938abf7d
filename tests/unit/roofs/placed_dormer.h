// A dormer at a place that a test names, where its distances leave room for it; builds lay theirs out first.
#pragma once

#include <span>
#include <vector>

#include "styles/roofs/dormers.h"
#include "styles/roofs/element_layout.h"

namespace blockrand::roofs {

/// \return false, and the roof as it was, when the surface takes no dormers or this one does not fit there
inline bool add_dormer(Roof& roof, std::size_t surface, const DormerParameters& parameters, model::Point2 place,
                       std::span<const model::RoofEdge> edges = {}, const ElementDistances& distances = {}) {
  const auto plane = roof_slope(roof, surface, edges);
  if (!plane) return false;
  std::vector<model::Point2> outline = dormer_outline(*plane, parameters);
  for (model::Point2& p : outline) p = {p.x + place.x, p.y + place.y};
  return fits(*plane, outline, distances) && add_laid_out_dormer(roof, *plane, parameters, place);
}

}  // namespace blockrand::roofs
