// The folder of a region that is rebuilt again and again (docs/nightly.md): which builds it has, which one is published.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/progress.h"

namespace blockrand::run {

/// `region.toml`, `store/N.osm.pbf` and `store/N.json`, `builds/N/`, `current` -> `builds/N`, `log/N.json`, `lock`. N is the
/// number of a run, six digits. What `current` leads to is published, whatever else lies there: the one step that
/// publishes is the renaming of that link.
class RegionFolder {
 public:
  /// Nothing is made. \throws base::UsageError  the place is a file, or a folder that is no region and not empty
  explicit RegionFolder(std::string path);

  const std::string& path() const { return path_; }
  /// Its last component.
  std::string name() const;
  std::string settings() const { return path_ + "/region.toml"; }
  std::string build(int number) const { return path_ + "/builds/" + digits(number); }
  std::string data(int number) const { return path_ + "/store/" + digits(number) + ".osm.pbf"; }
  std::string state(int number) const { return path_ + "/store/" + digits(number) + ".json"; }
  std::string log(int number) const { return path_ + "/log/" + digits(number) + ".json"; }
  std::string changes(int number) const { return path_ + "/log/" + digits(number) + ".changes"; }
  static std::string digits(int number);

  /// Whether it is one already.
  bool exists() const;
  /// Makes what is missing. \throws base::OutputError
  void make() const;

  /// The build that is published. \throws base::InputError  `current` leads to no build
  std::optional<int> current() const;
  /// Builds that were published and are still there, ascending.
  std::vector<int> published() const;
  /// Larger than any that was used.
  int next() const;

  /// Removes what a run that was broken off left: builds and data that no run has ended with. \returns  what was removed
  std::vector<std::string> remove_unfinished() const;
  /// Publishes a build. \throws base::OutputError
  void publish(int number) const;
  /// Sets a build that was refused aside, as `builds/N.refused`; an earlier one makes room.
  /// \returns  where it lies
  std::string set_aside(int number) const;
  /// Removes the oldest published builds, with their data, but for `keep` and the current one.
  void prune(int keep) const;

 private:
  std::string path_;
};

/// Kept while a run changes a region: one at a time. A lock whose process is gone is taken over.
class RegionLock {
 public:
  /// \param take_over  even where a run on another host seems to hold it
  /// \throws base::UsageError   another run holds it: which, since when
  /// \throws base::OutputError  the folder cannot be written
  RegionLock(const RegionFolder& region, bool take_over, base::Progress& progress);
  ~RegionLock();
  RegionLock(const RegionLock&) = delete;
  RegionLock& operator=(const RegionLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// Writes a small file beside its place and renames it there, so that a reader finds the old one or the new one whole.
/// \throws base::OutputError
void write_whole(const std::string& path, std::string_view bytes);

}  // namespace blockrand::run
