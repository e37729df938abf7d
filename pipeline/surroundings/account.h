// What became of every mapped object around the houses, summed over tiles.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>

#include "pipeline/model/surroundings.h"
#include "pipeline/surroundings/kinds.h"
#include "pipeline/surroundings/options.h"
#include "pipeline/surroundings/shared_outcome.h"

namespace blockrand::surroundings {

/// Behind the states of tiles: no tile had to do with the object.
inline constexpr std::uint8_t kElsewhere = model::kSurroundingStateCount;
inline constexpr std::size_t kToldStateCount = model::kSurroundingStateCount + 1;
constexpr std::string_view name_of_state(std::size_t state) {
  return state == kElsewhere ? "elsewhere" : model::kSurroundingStateNames[state];
}

/// Objects by kind and state.
using SurroundingCounts = std::array<std::array<std::uint64_t, kToldStateCount>, kSurroundingKindCount>;

/// Whether a layer is asked for that a thing of a kind is in: of others nothing is told.
bool is_asked(SurroundingKind kind, const SurroundingOptions& layers);

/// An object that comes into several tiles counts once, as what the best of them made of it.
class SurroundingAccount {
 public:
  struct Told {
    std::uint8_t kind = 0, state = 0;
  };

  void take(std::span<const model::SurroundingOutcome> outcomes);
  /// Also kElsewhere.
  void take(const SharedOutcome& outcome);
  /// All things of the extract that no tile had to do with.
  void take_elsewhere(const model::Extract& extract, const Catalogue& catalogue, const SurroundingOptions& layers);
  bool empty() const { return outcomes_.empty(); }
  const std::map<model::OsmId, Told>& outcomes() const { return outcomes_; }
  SurroundingCounts counts() const;

 private:
  std::map<model::OsmId, Told> outcomes_;
};

}  // namespace blockrand::surroundings
