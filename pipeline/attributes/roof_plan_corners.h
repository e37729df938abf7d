// Corners of one part of a building on the straightened wall of another.
#pragma once

#include <vector>

#include "pipeline/model/building.h"

namespace blockrand::attributes {

/// Moves corners of roof plans that lie just inside another part's wall onto that wall, or to the first grid point
/// outside of it, so that the bodies which stand on these plans share no room. Plans of parts share their walls exactly;
/// a roof plan has lost the points that bend a wall by less than `tolerance`, and the other part's corner there then
/// lies inside by as much. A corner that several parts have moves in all of them. Plans that would not be simple any
/// more stay as they are. Parts whose plans share more than 0.1 m², or half of the smaller, stand one above the other: they are not in each other's
/// way.
/// \param parts      with plan and roof_plan, both or neither empty
/// \param tolerance  m, as of the points that were left out
/// Cost: corners times walls of parts whose boxes meet.
void keep_corners_out(std::vector<model::BuildingPart>& parts, double tolerance);

}  // namespace blockrand::attributes
