// The account of what stands around houses in a build in areas: an object that comes into several areas counts once.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "pipeline/model/extract.h"
#include "pipeline/model/region.h"
#include "pipeline/surroundings/account.h"

namespace blockrand::run {

/// Whether an area tells of a feature that no tile had to do with: it begins there. \param placeless  it tells of what has no place
std::function<bool(const model::Feature&)> begins_in(const model::Extract& extract, const model::TileId& area,
                                                     bool placeless);

/// Of what an area tells, that which other areas may tell of as well: it reaches out of the area, or nearly.
std::vector<surroundings::SharedOutcome> shared_outcomes(const surroundings::SurroundingAccount& account,
                                                         const model::Extract& extract, const model::TileId& area);

/// As an area's run.json keeps them for the next night.
nlohmann::ordered_json shared_json(const std::vector<surroundings::SharedOutcome>& outcomes);
/// \returns  false where it is something else
bool read_shared(const nlohmann::ordered_json& json, std::vector<surroundings::SharedOutcome>& out);

/// By kind: how many are in each state, without zeros.
nlohmann::ordered_json surroundings_json(const surroundings::SurroundingCounts& counts);

/// Counts of all areas and what they share, as counts of the whole.
/// \param sum  of surroundings_json of the areas; becomes that of the whole
void settle_surroundings(const std::vector<surroundings::SharedOutcome>& shared, nlohmann::ordered_json& sum);

}  // namespace blockrand::run
