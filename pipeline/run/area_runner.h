// Areas are built in processes of their own, as many at once as memory allows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pipeline/run/area_parts.h"

namespace blockrand::run {

/// What an area's process sends back beside its files.
struct AreaOutcome {
  std::uint64_t tiles_built = 0, tiles_kept = 0;
  double planned_tile_seconds = 0;
  std::map<std::string, std::uint64_t> tiles_built_for;
  std::set<std::string> kept_work;
  bool below_quality = false;
  std::vector<std::string> unaccounted;
  std::string folder;
  std::vector<outputs::PartySide> open_walls;
  std::vector<surroundings::SharedOutcome> shared_surroundings;
  std::vector<TileTime> slowest_tiles;
  bool in_part = false;           ///< only some tiles were looked into
  std::uint64_t looked_into = 0;  ///< so many
  bool too_small = false;         ///< that was not enough: nothing was built
  std::string why_whole;          ///< why all were
  std::uint64_t peak_bytes = 0;   ///< of its process
  double cpu_seconds = 0;
};

class AreaRunner {
 public:
  /// Warns where --memory-limit is less than one area needs.
  AreaRunner(const BuildOptions& options, AreaParts& parts, base::Progress& progress);

  /// Builds areas: those first of which little is looked into. What is too little for one is looked into as a whole.
  /// \param todo   indices into the parts
  /// \param place  folder of an area's build
  /// \param done   gets each as it ends \throws as build
  void run(const std::vector<std::size_t>& todo, const std::function<std::string(const model::TileId&)>& place,
           const std::function<void(std::size_t, AreaOutcome)>& done);

  std::size_t at_once() const { return at_once_; }
  int jobs() const { return jobs_; }  ///< of each of them

 private:
  std::vector<std::size_t> run_some(const std::vector<std::size_t>& todo, std::size_t at_once,
                                    const std::function<std::string(const model::TileId&)>& place,
                                    const std::function<void(std::size_t, AreaOutcome)>& done);

  const BuildOptions& options_;
  AreaParts& parts_;
  std::size_t at_once_ = 1, parts_at_once_ = 1;
  int jobs_ = 1;
};

}  // namespace blockrand::run
