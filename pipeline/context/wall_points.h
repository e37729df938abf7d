// Which wall entrances and trees belong to.
#pragma once

#include <vector>

#include "pipeline/context/edge_contacts.h"
#include "pipeline/model/building.h"

namespace blockrand::context {

/// m. Entrances are nodes of the outline, or were meant to be.
inline constexpr double kEntranceReach = 1;
/// m. Trees farther from a facade neither hide it nor stand before it.
inline constexpr double kTreeReach = 15;

/// Counts the entrances of each stretch of `building.edges`, and lists the trees before the building by id.
///
/// An entrance belongs to the nearest stretch within kEntranceReach, party walls apart. Where several are as near (a corner,
/// a node between two walls) streets come before passages, courtyards, sides, then the longer stretch, then the earlier.
/// A tree belongs to the nearest stretch within kTreeReach that is no party wall and has it in front, not behind.
void assign_points(model::Building& building, const std::vector<OutlineEdge>& outline, const SurroundingsIndex& surroundings);

}  // namespace blockrand::context
