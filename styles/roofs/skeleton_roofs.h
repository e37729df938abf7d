// Roofs that rise from the edges of any plan: hips, gables, mansards, decks.
#pragma once

#include <optional>
#include <vector>

#include "styles/roofs/roof.h"

namespace blockrand::roofs {

/// True for the shapes that docs/roofs.md makes by the weighted straight skeleton.
bool rises_from_edges(model::RoofShape shape);

/// True for plans that fill enough of their convex hull to be one wing: the axis tells where its ridge runs.
bool is_one_wing(const model::Polygon& plan);

/// Unit vector along which the ridge of such a plan runs: the longer side of the smallest rectangle around it, turned
/// by roof:orientation=across or a roof:direction that runs more along than across.
model::Point2 ridge_axis(const model::Polygon& plan, const RoofRequest& request);

/// One of those shapes on a plan. Where the plan has no end of a wing, gables are left out. Where the weighted skeleton
/// gives up, hips by CGAL's (SKELETON_FALLBACK); empty when that gives up as well.
std::optional<BuiltRoof> skeleton_roof(const model::Polygon& plan, const RoofRequest& request);

/// Domes and onions on plans that have no single apex: five pitches that follow a quarter of an ellipse over every
/// edge.
std::optional<BuiltRoof> vaulted_roof(const model::Polygon& plan, const RoofRequest& request);

/// Edges that are the ends of wings (docs/roofs.md), in rising order; edges are numbered ring by ring.
std::vector<std::uint32_t> wing_ends(const model::Polygon& plan, const RoofRequest& request);

}  // namespace blockrand::roofs
