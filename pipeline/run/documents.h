// build.json and run.json: what a build tells about itself.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "importers/elevation/terrain.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/publish.h"
#include "pipeline/context/height_reference.h"
#include "pipeline/footprints/repair_extract.h"
#include "pipeline/georef/crs.h"
#include "pipeline/georef/round_trip.h"
#include "pipeline/model/extract.h"
#include "pipeline/observation/imagery.h"
#include "pipeline/outputs/statistics.h"
#include "pipeline/run/build.h"
#include "pipeline/run/region_facts.h"
#include "pipeline/surroundings/account.h"
#include "styles/elements/element_catalogue.h"

namespace blockrand::run {

/// A file that went into the build.
struct InputFile {
  std::string role;  ///< "extract", "terrain", "config", "overrides", "imagery"
  std::string path;  ///< as given
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// Everything that the same call writes again byte for byte.
struct BuildRecord {
  std::vector<InputFile> inputs;                         ///< without the extract: `data_sha256` says what was in it
  std::vector<elements::ElementCredit> element_credits;  ///< of element files that say who made what they hold
  std::string data_sha256;
  std::string data_time;
  georef::Crs crs;
  bool portable = true;
  georef::RoundTrip round_trip;
  context::HeightReference heights;
  std::optional<importers::elevation::TerrainDescription> terrain;
  std::vector<observation::ImageReceipt> images;
  std::optional<model::TileId> area;  ///< of a build in areas: what `facts` say stands in the record of the whole
  RegionFacts facts;
  footprints::RepairTotals repair;
  BuildSummary summary;
  outputs::Statistics statistics;
  surroundings::SurroundingAccount surroundings;
  model::ExtractCounts counts;
  std::vector<base::PublishedFile> files;  ///< in path order
};

/// What differs from run to run.
struct RunRecord {
  std::vector<base::Progress::PhaseTime> timings;
  double seconds = 0;
  double tile_context_seconds = 0;  ///< of all threads: parts and facade edges, which are worked on in tiles
  std::uint64_t peak_rss_bytes = 0;
  std::uint64_t store_bytes = 0;  ///< the object store with its indices
  std::uint64_t tiles_in_flight = 0;
  int jobs = 0;
  std::string host;
  std::vector<InputFile> inputs;  ///< files by which the data came
};

/// What a build of one tile or area alone takes from a record (--pinned).
nlohmann::ordered_json region_json(const RegionFacts& facts);
nlohmann::ordered_json crs_json(const BuildRecord& record);
nlohmann::ordered_json inputs_json(const std::vector<InputFile>& inputs);

std::string build_json(const BuildOptions& options, const BuildRecord& record);
std::string run_json(const RunRecord& run, const BuildSummary& summary);

}  // namespace blockrand::run
