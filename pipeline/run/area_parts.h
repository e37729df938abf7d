// The areas of a build in areas: which there are, what each is made from, and what of them an earlier build or kept work has already.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "importers/osm/extract_store.h"
#include "pipeline/base/child_process.h"
#include "pipeline/base/progress.h"
#include "pipeline/georef/projection.h"
#include "pipeline/run/area_changes.h"
#include "pipeline/run/area_survey.h"
#include "pipeline/run/build_areas.h"
#include "pipeline/run/divide_extract.h"
#include "pipeline/run/work_cache.h"

namespace blockrand::run {

/// Of an area's run.json: what it took when all of its tiles were worked on last.
inline constexpr const char* kWholeCpuSeconds = "cpu_seconds_of_whole";

/// Made once by `make`, which divides the extract and surveys it; other processes that have the same options and data open what `save`
/// left. Either then knows the same areas, in the same order.
class AreaParts {
 public:
  /// \param work  folder for the store of the extract and what the survey found
  AreaParts(const BuildOptions& options, std::string work, base::Progress& progress);

  /// \throws base::InputError, base::UsageError, base::OutputError  as build
  void make();
  /// What `make` found goes to the folder. \throws base::OutputError
  void save() const;
  /// \param mode  of the cache: work for the one process that may write it, look for others
  /// \throws base::InputError  what was saved is damaged, or by another program
  void open(WorkCache::Mode mode);

  std::size_t size() const { return parts_.size(); }
  const model::TileId& id(std::size_t i) const { return parts_[i].choice.id; }
  /// The area; of which only some tiles are looked into where that is enough.
  AreaPart part(std::size_t i) const;
  bool in_part(std::size_t i) const { return looks_.contains(i); }
  /// How many tiles are looked into. \pre in_part(i)
  std::size_t looked_into(std::size_t i) const { return looks_.at(i).changes.tiles.size(); }
  /// It is to be looked into as a whole, after all.
  void look_into_all(std::size_t i, std::string why);
  std::string why_whole(std::size_t i) const;
  /// Bytes stored of what is read for it.
  std::uint64_t stored(std::size_t i) const { return stored_[i]; }
  /// Mapped objects in it.
  std::uint64_t objects(std::size_t i) const;
  std::uint64_t objects() const;

  /// What its run.json notes: hashes of all that it is made from, and of the facts of the region among that.
  const std::string& key(std::size_t i) const { return keys_[i]; }
  const std::string& facts_key(std::size_t i) const { return facts_keys_[i]; }

  /// run.json of the area in the earlier build; null: there is none.
  nlohmann::ordered_json earlier_run(std::size_t i) const;
  /// Files of the same area of the earlier build, relative to it, where it was made from the same, or nothing that changed concerns
  /// it, and is whole.
  std::optional<std::vector<std::string>> earlier_files(std::size_t i);
  /// Where these lie.
  std::string earlier_place(std::size_t i) const;

  const BuildOptions& named() const { return named_; }  ///< the options, with a name
  const RegionSurvey& survey() const { return survey_; }
  const importers::osm::ExtractStore& store() const { return *store_; }
  std::uint64_t largest() const;            ///< bytes stored around an area, at most
  std::set<std::string> kept_work() const;  ///< used so far, but for what areas used
  const std::string& store_written_because() const { return written_because_; }

  /// Notes what a process took, and tells its warnings once.
  void note(const base::ChildResult& result);
  std::uint64_t peak() const { return peak_; }              ///< bytes, of processes so far
  double cpu_seconds() const { return cpu_seconds_; }       ///< of processes so far
  void note_peak(std::uint64_t bytes, double cpu_seconds);  ///< of processes of others

 private:
  void open_cache(WorkCache::Mode mode);
  void make_survey();
  void tell_survey();
  void choose();
  void keep_store();
  void find_changes(const georef::Projection& projection);
  void look_at_changes(std::size_t i, std::span<const importers::osm::ChangedObject> changes, const RulesReach& rules,
                       const georef::Projection& projection);
  void because(const std::string& why);
  std::optional<WorkCache::Found> kept_store();
  EarlierStore earlier_store();

  /// An area of which only some tiles are looked into.
  struct Look {
    AreaChanges changes;
    std::string before;  ///< key of the records
  };
  const BuildOptions& options_;
  BuildOptions named_;
  std::string work_;
  base::Progress& progress_;
  std::unique_ptr<WorkCache> cache_;
  std::optional<importers::osm::ExtractStore> store_;
  RegionSurvey survey_;
  std::vector<AreaPart> parts_;
  std::vector<std::string> keys_, facts_keys_;  ///< parallel to parts_
  std::map<std::size_t, Look> looks_;           ///< by index of the part
  std::map<std::size_t, std::string> why_whole_;
  std::set<std::size_t> unconcerned_;  ///< parts in which nothing differs
  std::vector<std::uint64_t> stored_;  ///< parallel to parts_
  std::uint64_t peak_ = 0;
  double cpu_seconds_ = 0;
  std::string written_because_, no_store_because_;  ///< the store, whole; see divide()
  std::set<std::string> kept_work_, told_;
  std::optional<nlohmann::ordered_json> earlier_record_;
};

}  // namespace blockrand::run
