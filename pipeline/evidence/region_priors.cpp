#include "pipeline/evidence/region_priors.h"

#include <memory>
#include <string>
#include <utility>

#include "pipeline/footprints/shard.h"

namespace blockrand::evidence {

std::vector<classify::RegionPrior> region_priors(const districts::RuleSets& book, const classify::Tables& tables) {
  std::vector<classify::RegionPrior> out;
  for (const districts::RuleSet& set : book.sets) {
    classify::RegionPrior prior;
    prior.style = set.prior.style;
    prior.era = set.prior.era;
    if (!set.prior.substyle.empty() || !set.prior.absent.empty()) {
      prior.substyle.assign(tables.catalogue.size(), 1);
      for (const std::string& id : set.prior.absent)
        if (const auto index = tables.catalogue.index(id)) prior.substyle[*index] = 0;
      for (const auto& [id, weight] : set.prior.substyle)
        if (const auto index = tables.catalogue.index(id)) prior.substyle[*index] = classify::kNamedSubstyle * weight;
    }
    for (std::size_t i = 0; i < prior.storeys.size(); ++i)
      if (const auto usual = set.prior.storeys.find(std::string(districts::kStoreyPriorNames[i]));
          usual != set.prior.storeys.end())
        prior.storeys[i] = usual->second;
    out.push_back(std::move(prior));
  }
  return out;
}

PriorOf prior_by_place(const model::Extract& extract, const footprints::FootprintStore& footprints,
                       const districts::RuleSets& book, const classify::Tables& tables) {
  const auto priors = std::make_shared<const std::vector<classify::RegionPrior>>(region_priors(book, tables));
  return [&extract, &footprints, &book, priors](std::uint32_t building) -> const classify::RegionPrior* {
    const std::uint32_t set =
        book.choose(footprints::box_centre(extract, extract.buildings[footprints[building].lead]));
    return set == districts::RuleSets::kNoSet ? nullptr : &(*priors)[set];
  };
}

}  // namespace blockrand::evidence
