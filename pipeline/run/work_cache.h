// Work of earlier runs, kept on disk by what it was made from: a folder of entries, each named by the hash of everything that it
// depends on, so that none is ever wrong, only of no more use.
//
//   cache/program            the mark of such a folder; whose work it is (program_identity)
//   cache/open               there while a run works: one that did not end leaves it
//   cache/<kind>/ab/<key>/   an entry: `entry` (its bytes with their hash), 0, 1, … (its files, hard links to those of builds)
//   cache/new/               entries in the making
//   cache/parts              of which parts each tile was made in the last run: says why it is built again; parts.AREA in areas
//   cache/of/N               in a region: which entries build N used
//
// An entry appears by the renaming of its folder. Killed at any instant, a run leaves whole entries and what is in `new`, which the
// next one removes. Nothing but this program writes there.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/memo.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/publish.h"

namespace blockrand::run {

/// Several threads may use one at a time. Two processes must not: who opens one holds its lock.
class WorkCache {
 public:
  /// Says that a process worked there which may have been killed: who opens it next reads all of it. A folder that is no cache yet
  /// stays as it is.
  static void mark_open(const std::string& folder);

  enum class Mode {
    work,  ///< alone: with the lock
    part,  ///< a process of one that has the lock
    look   ///< beside others: nothing is locked, written or removed
  };
  /// Opens the folder, makes it where it is missing, and says what a newer program leaves of no use. After a run that did not end
  /// all of it is read, and what is damaged removed.
  /// \throws base::OutputError  it cannot be written
  /// \throws base::UsageError   another process works with it, or it is no such folder
  /// \param area  notes on its pieces are kept apart: "11_1093_805"; empty: one file for all
  WorkCache(std::string folder, const std::string& program, base::Progress& progress, Mode mode = Mode::work,
            std::string area = {});
  /// Of a run that ended: what lies there is known to be whole.
  ~WorkCache();
  WorkCache(const WorkCache&) = delete;
  WorkCache& operator=(const WorkCache&) = delete;

  struct Found {
    std::string bytes;
    std::vector<base::PublishedFile> files;
    std::vector<std::string> places;  ///< parallel to `files`: where their content lies
  };
  /// An entry; nothing where there is none, or a damaged one, which is removed. Contents of files are read where they may have
  /// changed since: their time differs.
  std::optional<Found> find(std::string_view kind, const std::string& key);

  /// Whether there is one; it is not read.
  bool has(std::string_view kind, const std::string& key) const;

  /// Keeps an entry. Where that fails (the disk is full), the run goes on without, and is told so at its end.
  /// \param files   below `folder`; they must change no more
  void keep(std::string_view kind, const std::string& key, std::string_view bytes,
            std::span<const base::PublishedFile> files, const std::string& folder);

  /// "kind/key" of what was found or kept, ascending.
  std::set<std::string> used() const;

  /// What a piece was made from when it was last worked on, in parts: tells a later run why it is another one now. Nothing where
  /// none was noted.
  std::optional<std::vector<std::uint64_t>> parts_before(const std::string& piece) const;
  /// Notes it. Written at the end.
  void note_parts(const std::string& piece, std::span<const std::uint64_t> parts);
  /// Notes again what was noted before: the piece was not looked into.
  void keep_note(const std::string& piece);

  std::uint64_t damaged() const { return damaged_; }  ///< entries that were removed because of it
  /// Why an entry could not be kept; empty: all were.
  std::string trouble() const;

 private:
  std::string place(std::string_view kind, const std::string& key) const;
  std::string notes() const;
  void read_parts();

  std::string folder_, area_;
  Mode mode_;
  int lock_ = -1;
  mutable std::mutex mutex_;
  std::set<std::string> used_;
  std::map<std::string, std::vector<std::uint64_t>> parts_before_, parts_;  ///< by piece
  std::string trouble_;
  std::atomic<std::uint64_t> damaged_{0}, made_{0};
};

/// Pieces of work that have no files. \param cache  outlives the result \param shared  as base::Memo has it
base::Memo memo_in(WorkCache& cache, std::string shared);

/// Notes what a build used, under its name, and removes every entry that no build of `builds` used, with the notes of others.
/// \param builds  names, that of this one among them
/// \throws base::OutputError  the note cannot be written
void keep_work_of(const std::string& folder, const std::string& build, const std::set<std::string>& used,
                  const std::set<std::string>& builds);

/// What a build noted. An entry that an area used stands behind the area: "11/1093/805 tiles/…".
std::set<std::string> work_of(const std::string& folder, const std::string& build);

// ---- The folder as a user asks about it.

struct CacheFigures {
  std::uint64_t entries = 0, bytes = 0, files = 0;
  std::uint64_t shared_bytes = 0;  ///< of files that builds have too: they take no room of their own
  std::uint64_t damaged = 0;       ///< where that was looked for
  std::uint64_t removed = 0;
  std::string program;
};
/// \throws base::InputError  it is no such folder
CacheFigures cache_figures(const std::string& folder);
/// Reads everything and removes entries that are damaged. \throws as WorkCache
CacheFigures verify_cache(const std::string& folder, base::Progress& progress);
/// Removes entries, those first that were of use the longest ago, until the others take at most `bytes` of their own.
/// \throws as WorkCache
CacheFigures prune_cache(const std::string& folder, std::uint64_t bytes, base::Progress& progress);

}  // namespace blockrand::run
