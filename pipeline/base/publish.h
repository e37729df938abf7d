// Output is written beside its place and moved there at the end: an interrupted run leaves the old build intact.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::base {

struct PublishedFile {
  std::string path;  ///< relative to the output folder, '/' separated
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// A folder in the making. Files go to a staging folder `.<name>.part-<pid>` beside the target; publish() swaps it in.
/// The destructor of an unpublished one removes the staging folder. Stale staging folders of dead processes are removed
/// when a new one for the same target is made.
class StagedFolder {
 public:
  /// \param target  the folder to be; its parent must exist or be creatable
  /// \param force   replace an existing, non-empty folder. Without it such a target is a UsageError. Even with `force`
  ///                a folder that is neither empty nor an earlier build (no build.json in it) is refused.
  /// \throws UsageError when the target's place cannot be used (parent is a file, target is a file, no permission)
  StagedFolder(std::string target, bool force);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Writes a whole file and notes its hash. Safe from several threads for distinct paths.
  /// \throws OutputError (disk full, file too large, permission) naming path and remedy
  PublishedFile write(const std::string& relative_path, std::string_view bytes);

  /// Bytes free for the user where the folder lies.
  std::uint64_t free_bytes() const;

  /// Makes the build visible under its name: renames the old folder away, the new one in, then removes the old one.
  /// \throws OutputError; the old build is then back in its place
  void publish();

  const std::string& staging_path() const { return staging_; }

 private:
  std::string target_, staging_;
  bool published_ = false;
};

}  // namespace blockrand::base
