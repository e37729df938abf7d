// The main job: one extract in, a published build out.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/masses/roofscape.h"
#include "pipeline/outputs/object_counts.h"
#include "pipeline/outputs/statistics.h"
#include "pipeline/run/options.h"
#include "pipeline/surroundings/shared_outcome.h"

namespace blockrand::run {

/// How long work on a tile took.
struct TileTime {
  std::string tile;                ///< "15_35207_25947"
  std::uint64_t microseconds = 0;  ///< of one thread
  std::uint64_t buildings = 0;
};
/// So many are told (own choice): enough to see what they have in common, few enough for names of metrics.
inline constexpr std::size_t kSlowestTiles = 10;
/// Adds a tile where it is among the slowest; of equal ones the first by name.
void note_slow_tile(std::vector<TileTime>& slowest, TileTime tile);
nlohmann::ordered_json slowest_tiles_json(const std::vector<TileTime>& slowest);

/// What a build ended with.
struct BuildSummary : outputs::ObjectCounts {
  std::map<std::string, std::uint64_t> issues;  ///< rows by code
  masses::Roofscape roofscape;                  ///< how roofs stand in their rows
  std::uint64_t files = 0, bytes = 0;           ///< written
  double seconds = 0;
  std::uint64_t peak_rss_bytes = 0;
  std::uint64_t store_bytes = 0;                  ///< of it: the extract and its indices before the first tile
  std::uint64_t tiles_in_flight = 0;              ///< at most this many tiles share the rest
  std::uint64_t tiles_built = 0, tiles_kept = 0;  ///< worked on; taken from an earlier run (BuildOptions::cache)
  double planned_tile_seconds = 0;  ///< BuildOptions::plan: how long the tiles should take; 0: nobody knows
  /// Why tiles were worked on, counted by what differs from the run before: names of TilePart, "new", "not kept".
  std::map<std::string, std::uint64_t> tiles_built_for;
  std::vector<TileTime> slowest_tiles;      ///< of those worked on, at most kSlowestTiles; the slowest first
  std::uint64_t areas = 0, areas_kept = 0;  ///< of a build in areas: all, and those of the earlier build
  std::set<std::string> areas_taken_over;   ///< the latter by name
  std::set<std::string> areas_in_part;      ///< those of which only some tiles were looked into
  std::set<std::string> kept_work_of_areas;  ///< as kept_work, each behind the area that used it: "11/1093/805 tiles/…"
  std::vector<outputs::PartySide> open_walls;  ///< of an area: party walls whose other side is not in it
  std::vector<surroundings::SharedOutcome> shared_surroundings;  ///< of an area: what others may tell of as well
  std::set<std::string> kept_work;  ///< what the run used or left in the cache (WorkCache::used)
  std::map<std::string, std::string, std::less<>> figures;  ///< of single files, in words, by path
  bool below_quality = false;                               ///< a building is simpler than asked, or has no solid
  std::uint64_t images_misfit = 0;                          ///< aerial images that do not fit the map
  std::vector<std::string> unaccounted;                     ///< objects that no stage decided on: a bug
  std::string folder;  ///< where the build lies: beside the output folder where it must not replace it
};

/// How people know the extract: its path, of standard input a word for it.
std::string told_input(const BuildOptions& options);

/// What pages call the build: the name given, else that of the extract without the endings of its format.
std::string name_of(const BuildOptions& options);

struct AreaPart;

/// One area of a build in areas, as a build of its own. \throws as build
BuildSummary build_area(const BuildOptions& options, const AreaPart& part, base::Progress& progress);

/// Builds and publishes; with BuildOptions::plan, only says which tiles it would work on. An existing output folder stays untouched until the new one is complete. A build with objects that
/// are unaccounted for replaces none: it lies beside, as `<output>.unaccounted`.
/// \throws base::InputError   unreadable or invalid input
/// \throws base::UsageError   options that contradict each other; an output place that cannot be used
/// \throws base::OutputError  the disk is full or cannot be written
BuildSummary build(const BuildOptions& options, base::Progress& progress);

}  // namespace blockrand::run
