// What a region is as a whole, found area by area: so that each can be built without the others.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "importers/osm/extract_store.h"
#include "pipeline/base/memo.h"
#include "pipeline/base/progress.h"
#include "pipeline/run/options.h"
#include "pipeline/run/region_facts.h"
#include "pipeline/surroundings/account.h"

namespace blockrand::run {

struct RegionSurvey {
  RegionFacts facts;
  std::map<model::TileId, std::uint64_t> objects;  ///< mapped objects by area; areas without any are not here
  bool has_outlines = false;                       ///< a building has an outline
  std::vector<std::string> unmatched;              ///< orders of the overrides that match nothing in any area
  std::vector<model::ReportRow> rows;              ///< of what lies in areas without buildings, which are not built
  std::vector<std::string> unanswered;             ///< DistrictAssigner::unanswered of all areas together
  std::set<model::TileId> only_surroundings;       ///< areas without buildings that have tiles among those with some
  /// What lies in areas that are not built, of the surroundings of houses.
  surroundings::SurroundingCounts surroundings{};
  std::vector<surroundings::SharedOutcome> shared_surroundings;  ///< of it, what areas may tell of as well
};

/// Bytes stored of what is read for an area: of more it is cut in four, so that its memory stays within a bound. In a city of
/// millions two squares of 6 by 10 km had 67 and 59 MB, and took up to 680 MB at LoD3; their quarters have at most 50 (docs/internal/RESULTS.md).
inline constexpr std::uint64_t kMostStored = 55'000'000;
/// Finer areas are read around many times over.
inline constexpr int kFinestAreas = 13;

/// The areas of a build: tiles of a level that objects touch, and quarters of those around which too much lies. Ascending by level, then place.
/// \param most  kMostStored
std::vector<importers::osm::StoredArea> areas_of(const importers::osm::ExtractStore& store, int level,
                                                 std::uint64_t most = kMostStored);

/// Reads each area once. Memory: that of one area, and 8 bytes for each building.
/// \param memo  where an earlier run left what an area says; null: nowhere
/// \throws base::InputError, base::UsageError  as build
RegionSurvey survey_region(const importers::osm::ExtractStore& store, const BuildOptions& options,
                           base::Progress& progress, const base::Memo* memo);

}  // namespace blockrand::run
