// Documents of a build in areas: what is true of all of them, and where each is found.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "importers/osm/extract_store.h"
#include "pipeline/base/publish.h"
#include "pipeline/outputs/statistics.h"
#include "pipeline/run/build.h"
#include "pipeline/run/region_facts.h"
#include "pipeline/surroundings/account.h"

namespace blockrand::run {

/// "areas/11/1093/805"
std::string area_path(const model::TileId& area);

/// A finished area, as its documents say.
struct FinishedArea {
  model::TileId tile;
  std::string record_sha256;           ///< of its build.json
  std::uint64_t files = 0, bytes = 0;  ///< of all of it
};

/// Adds up the records of all areas, one in memory at a time.
class Overview {
 public:
  Overview(const BuildOptions& options, const RegionFacts& facts, const importers::osm::StoreFigures& data);
  ~Overview();
  Overview(const Overview&) = delete;
  Overview& operator=(const Overview&) = delete;

  /// \param folder  of the area, whole \throws base::OutputError  its documents cannot be read
  void add(const model::TileId& area, const std::string& folder);

  /// What stands around houses: what areas share, which each counted, and counts of what lies in no area that is built.
  void settle_around(const std::vector<surroundings::SharedOutcome>& shared,
                     const surroundings::SurroundingCounts& elsewhere);

  /// Rows of what lies in no area that is built.
  void add(std::vector<model::ReportRow> rows);

  /// Party walls between buildings of two areas, which both counted as outer walls. \param open  of all areas
  void settle(std::vector<outputs::PartySide> open);

  /// Counts and issues of all, files and bytes.
  void sum_up(BuildSummary& summary) const;

  /// tileset.json (where it was asked for), report.json, report.html, buildings.vrt, build.json.
  /// \param unmatched  orders that match nothing
  void write(base::StagedFolder& folder, const std::vector<std::string>& unmatched, BuildSummary& summary) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace blockrand::run
