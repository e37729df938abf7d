// Corners of one part of a building on the straightened wall of another.
#pragma once

#include <vector>

#include "pipeline/model/building.h"

namespace blockrand::attributes {

/// Moves corners of roof plans that lie just inside another part's wall onto that wall, or to the first grid point
/// outside of it, so that the bodies which stand on these plans share no room. Plans of parts share their walls exactly;
/// a roof plan has lost the points that bend a wall by less than `tolerance`, and the other part's corner there then
/// lies inside by as much. A corner that several parts have moves in all of them. Plans that would not be simple any
/// more stay as they are.
/// \param parts      with roof_plan; none of them may be empty but where `plan` is
/// \param tolerance  m, as of the points that were left out
/// \return parts that still meet inside, ascending, but for pairs one above the other: a corner between two straightened
///         walls may find no place outside of both
/// Cost: corners times walls of parts whose boxes meet.
std::vector<std::size_t> keep_corners_out(std::vector<model::BuildingPart>& parts, double tolerance);

/// Makes roof plans of plans: without the points that bend a wall by less than `tolerance`, corners kept out of each
/// other (keep_corners_out). For parts for which that finds no place, a quarter of the tolerance is tried, and so on down
/// to two grid steps and, where no edge is shorter than these, the plan itself: plans share their walls exactly.
void make_roof_plans(std::vector<model::BuildingPart>& parts, double tolerance);

}  // namespace blockrand::attributes
