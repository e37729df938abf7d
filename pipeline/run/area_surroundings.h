// The account of what stands around houses in a build in areas: an object that comes into several areas counts once.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/model/extract.h"
#include "pipeline/run/area_record.h"
#include "pipeline/surroundings/account.h"

namespace blockrand::run {

/// Whether an area tells of a feature that no tile had to do with: it begins there. \param placeless  it tells of what has no place
bool begins_in(const model::Extract& extract, const model::Feature& feature, const model::TileId& area, bool placeless);

/// What an area records of a feature; nothing of what its surroundings do not tell of. What it is made from outlives it.
std::function<std::optional<RecordedThing>(const model::Feature&)> thing_recorder(
    const model::Extract& extract, const surroundings::Catalogue& catalogue,
    const surroundings::SurroundingOptions& layers, const model::TileId& area);

/// What no tile of an area had to do with is told as well. \param things  that begin in the area, by id
/// \return  of what the area tells that which other areas may tell of: it reaches out of the area, or nearly
std::vector<surroundings::SharedOutcome> close_surroundings(std::span<const RecordedThing> things,
                                                            surroundings::SurroundingAccount& account);

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
