// District rules over a whole extract: the facts that they ask for, and their answer for any building.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "pipeline/attributes/area_set.h"
#include "pipeline/attributes/defaults.h"
#include "pipeline/attributes/overrides.h"
#include "pipeline/base/progress.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/context/tagged_neighbours.h"
#include "pipeline/context/vicinity_finder.h"
#include "pipeline/evidence/classify_extract.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/footprints/shard.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/region.h"
#include "styles/districts/assign.h"

namespace blockrand::attributes {

/// What answers are made of; all of it outlives the assigner. Numbers of buildings are those of the FootprintStore.
struct AssignInputs {
  const model::Extract& extract;
  const footprints::FootprintStore& footprints;
  const context::ContextExtract& context;
  const evidence::StyleExtract& styles;  ///< where it is empty every class and era is as likely as any other
  const georef::Projection& projection;
  const Defaults& defaults;
  const context::TaggedNeighbours& neighbours;
  int neighbour_minimum = 3;
  const Overrides* overrides = nullptr;
  std::span<const PinnedArea> pinned;  ///< of a build of the whole
  std::uint64_t seed = 1;
  const evidence::FactsExtract* facts = nullptr;  ///< of fronts; null: the width of none is known
};

/// What a rule asks about a place or boundary by its name.
struct NamedPlaceQuestion {
  std::uint32_t set = 0;   ///< of the RuleSets
  std::string unanswered;  ///< what is said where nothing has that name
  bool found = false;      ///< here
};

/// Answers for single buildings. Made before any tile: files of the rules are read, places and areas of the extract
/// indexed. A pure function of the building's facts, so that the order of buildings, threads and tiles do not matter; a
/// tile asks it as soon as it knows where in its block a building stands. Read-only, safe to share.
///
/// Reach: a building's cell (250 m), its block, TaggedNeighbours' reach, kMaxNear for features; areas that are larger
/// than that are pinned.
class DistrictAssigner {
 public:
  /// \throws base::InputError  a file that a rule names cannot be used
  DistrictAssigner(const districts::RuleSets& book, const AssignInputs& inputs);
  ~DistrictAssigner();
  DistrictAssigner(const DistrictAssigner&) = delete;
  DistrictAssigner& operator=(const DistrictAssigner&) = delete;

  districts::Decision decide(std::uint32_t building, model::BuildingPosition position) const;
  districts::Assignment assign(std::uint32_t building, model::BuildingPosition position) const;

  /// What a build of the whole writes down for its tiles, in a fixed order.
  std::vector<PinnedArea> to_pin() const;
  /// Questions that nothing in the extract can answer: a place or boundary with a name that is not there,
  /// of sets that hold for a building here.
  std::vector<std::string> unanswered() const;
  /// All questions that ask for a name, whether or not their set holds here, in the order of sets and queries.
  const std::vector<NamedPlaceQuestion>& named_places() const;
  const districts::RuleSets& book() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What DistrictAssigner::unanswered says. \param asked  sets that hold for a building
std::vector<std::string> unanswered(std::span<const NamedPlaceQuestion> questions,
                                    const std::set<std::uint32_t>& asked);

/// The presets of the region's buildings, parallel to them, where they state measures; null for others. Empty where no preset
/// does. What districts decide is asked before attributes are resolved, which read it.
std::vector<const districts::Preset*> presets_with_measures(const model::Region& region,
                                                            std::span<const std::uint32_t> numbers,
                                                            const DistrictAssigner& assigner);

/// Fills `preset` and `preset_parameters` of the region's buildings (and `preset` of their parts, the same).
/// \param numbers  of the buildings in the store, in their order; edges and situation are known
void assign_region(model::Region& region, std::span<const std::uint32_t> numbers, const DistrictAssigner& assigner);

/// The answers for all buildings, by number.
std::vector<districts::Decision> assign_extract(const DistrictAssigner& assigner,
                                                std::span<const model::BuildingPosition> positions, int workers,
                                                base::Progress& progress);

}  // namespace blockrand::attributes
