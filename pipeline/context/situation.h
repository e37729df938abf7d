// How a building stands to its street, its neighbours and its block.
#pragma once

#include <string_view>
#include <vector>

#include "pipeline/context/wall_contacts.h"
#include "pipeline/model/building.h"

namespace blockrand::context {

/// Marks, among `building.edges` (labelled, with streets), the ends at street corners and the chamfers that cut them off.
///
/// A street corner lies where two street wall segments that look at different streets follow each other and the outline turns
/// outwards by more than 30 degrees; also across a chamfer or a rounded corner, whose wall segments are no more than 8 m long
/// together (20 m along a curve of Building::arcs).
/// \param outline  edges_of(building.outline)
void mark_corners(model::Building& building, const std::vector<OutlineEdge>& outline);

/// Fills `building.situation` from the labelled edges.
///
/// The main front is that on the street of the address (the building's, else the one most address nodes on it name), else
/// the longest; streets are told apart by name. `fronts` begins with the wall segments of the main front, the longest first;
/// those on other streets follow. Position:
/// * corner_house: has a street corner (mark_corners);
/// * with a front: by the sides, left and right of it, that have party walls of more than 1.5 m: mid_row, end_of_row,
///   free_standing; neighbours below kOutbuildingArea do not count, walls at the rear count as one side;
/// * without a front: free_standing without party walls unless it stands at a courtyard; side_wing when it is long (1.5
///   times), no deeper than 12 m, has neighbours at an end and along at most one long side; rear_building else.
/// \param address_street  addr:street of the building, or empty
void describe_situation(model::Building& building, const std::vector<OutlineEdge>& outline,
                        const VicinityIndex& vicinity, std::string_view address_street);

}  // namespace blockrand::context
