// Output is written beside its place and moved there at the end: an interrupted run leaves the old build intact.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace blockrand::base {

class Progress;

struct PublishedFile {
  std::string path;  ///< relative to the output folder, '/' separated
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// A file of a StagedFolder that is written piece by piece. One thread at a time.
class StagedFile {
 public:
  StagedFile(StagedFile&&) noexcept;
  /// A file that was not closed is removed.
  ~StagedFile();

  /// \throws OutputError (disk full, file too large, permission) naming path and remedy
  void append(std::string_view bytes);
  /// Ends the file. \throws OutputError as append
  PublishedFile close();

 private:
  friend class StagedFolder;
  struct State;
  explicit StagedFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// What an output folder holds, for messages, and the file in it by which an earlier one is known.
struct FolderKind {
  std::string name = "build", marker = "build.json";
  /// Files in an earlier one that the program did not write, relative to it. Empty: nobody looks.
  std::function<std::vector<std::string>(const std::string& folder)> foreign = {};
  /// Nothing is written nor made, not even a parent: files are counted as if they were. Such a folder cannot be published.
  bool counts_only = false;
};

/// A folder in the making. Files go to a staging folder `.<name>.part-<pid>` beside the target; publish() swaps it in.
/// The destructor of an unpublished one removes the staging folder and the parents that were made for it. Stale staging
/// folders of dead processes are removed when a new one for the same target is made; an old build that a process set
/// aside and died over is put back.
class StagedFolder {
 public:
  /// \param target  the folder to be; its parent must exist or be creatable. A link to a folder stands for the folder.
  /// \param force   replace an existing, non-empty folder. Without it such a target is a UsageError. Even with `force`
  ///                a folder that is neither empty nor an earlier one of its kind is refused, or that holds files which
  ///                the program did not write.
  /// \throws UsageError when the target's place cannot be used (parent is a file, target is a file, files of others)
  /// \throws OutputError when nothing can be written there: permission, a full disk, a link to nothing
  /// \param kind    what such folders hold, and the file that tells an earlier one
  StagedFolder(std::string target, bool force, FolderKind kind = {});
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Writes a whole file and notes its hash. Folders on the way are made. Safe from several threads for distinct paths.
  /// \throws OutputError (disk full, file too large, permission) naming path and remedy
  PublishedFile write(const std::string& relative_path, std::string_view bytes);

  /// Starts a file that is written piece by piece. Safe as write(). The folder must outlive it.
  StagedFile create(const std::string& relative_path);

  /// Takes in a file of an earlier run: one on disk with it where the file system can (a hard link), else a copy. The file at
  /// `place` must not change afterwards. Safe as write(). \throws OutputError as write
  void link(const PublishedFile& file, const std::string& place);

  /// Takes in a file that a library wrote itself below staging_path(): notes its size and hash.
  /// \throws OutputError when it cannot be read
  PublishedFile adopt(const std::string& relative_path) const;

  /// Bytes free for the user where the folder lies.
  std::uint64_t free_bytes() const;

  /// Makes the build visible under its name: exchanges the old folder and the new one in one step where the file system
  /// can, else renames the old one away and the new one in; then removes the old one.
  /// \returns the path of the old build where it could not be removed, else empty
  /// \throws OutputError; the old build is then back in its place
  std::string publish();

  /// publish() for a result that must not replace an earlier one: where the target holds one, the new folder lies beside
  /// it, as `<target>.<word>`, else in its place. What lay under that name is replaced as publish() does.
  /// \returns where it lies
  std::string publish_beside(const std::string& word);

  /// Staging folders of processes that died, removed when this one was made: with their size, for the user to know.
  const std::vector<std::string>& removed() const { return removed_; }

  const std::string& staging_path() const { return staging_; }
  /// The folder to be, as an absolute path without links.
  const std::string& target_path() const { return target_; }

 private:
  void remove_stale();

  void make_staging();
  void check_writable();

  std::string target_, staging_;
  std::vector<std::string> made_parents_;  ///< outermost first
  std::vector<std::string> removed_;
  bool force_ = false, published_ = false;
  FolderKind kind_;
  int lock_ = -1;  ///< descriptor of the locked staging folder: others see that its process lives
};

/// Warns of what StagedFolder::removed() lists.
void tell_removed(const StagedFolder& folder, Progress& progress);

/// \param inputs  paths; empty ones, and such as name no file (rule sets have names, too), do not count
/// \throws UsageError  one of them lies in the folder `target`, which would be replaced with it
void refuse_inputs_in(const std::string& target, const std::vector<std::string>& inputs);

/// For a signal handler's thread that ends the process next: removes the staging folders of all StagedFolders of this
/// process and stops every further write (writers then wait for the end of the process). A publish() that is already
/// moving folders is waited for, so that a target is always the whole old build or the whole new one.
void abandon_staged_folders() noexcept;

}  // namespace blockrand::base
