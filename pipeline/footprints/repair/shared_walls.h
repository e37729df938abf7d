// Walls of neighbours become one wall: the topology of a row.
#pragma once

#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair/terrace_row.h"

namespace blockrand::repair {

/// The topology of a row: which corners of its footprints are one, and where walls end in the middle of others.
///
/// Corners on the same point, and corners at the same end of a wall that two footprints share (contacts.h) are one
/// corner, the nearest pairs first; never two corners of one polygon, of different levels, of two sides of an alley,
/// nor any whose mean lies more than 90 % of `max_shift` from what one of them says. Where a shared wall ends in the
/// middle of the neighbour's, the corner is put into the neighbour's wall.
/// `Corner::start` is the mean of the places where footprints have it, each once, moved so that the pieces of a wall lie in one line where
/// `max_shift` allows (least squares over the wall's ends and what ends on it). `position` is the same.
/// With `share_walls` off, or in a row of one, every corner is its footprint's own.
///
/// Requires buildings by id with strictly simple polygons. The result does not depend on where a ring starts.
/// Cost O(n log n) in edges.
TerraceGraph build_terrace_graph(const TerraceRow& row, const RepairOptions& options);

}  // namespace blockrand::repair
