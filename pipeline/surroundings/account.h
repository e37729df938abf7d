// What became of every mapped object around the houses, summed over tiles.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>

#include "pipeline/model/surroundings.h"
#include "pipeline/surroundings/kinds.h"

namespace blockrand::surroundings {

class ClaimFinder;

/// Objects by kind and state.
using SurroundingCounts = std::array<std::array<std::uint64_t, model::kSurroundingStateCount>, kSurroundingKindCount>;

/// An object that comes into several tiles counts once, as what the best of them made of it.
class SurroundingAccount {
 public:
  void take(std::span<const model::SurroundingOutcome> outcomes);
  bool empty() const { return outcomes_.empty(); }
  SurroundingCounts counts() const;
  /// Of all things of the extract by kind: those that no tile had to do with.
  std::array<std::uint64_t, kSurroundingKindCount> elsewhere(const ClaimFinder& claims,
                                                             const model::Extract& extract) const;

 private:
  std::map<model::OsmId, model::SurroundingOutcome> outcomes_;
};

}  // namespace blockrand::surroundings
