// What one ring can be rid of without changing its shape: repeated points, spikes, points on straight walls.
#pragma once

#include <optional>

#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair/options.h"
#include "pipeline/model/polygon.h"

namespace blockrand::repair {

struct RingCleaning {
  int duplicates = 0;  ///< points removed because they repeat their predecessor
  int spikes = 0;      ///< tips removed
  int rounds = 1;      ///< how often the ring was given round; one round stays
};

/// Removes points nearer than `duplicate_distance` to their predecessor (of such a pair a kept node stays), and spikes:
/// corners where the ring turns back so that the shorter leg's end lies within `spike_width` of the longer leg, or
/// edges no longer than `spike_width` with such legs on both sides. Repeats until nothing changes. A ring that runs
/// round several times is taken once. A ring may end with fewer than three points; it has no area then. The result does
/// not depend on where the ring starts, nor does it start where the ring did; a clean ring stays as it is.
/// Cost O(n) for clean rings.
RingCleaning clean_ring(model::Ring& ring, const KeptNodes& kept, const RepairOptions& options);

/// The ring without the points of straight walls: drops them, the flattest first, so that every dropped point is nearer
/// than `collinear_distance` to the edge that runs past it afterwards. Kept nodes stay, and so do the points of curves:
/// where three or more corners in sequence turn the same way, none sharply, by 30 degrees or more together, points that
/// bulge out between them the same way. At least three points stay. The result does not depend on where the ring
/// starts. The ring may cross itself afterwards where it came within that distance of itself before.
/// \return the ring without them; nothing where no point was dropped
std::optional<model::Ring> without_collinear_points(const model::Ring& ring, const KeptNodes& kept,
                                                    const RepairOptions& options);

/// Turns the list of points so that it starts at the least point (by x, then y; of equal ones the one whose successors
/// are less): one list for one ring.
void start_at_least_point(model::Ring& ring);

}  // namespace blockrand::repair
