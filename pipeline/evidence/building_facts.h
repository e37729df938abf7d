// What can be measured of every building of an extract, its neighbours and its block: the input of classification.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/base/memo.h"
#include "pipeline/base/progress.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/context/vicinity_finder.h"
#include "pipeline/footprints/footprint_store.h"
#include "pipeline/geometry/box_index.h"
#include "pipeline/model/building.h"
#include "styles/classify/features.h"

namespace blockrand::evidence {

/// A common wall.
struct Contact {
  std::uint32_t other = 0;  ///< number of the building beyond it
  float length = 0;         ///< m
};

/// Of one building, what is not a feature.
struct BuildingPlace {
  model::Point2 place;                    ///< m, middle of its largest polygon
  std::uint64_t street = 0;               ///< of the main front: the same number for the same street, 0 for none
  std::uint32_t block = model::kNoIndex;  ///< into ContextExtract::blocks
  model::Range contacts;                  ///< into FactsExtract::contacts
  model::BuildingPosition position = model::BuildingPosition::unknown;
  bool house = false;  ///< kHouseArea and more on the ground, no canopy
};

/// Read-only once made, safe to share between threads. Numbers of buildings are those of the FootprintStore.
struct FactsExtract {
  std::vector<classify::FeatureVector> features;
  std::vector<BuildingPlace> places;
  std::vector<Contact> contacts;  ///< of houses with houses, by building, the longest first
  std::span<const Contact> contacts_of(std::uint32_t building) const {
    const model::Range r = places[building].contacts;
    return std::span(contacts).subspan(r.first, r.count);
  }
};

/// Buildings whose middle lies within a distance of a place; read-only after construction.
class PlaceIndex {
 public:
  /// \param chosen  the buildings to file, ascending
  PlaceIndex(const FactsExtract& facts, std::span<const std::uint32_t> chosen);
  /// Ascending.
  void near(model::Point2 place, double distance, std::vector<std::uint32_t>& out) const;
  /// Those at most `distance` from a box along both axes: more than those near its points. Ascending.
  std::vector<std::uint32_t> around(const geometry::PlanBox& box, double distance) const;

 private:
  std::vector<std::uint32_t> chosen_;
  geometry::BoxIndex places_;  ///< by place in `chosen_`
};

/// Which buildings of an extract are looked at where only some are asked for; both by number. Empty: all.
struct Needed {
  std::vector<std::uint8_t> facts;   ///< measured
  std::vector<std::uint8_t> styles;  ///< classified, for which what stands around is measured as well
  bool has_facts(std::size_t building) const { return facts.empty() || facts[building] != 0; }
  bool has_style(std::size_t building) const { return styles.empty() || styles[building] != 0; }
};

/// Measures all buildings, or those that are needed. Deterministic for any number of workers. What a building gets depends on data within
/// BlockOptions::max_extent + kNearReach + kWallSegmentReach of it.
/// \param first  per tile: the number of its first building, as RepairedExtract has it
/// \param memo   where measurements of an earlier run are found again; null: none
FactsExtract facts_extract(const model::Extract& extract, const footprints::FootprintStore& footprints,
                           std::span<const std::uint32_t> first, const context::ContextExtract& context,
                           const context::VicinityFinder& vicinity, int workers, base::Progress& progress,
                           const base::Memo* memo = nullptr, const Needed& needed = {});

}  // namespace blockrand::evidence
