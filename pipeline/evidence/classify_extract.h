// Style, era and morphology of every building of an extract, and what its storeys and roof are likely to be: before any
// tile runs, because smoothing over rows and blocks needs to see neighbours.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/context/context_extract.h"
#include "pipeline/evidence/building_facts.h"
#include "pipeline/georef/projection.h"
#include "pipeline/model/extract.h"
#include "pipeline/model/style.h"
#include "styles/classify/classify.h"

namespace blockrand::evidence {

/// What is likely where nothing is tagged, and what speaks for it.
struct StoreysEstimate {
  float storeys = 0;     ///< 0: nothing is known
  float confidence = 0;  ///< probability of the count
  float within_one = 0;  ///< probability of the count and those beside it
  float votes = 0;       ///< weight of tagged neighbours
  float own = 0;         ///< what the building's own evidence alone would say
  std::uint16_t voters = 0;
};
struct RoofEstimate {
  model::RoofShape shape = model::RoofShape::flat;
  float confidence = 0;  ///< probability of its family
  float votes = 0;
  std::uint16_t voters = 0;
  classify::RoofFamily own = classify::RoofFamily::flat;  ///< what the building's own evidence alone would say
};

/// When a house was built whose date nothing tells, by dated neighbours of its era. Years are whole; 0: there are none.
struct DateEstimate {
  std::int16_t year = 0;          ///< their middle one, each with the weight of its vote
  std::int16_t from = 0, to = 0;  ///< the middle half of them, and kLeastYears at least, within the era
  float confidence = 0;           ///< probability of the era x share of the votes that lie between
  float votes = 0;                ///< weight of all dated neighbours, of whatever era
  std::uint16_t voters = 0;
};
/// Years to each side of the middle one that an estimate leaves open at least: a row was built in some years, not in one.
inline constexpr int kLeastYears = 5;

/// Read-only once made, safe to share between threads. Numbers of buildings are those of the FootprintStore.
struct StyleExtract {
  std::vector<model::BuildingStyle> styles;
  std::vector<StoreysEstimate> storeys;
  std::vector<RoofEstimate> roofs;
  std::vector<DateEstimate> dates;
  /// Log-odds of the style that do not come from the building's own features: region and neighbours, less what
  /// neighbours only say again (Smoothing::certainty).
  std::vector<std::array<float, model::kStyleClassCount>> elsewhere;
  std::vector<std::array<float, model::kStyleClassCount>> region;  ///< the part of it that is the region's
};

/// What is read of tags, per building: features of the group `tag`, dates, and who is no house.
struct TagFacts {
  struct Date {
    float year = 0, confidence = 0;  ///< 0: none
  };
  std::vector<Date> dates;
  std::vector<std::optional<model::YearRange>> years;
  std::vector<std::int32_t> non_house;  ///< index into `reasons`, or -1
  std::vector<classify::NonHouse> reasons;
  std::vector<std::optional<model::RoofShape>> roofs;
  /// Mapped shops, amenities and offices inside, by category of GroundFloorRules; few buildings have any.
  std::map<std::uint32_t, std::vector<int>> points;
  std::span<const int> points_of(std::uint32_t building) const {
    const auto found = points.find(building);
    return found == points.end() ? std::span<const int>() : std::span<const int>(found->second);
  }
};

/// Reads tags and fills the tag features of `facts`.
TagFacts tag_facts(const model::Extract& extract, const footprints::FootprintStore& footprints,
                   const context::ContextExtract& context, const classify::Tables& tables,
                   const georef::Projection& projection, FactsExtract& facts);

struct ClassifyOptions {
  bool tags = true;    ///< false: the building's own tags are no evidence for its style (measurements of the method)
  bool dates = true;   ///< false: nor are dates, its own and its neighbours'
  bool smooth = true;  ///< false: neighbours' styles are not looked at
};

/// The prior of the region that a building lies in, or null.
using PriorOf = std::function<const classify::RegionPrior*(std::uint32_t building)>;

/// What must be measured and classified so that the answers for `asked` are those of a whole extract.
Needed needed_for(std::span<const std::uint32_t> asked, const footprints::FootprintStore& footprints,
                  const context::ContextExtract& context, const classify::Tables& tables);

/// Deterministic for any number of workers. What a building gets depends on data within
/// 150 m (votes) + rounds x (kNearReach + a house) of what facts_extract says of it.
StyleExtract classify_extract(const FactsExtract& facts, const TagFacts& tags, const classify::Tables& tables,
                              const PriorOf& prior, const ClassifyOptions& options, int workers,
                              base::Progress& progress, const Needed& needed = {});

}  // namespace blockrand::evidence
