// Which way a ridge runs where nobody mapped it: from party wall to party wall.
#pragma once

#include <span>
#include <vector>

#include "pipeline/model/building.h"
#include "pipeline/model/polygon.h"

namespace blockrand::generate {

/// A stretch of a plan's boundary at which a neighbour stands, from a to b along the ring.
struct WallStretch {
  model::Point2 a, b;
};

/// True when the ridge runs across the plan's longer side: neighbours stand at its long sides (at both, or at most of
/// one) and at none of its short sides, as at a deep house in a row, whose eaves face street and garden and whose
/// gables stand on the party walls. Of 252 gabled roofs of The Hague between two such neighbours 251 run so, of 82 with
/// one 64 (tests/bench/RESULTS.md, "Roofs against references"). Never for plans longer than `widest` m, which the
/// rafters would have to span.
bool ridge_runs_across(const model::Polygon& plan, std::span<const WallStretch> party_walls, double widest);

/// The party walls of a building that stand at one of its plans. Empty before context has labelled its edges.
std::vector<WallStretch> party_walls_at(const model::Building& building, const model::Polygon& plan);

}  // namespace blockrand::generate
