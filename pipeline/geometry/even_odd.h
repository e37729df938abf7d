// What a ring encloses that crosses itself.
#pragma once

#include "pipeline/model/polygon.h"

namespace blockrand::geometry {

/// Crossings and touches per corner beyond which a ring is no drawing of a house any more. Figure eights, loops and slips of
/// the mouse have one or two in all; a scribble of n points has n²/4.
inline constexpr std::size_t kTangle = 4;

/// Crossings and touches beyond which nobody asks for the pieces of a scribble: to find them costs as much as there are
/// crossings, of which 2,000 random points have a million.
inline constexpr std::size_t kMostCrossings = 10000;

/// True for a ring of more than kMostCrossings crossings and touches. Cost: O(n log n) in corners, plus pairs of edges that
/// meet along x until so many are found.
bool hopeless(const model::Ring& ring);

/// True for a ring of more than kTangle crossings and touches per corner. Such rings are taken by ways whose cost grows with
/// the crossings alone, since no building may hold up a run.
bool tangled(const model::Ring& ring);

/// Area in m² of what the ring encloses by the even-odd rule: both loops of a figure eight count, in contrast to
/// signed_area, where they cancel out. Of a ring that runs twice round, once. 0 for rings of fewer than three points.
/// GEOS's noding decides, or, of tangled rings, tangled_area.
double even_odd_area(const model::Ring& ring);

/// The same to a hundredth of a grid step times the perimeter, by walking along the ring: at each crossing the side
/// changes on which the enclosed lies. Cost O(n log n) in corners, plus pairs of edges that meet along x, plus crossings.
double tangled_area(const model::Ring& ring);

/// The convex hull of the ring's points with their nodes (of equal points the least), counter-clockwise from the least point,
/// without points on its edges. Empty where all points lie on one line. Exact on the grid; Andrew, "Another efficient
/// algorithm for convex hulls in two dimensions" (1979). Cost O(n log n).
model::Ring convex_hull(const model::Ring& ring);

}  // namespace blockrand::geometry
