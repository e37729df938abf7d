// Which wall entrances, addresses, shops and trees belong to.
#pragma once

#include <vector>

#include "pipeline/context/wall_contacts.h"
#include "pipeline/model/building.h"

namespace blockrand::context {

/// m. Trees farther from a facade neither hide it nor stand before it.
inline constexpr double kTreeReach = 15;

/// Fills the points and counts the entrances of each wall segment of `building.edges`, and lists the trees before the building
/// by id.
///
/// An entrance or an address node with a house number belongs to one building at most (owner_of, point_owner.h), and there
/// to the nearest wall segment within kEntranceReach, party walls apart. Where several are as near (a corner, a node between
/// two walls) one at the street of its address comes first, then streets, passages, courtyards, sides, then the longer
/// wall segment, then the earlier. A house number deeper within belongs to the nearest wall segment at the street of its address;
/// without one to the nearest street front; without one to the nearest wall segment. Shops likewise: they are mapped in the
/// middle of their rooms. What is behind the wall (SitePoint::use) is kept with the point.
/// A tree belongs to the nearest wall segment within kTreeReach that is no party wall and has it in front, not behind.
void assign_points(model::Building& building, const std::vector<OutlineEdge>& outline, const VicinityIndex& vicinity,
                   const WallSegmentOptions& options = {});

}  // namespace blockrand::context
