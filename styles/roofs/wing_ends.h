// Where the wings of a plan end: the edges that can carry gables.
#pragma once

#include <cstdint>
#include <vector>

#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// A side of a plan with the corners before and after it.
struct PlanSide {
  model::Point2 from, to, before, after;
  double length = 0;  ///< m
  /// Unit vectors; nothing of an edge without length.
  model::Point2 along() const {
    return length > 0 ? model::Point2{(to.x - from.x) / length, (to.y - from.y) / length} : model::Point2{};
  }
  model::Point2 outwards() const { return {along().y, -along().x}; }
};

/// All edges, ring by ring, outer ring first.
std::vector<PlanSide> plan_sides(const model::Polygon& plan);

/// True for plans that fill enough of their convex hull to be one wing: the axis tells where its ridge runs.
bool is_one_wing(const model::Polygon& plan);

/// Unit vector along which the ridge of such a plan runs: the longer side of the smallest rectangle around it, turned
/// by roof:orientation=across or a roof:direction that runs more along than across.
model::Point2 ridge_axis(const model::Polygon& plan, const RoofRequest& request);

/// The end of a plan that is one wing in the direction `towards` (a unit vector): the edge of the outer ring that looks
/// most that way, and the others in the last quarter of the plan that do.
std::vector<std::uint32_t> ends_towards(const model::Polygon& plan, const std::vector<PlanSide>& edges,
                                        model::Point2 towards);

/// Edges that are the ends of wings (docs/roofs.md), in rising order; edges are numbered ring by ring. Of a plan that
/// stands free: RoofRequest::edges is not read.
std::vector<std::uint32_t> wing_ends(const model::Polygon& plan, const RoofRequest& request);

}  // namespace blockrand::roofs
