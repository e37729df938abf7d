#include "pipeline/surroundings/account.h"

#include <algorithm>

#include "pipeline/surroundings/ground_claims.h"

namespace blockrand::surroundings {

void SurroundingAccount::take(std::span<const model::SurroundingOutcome> outcomes) {
  for (const model::SurroundingOutcome& outcome : outcomes) {
    const auto [known, added] = outcomes_.try_emplace(outcome.object, outcome);
    if (!added) known->second.state = std::min(known->second.state, outcome.state);  // the best comes first
  }
}

SurroundingCounts SurroundingAccount::counts() const {
  SurroundingCounts out{};
  for (const auto& [id, outcome] : outcomes_) ++out[outcome.kind][static_cast<std::size_t>(outcome.state)];
  return out;
}

std::array<std::uint64_t, kSurroundingKindCount> SurroundingAccount::elsewhere(const ClaimFinder& claims,
                                                                               const model::Extract& extract) const {
  std::array<std::uint64_t, kSurroundingKindCount> out{};
  for (const Thing& thing : claims.things())
    if (!outcomes_.contains(extract.features[thing.feature].id)) ++out[static_cast<std::size_t>(thing.kind)];
  return out;
}

}  // namespace blockrand::surroundings
