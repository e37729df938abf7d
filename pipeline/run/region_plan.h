// Where the next data of a region come from, and whether there is anything to do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "importers/osm/apply_changes.h"
#include "pipeline/run/region_folder.h"
#include "pipeline/run/region_state.h"
#include "pipeline/run/update_region.h"

namespace blockrand::run {

/// Says cheaply whether a file is the same. Empty for none.
std::string stamp_of(const std::string& path);

/// Everything but the data that a build hangs on: settings, program, files of rules and styles, rasters by the size and time
/// of their files.
std::string settings_sha256(const UpdateOptions& options);

/// Where the next data come from.
struct Plan {
  std::string extract;                    ///< a full one; empty: the data in the store
  std::vector<std::string> changes;       ///< change files, in their order
  std::optional<std::uint64_t> sequence;  ///< after them
  std::string time;                       ///< of the newest change file in them, ISO 8601, or empty
  std::vector<std::string> why;
};

/// The first change file of the replication folder that is to be applied. \throws base::InputError  nobody knows
std::uint64_t next_sequence(const RegionOptions& options, std::optional<std::uint64_t> applied,
                            const RegionFolder& region);

/// \throws base::UsageError  no data yet and no extract given; more than one extract
/// \throws base::InputError  a gap in the change files
Plan plan_of(const UpdateOptions& options, const RegionFolder& region, std::optional<int> current,
             const DataState& state);

/// About 6 by 10 km at 51 degrees: an area of the middle of a large city takes 540 MB at LoD3 (docs/internal/RESULTS.md).
inline constexpr int kUsualAreas = 11;

/// In which areas a region is built: what the settings say, else what its first build chose, as areas that change their size change every
/// path; 0: as a whole. \param data  the file of its data \param before  of the build that is published
int areas_for(const UpdateOptions& options, const std::string& data, std::optional<int> current,
              const DataState& before);

/// What a run asks `build` for. \param areas  areas_for
BuildOptions build_options_for(const UpdateOptions& options, const RegionFolder& region, int number,
                               std::optional<int> current, const DataState& before, int areas);

/// What the data are cut to; nothing: they are not. \throws base::InputError
std::optional<importers::osm::ClipPolygon> polygon_of(const RegionOptions& options);

}  // namespace blockrand::run
