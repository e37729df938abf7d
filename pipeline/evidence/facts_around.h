// What stands around a building: the half of its measurements that reads those of its neighbours.
#pragma once

#include <cstddef>
#include <vector>

#include "pipeline/base/pack.h"
#include "pipeline/evidence/building_facts.h"

namespace blockrand::evidence {

/// One of the values, which must not be empty: that with `share` of the others below it. Sorts them.
double quantile(std::vector<double>& values, double share);

/// Everything that is read; outlives the calls.
struct AroundInputs {
  const FactsExtract& facts;  ///< every building measured alone
  const footprints::FootprintStore& store;
  const context::ContextExtract& context;
  const PlaceIndex& houses;  ///< BuildingPlace::house
  const PlaceIndex& small;   ///< other buildings that are no canopies
};

/// Features of the buildings `first` to `last` - 1, with those of the group `around`, of rows and streets filled in. Safe for
/// several runs at a time. Reach: kNearReach.
std::vector<classify::FeatureVector> measured_around(const AroundInputs& in, std::size_t first, std::size_t last);

/// What that reads, and nothing that numbers buildings in this run alone: their own, and all with their middle within the reach
/// of the box of theirs.
void pack_around(const AroundInputs& in, std::size_t first, std::size_t last, base::Packer& out);

}  // namespace blockrand::evidence
