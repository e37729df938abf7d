#include "pipeline/surroundings/account.h"

#include <algorithm>

namespace blockrand::surroundings {

bool is_asked(SurroundingKind kind, const SurroundingOptions& layers) {
  using enum SurroundingKind;
  switch (kind) {
    case road:
    case railway:
      return layers.ground || layers.bodies;
    case aeroway:
    case parking:
    case water:
    case pool:
    case golf:
    case pitch:
    case surface_area:
      return layers.ground;
    case bicycle_parking:
      return layers.ground || layers.objects;
    case barrier:
      return layers.bodies || layers.objects;
    case bridge:
    case cliff:
      return layers.bodies;
    case power:
      return layers.objects || layers.bodies;
    case wind_turbine:
    case mast:
    case tree:
    case street_furniture:
    case traffic_sign:
      return layers.objects;
    case aerialway:
    case tunnel:
    case other:
      return true;
  }
  return true;
}

void SurroundingAccount::take(std::span<const model::SurroundingOutcome> outcomes) {
  for (const model::SurroundingOutcome& outcome : outcomes)
    take({outcome.object, outcome.kind, static_cast<std::uint8_t>(outcome.state)});
}

void SurroundingAccount::take(const SharedOutcome& outcome) {
  const auto [known, added] = outcomes_.try_emplace(outcome.object, Told{outcome.kind, outcome.state});
  if (!added) known->second.state = std::min(known->second.state, outcome.state);  // the best comes first
}

void SurroundingAccount::take_elsewhere(const model::Extract& extract, const Catalogue& catalogue,
                                        const SurroundingOptions& layers) {
  for (const model::Feature& feature : extract.features) {
    const TagOf tag = [&](std::string_view key) { return extract.tag(feature.tags, key); };
    const std::optional<SurroundingKind> kind = kind_of(feature, tag, catalogue);
    if (kind && is_asked(*kind, layers))
      outcomes_.try_emplace(feature.id, Told{static_cast<std::uint8_t>(*kind), kElsewhere});
  }
}

SurroundingCounts SurroundingAccount::counts() const {
  SurroundingCounts out{};
  for (const auto& [id, told] : outcomes_) ++out[told.kind][told.state];
  return out;
}

}  // namespace blockrand::surroundings
