// What district rules let classification assume of a place before it looks at a building.
#pragma once

#include <vector>

#include "pipeline/evidence/classify_extract.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/model/extract.h"
#include "styles/classify/classify.h"
#include "styles/districts/rule_set.h"

namespace blockrand::evidence {

/// What may be assumed of the regions of the rule sets, parallel to them.
std::vector<classify::RegionPrior> region_priors(const districts::RuleSets& book, const classify::Tables& tables);

/// The prior of each building: that of the rule set for its place. Everything else that classification looks at is the
/// same for all rule sets. \param extract, footprints, book  outlive the result
PriorOf prior_by_place(const model::Extract& extract, const footprints::FootprintStore& footprints,
                       const districts::RuleSets& book, const classify::Tables& tables);

}  // namespace blockrand::evidence
