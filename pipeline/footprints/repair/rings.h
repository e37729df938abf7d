// Rings as mapped become valid polygons.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/footprints/repair/kept_nodes.h"
#include "pipeline/footprints/repair/options.h"
#include "pipeline/model/building.h"
#include "pipeline/model/polygon.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

struct RepairedRings {
  std::vector<model::Polygon> polygons;  ///< strictly simple, with no more than points in common; largest first
  model::IssueCode failure = model::IssueCode::none;  ///< TOO_FEW_POINTS or ZERO_AREA when there is no polygon
  double mapped_area = 0;  ///< m², of the rings as mapped by the even-odd rule, holes subtracted
};

/// Makes the rings of one object valid: repeated points and spikes removed (clean_ring), points of straight walls
/// dropped where `simplify` says so (without_collinear_points), self-intersections, holes outside, across or along the
/// outer ring mended by geometry::make_valid, slivers dropped, overlapping or touching outer rings united.
///
/// A ring that crosses itself more often than geometry::kMostCrossings becomes its convex hull, without holes.
/// A hole that leaves nothing of its building is ignored; one whose outer ring has no area vanishes with it. Every
/// polygon returned has passed geometry::strictly_simple. Rings start at their least point, and the result depends
/// neither on where they started nor on the order of holes; points that survive keep their nodes. A change of the area
/// by more than `max_ring_area_change` does not stop the repair, but the row says so.
/// Rows: DUPLICATE_POINTS, SPIKE_REMOVED, COLLINEAR_POINTS, RING_REPAIRED (with areas), TOUCHING_RINGS, SLIVER_DROPPED,
/// SPLIT_OUTLINE. Cost of clean rings: O(n log n), no call of GEOS.
RepairedRings repair_rings(model::MappedRings rings, model::OsmId id, const KeptNodes& kept,
                           const RepairOptions& options, model::Report& report);

/// True when the outer ring runs counter-clockwise and every hole clockwise. Where corners move, a hole that is narrower than
/// their way turns inside out without that any edges cross: strictly_simple() alone does not see it.
bool well_wound(const model::Polygon& polygon);

/// An area for report rows: "12.30 m2".
std::string square_metres(double area);

/// Gives points without node the node that the same point has in one of `from` (of several the least). Boolean
/// operations of geometry forget nodes of holes.
void restore_nodes(std::vector<model::Polygon>& polygons, std::span<const model::Polygon> from);

/// Cuts corners off polygons whose ground is taken from another that would touch itself there: what is left of that one
/// keeps a wall's width of its own ground, and needs none of a third one's. Nothing is done where the polygons would fall
/// apart or lose more than `min_overlap_area`. \param squares  geometry::ValidPolygons::squares of the difference
/// \return whether something was cut off
bool cut_corners(std::vector<model::Polygon>& polygons, std::span<const model::Polygon> squares,
                 const RepairOptions& options);

}  // namespace blockrand::repair
