// The folder of a region that is rebuilt again and again (docs/nightly.md): which builds it has, which one is published.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "pipeline/base/progress.h"

namespace blockrand::run {

/// `region.toml`, `store/N.osm.pbf` and `store/N.json`, `builds/N/`, `current` -> `builds/N`, `log/N.json`, `lock`. N is the
/// number of a run, six digits. What `current` leads to is published, whatever else lies there: the one step that
/// publishes is the renaming of that link. `store/N.json` is written when gates have let a build N pass: a build without it
/// is left by a run that was broken off.
class RegionFolder {
 public:
  /// Nothing is made. \throws base::UsageError  the place is a file, a build, a region without its region.toml, or a folder
  /// that is no region and not empty
  explicit RegionFolder(std::string path);

  const std::string& path() const { return path_; }
  /// Its last component.
  std::string name() const;
  std::string settings() const { return path_ + "/region.toml"; }
  std::string build(int number) const { return path_ + "/builds/" + digits(number); }
  std::string data(int number) const { return path_ + "/store/" + digits(number) + ".osm.pbf"; }
  std::string state(int number) const { return path_ + "/store/" + digits(number) + ".json"; }
  /// region.toml as it was, and the comparison with the reference of its gates.
  std::string settings_of(int number) const { return path_ + "/store/" + digits(number) + ".toml"; }
  std::string comparison(int number) const { return path_ + "/store/" + digits(number) + ".compare.json"; }
  std::string log(int number) const { return path_ + "/log/" + digits(number) + ".json"; }
  std::string changes(int number) const { return path_ + "/log/" + digits(number) + ".changes"; }
  /// Of a build whose areas several processes build (region_shards.h), while it is under way.
  std::string plan() const { return path_ + "/plan"; }
  /// Where work on tiles is kept from run to run.
  std::string cache() const { return path_ + "/cache"; }
  static std::string digits(int number);

  /// Whether it is one already.
  bool exists() const;
  /// Makes what is missing but region.toml. \throws base::OutputError
  void make() const;

  /// The build that is published. \throws base::InputError  `current` is no link, or leads to no build; there is none, but
  /// there are builds
  std::optional<int> current() const;
  /// Builds that gates have let pass and that are still there, ascending.
  std::vector<int> passed() const;
  /// Larger than any that was used.
  int next() const;

  /// Removes what a run that was broken off left: builds and data without `store/N.json`, unfinished files. What has other
  /// names than this program's stays. \returns  what was removed
  /// \throws base::OutputError  something cannot be removed, or nobody can tell what it is (a disk that does not answer)
  std::vector<std::string> remove_unfinished() const;
  /// Publishes a build, when all that was written is on the disk. \throws base::OutputError
  void publish(int number) const;
  /// Sets a build that was refused aside, as `builds/N.refused`; earlier ones make room.
  /// \returns  where it lies \throws base::OutputError
  std::string set_aside(int number) const;
  /// Takes the marks of the oldest builds, so that they are no builds any more, but for `keep`, the current one and those of
  /// `also`. What is left of them lies there until `remove`, or `remove_unfinished` of the next run.
  /// \param failed  what could not be removed is added  \returns  their numbers, ascending
  std::vector<int> unmark(int keep, const std::vector<int>& also, std::vector<std::string>& failed) const;
  /// Removes builds without a mark, with their data, and logs older than all builds. \param failed  as above
  void remove(const std::vector<int>& unmarked, std::vector<std::string>& failed) const;

 private:
  std::string path_;
};

/// Kept while a run changes a region: one at a time. A lock whose process is gone is taken over.
class RegionLock {
 public:
  /// \param take_over  even where a run on another host seems to hold it
  /// \throws base::UsageError   another run holds it: which, since when
  /// \throws base::OutputError  the folder cannot be written, or its disk knows no locks
  RegionLock(const RegionFolder& region, bool take_over, base::Progress& progress);
  ~RegionLock();
  RegionLock(const RegionLock&) = delete;
  RegionLock& operator=(const RegionLock&) = delete;

 private:
  int descriptor_ = -1;
  std::jthread alive_;  ///< touches the lock, so that other hosts see that its run lives
};

/// Everything written so far to the disk of a folder is on it. \throws base::OutputError
void sync_disk(const std::string& folder);

/// Writes a small file beside its place and renames it there, so that a reader finds the old one or the new one whole.
/// \throws base::OutputError
void write_whole(const std::string& path, std::string_view bytes);

}  // namespace blockrand::run
