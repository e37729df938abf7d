// A build in areas whose areas are built by several processes, on hosts that share a disk: planned once, worked on by shards, finished
// once. The result is that of one process, byte by byte.
//
//   FOLDER/work/             the store of the extract, what the survey found
//   FOLDER/areas/11/1093/805 an area that is done
//   FOLDER/done/11-1093-805  says so, and what its process told; written last
//   FOLDER/parts/HOST-PID/   areas in the making
//   FOLDER/started/HOST-PID  there while a process works: one that did not end leaves it
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/run/area_runner.h"

namespace blockrand::run {

class SharedAreas {
 public:
  explicit SharedAreas(std::string folder) : folder_(std::move(folder)) {}

  std::string work() const { return folder_ + "/work"; }
  std::string place(const model::TileId& area) const;
  /// Where this process builds areas.
  std::string parts() const;

  /// What the process told that built an area; nothing where none has yet, or from other data or settings.
  /// \param key  AreaParts::key
  /// \throws base::InputError  it is damaged: it counts as not done from now on
  std::optional<AreaOutcome> outcome(const model::TileId& area, const std::string& key) const;
  bool is_done(const model::TileId& area, const std::string& key) const;
  /// Takes an area in that this process built. One that another process has handed in meanwhile stays: it is the same.
  /// \throws base::OutputError
  void hand_in(const model::TileId& area, const std::string& key, AreaOutcome outcome) const;

  /// Processes that began and did not end: they work, or are gone.
  std::vector<std::string> unended() const;
  std::string folder() const { return folder_; }

 private:
  std::string mark(const model::TileId& area) const;
  bool is_whole(const model::TileId& area, const std::string& record_sha256) const;
  std::string folder_;
};

/// An area that is to be built.
struct PlannedArea {
  model::TileId id;
  std::uint64_t objects = 0;  ///< mapped, in it
  bool in_part = false;       ///< only some of its tiles are looked into
  std::string key{};          ///< AreaParts::key
  double cpu_seconds = 0;     ///< expected, from what it, or others, took
  int shard = 0;              ///< from 1
};

/// Gives each area to a shard, so that they end together: the longest first, each to the shard that has the least (Graham: Bounds on
/// Multiprocessing Timing Anomalies, 1969).
void balance(std::vector<PlannedArea>& areas, int shards);

/// The first step. \returns  the areas that are to be built, in the order of their tiles; the others are those of the earlier build
/// \throws as build
std::vector<PlannedArea> plan_areas(const BuildOptions& options, const SharedAreas& shared, int shards,
                                    base::Progress& progress);

struct SharedWork {
  std::uint64_t built = 0, were_done = 0;  ///< areas
  double cpu_seconds = 0;
};
/// The second step, as often as wanted, on any host: what is done stays. \param areas  those of the shard \throws as build
SharedWork work_on_areas(const BuildOptions& options, const SharedAreas& shared, const std::set<model::TileId>& areas,
                         base::Progress& progress);

/// Copies a folder by hard links, where the disk has them.
/// \throws base::OutputError
void link_tree(const std::string& from, const std::string& to);

}  // namespace blockrand::run
