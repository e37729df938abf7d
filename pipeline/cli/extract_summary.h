// What is in an extract, counted.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/georef/lon_lat.h"
#include "pipeline/model/extract.h"
#include "pipeline/run/estimate.h"

namespace blockrand::cli {

using Frequency = std::pair<std::string, std::uint64_t>;

/// How many objects carry a key of the Simple 3D Buildings scheme.
struct KeyUse {
  std::string key;
  std::uint64_t buildings = 0, parts = 0;
};

struct ExtractSummary {
  std::string file, data_time;
  std::uint64_t file_bytes = 0;
  model::ExtractCounts counts;
  std::uint64_t to_build = 0;  ///< objects with an outline that can be built from
  std::uint64_t represented = 0, duplicates = 0;
  std::map<std::string, std::uint64_t> reported;  ///< objects that cannot become an area, by code
  std::map<std::string, std::uint64_t> notices;   ///< rows of the importer that do not decide a state, by code
  std::vector<KeyUse> keys;                       ///< in the order of the scheme
  std::vector<Frequency> building_values, part_values, roof_shapes;  ///< most frequent first, equal ones by name
  std::vector<Frequency> features;                                   ///< by kind, in the order of the model
  std::optional<georef::GeoBox> extent;                              ///< of the centres of all outlines
  std::optional<georef::LonLat> centre;  ///< medians of the outlines' centres: what the CRS is chosen for
  run::TownSize size;                    ///< what decides how much a build takes
};

/// Counts. Only what the extract itself says; `file_bytes` stays 0.
/// \param shards  become those of the extract; null: not wanted
ExtractSummary summarise(const model::Extract& extract, std::vector<footprints::Shard>* shards = nullptr);

using run::BuildEstimate;

/// The coordinate system that a build would have.
struct CrsChoice {
  std::string code, name, operation;
  double accuracy_m = -1;
};

/// For people; ends with a line break.
std::string summary_text(const ExtractSummary& summary, const std::optional<CrsChoice>& crs,
                         const BuildEstimate& estimate);
/// The same for machines, indented.
std::string summary_json(const ExtractSummary& summary, const std::optional<CrsChoice>& crs,
                         const BuildEstimate& estimate);

}  // namespace blockrand::cli
