#include "pipeline/base/publish.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/fs.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <shared_mutex>
#include <thread>

#include "pipeline/base/error.h"
#include "pipeline/base/progress.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"

namespace blockrand::base {
namespace {

namespace fs = std::filesystem;

// What abandon_staged_folders() must know. The one piece of state of the process: signals belong to processes.
struct Abandon {
  std::shared_mutex gate;  ///< shared while a file is written, exclusive while folders are made, moved or removed
  std::atomic<bool> ended = false;
  std::vector<const StagedFolder*> folders;
  std::vector<std::string> paths, parents;
};
Abandon& abandon() {
  // Never destroyed: the signal thread may use it while static objects are destroyed.
  static auto* instance = new Abandon;
  return *instance;
}

[[noreturn]] void wait_for_the_end() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

class WriteGate {
 public:
  WriteGate() {
    if (abandon().ended) wait_for_the_end();
    abandon().gate.lock_shared();
  }
  ~WriteGate() { abandon().gate.unlock_shared(); }
  WriteGate(const WriteGate&) = delete;
  WriteGate& operator=(const WriteGate&) = delete;
};

/// What a user can do about a failed write.
std::string remedy(int error, const std::string& folder) {
  switch (error) {
    case ENOSPC: {
      struct statvfs info {};
      std::string free;
      if (::statvfs(folder.c_str(), &info) == 0)
        free = " (" + with_byte_unit(static_cast<std::uint64_t>(info.f_bavail) * info.f_frsize) + " left)";
      return "The disk is full" + free + ": free some space, or choose an output folder on another disk.";
    }
    case EDQUOT:
      return "Your disk quota is used up: remove files of yours, or choose an output folder on another disk.";
    case EFBIG:
      return "The file is larger than the limit allows: raise it (ulimit -f), or choose another file system.";
    case EROFS:
      return "The file system is mounted read-only: choose another output folder.";
    case EACCES:
    case EPERM:
      return "You may not write there: change the folder's permissions, or choose another output folder.";
    case EMFILE:
    case ENFILE:
      return "Too many files are open: raise the limit (ulimit -n), or use fewer --jobs.";
    case ENAMETOOLONG:
      return "The path is too long: choose an output folder with a shorter path.";
    case EIO:
      return "The disk reported an error: check it (dmesg), or choose an output folder on another disk.";
    case ENOENT:
      return "The folder was removed while the program ran: start again.";
    default:
      return "Choose another output folder.";
  }
}

OutputError output_error(const std::string& path, int error, const std::string& folder) {
  return OutputError(path + ": cannot write: " + std::strerror(error) + ". " + remedy(error, folder));
}

/// The same for the place that the user chose: a path that can be no folder is wrong usage.
[[noreturn]] void throw_place_error(const std::string& path, int error) {
  if (error != ENOTDIR && error != ENAMETOOLONG) throw output_error(path, error, fs::path(path).parent_path().string());
  throw UsageError(
      path + ": cannot be made: " + std::strerror(error) + ". " +
      (error == ENOTDIR ? "A part of its path is a file: choose another output folder." : remedy(error, "")));
}

bool is_empty_folder(const std::string& path) {
  std::error_code error;
  return fs::is_empty(path, error) && !error;
}

bool remove_tree(const std::string& path) noexcept {
  // Another thread may add a file between the listing and the removal of its folder: try again.
  for (int attempt = 0; attempt < 5; ++attempt) {
    std::error_code error;
    fs::remove_all(path, error);
    if (!error) return true;
  }
  return false;
}

bool exchange_paths(const std::string& a, const std::string& b) {
  return ::syscall(SYS_renameat2, AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

/// The pid at the end of `name` if it is `prefix` + pid, else 0.
pid_t pid_after(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return 0;
  name.remove_prefix(prefix.size());
  pid_t pid = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), pid);
  // A folder's second staging folder of one process has ".2" and so on.
  return error == std::errc() && (end == name.data() + name.size() || *end == '.') ? pid : 0;
}

std::string sibling(const std::string& target, const std::string& suffix) {
  const fs::path path(target);
  return fmt::format("{}/.{}{}", path.parent_path() == "/" ? "" : path.parent_path().string(), path.filename().string(),
                     suffix);
}

int lock_folder(const std::string& path) {
  const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0 && ::flock(folder, LOCK_EX | LOCK_NB) != 0) {
    // File systems without locks leave the pid as the only sign of life.
    const int error = errno;
    ::close(folder);
    errno = error;
    return -1;
  }
  return folder;
}

std::string resolve_target(const std::string& given) {
  if (given.empty()) throw UsageError("no output folder is given. Name one with --output FOLDER.");
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(given), error);
  if (error) {
    if (error.value() == ENOTDIR)
      throw UsageError(
          given + ": a part of this path is a file, so no folder can be made there. Choose another output folder.");
    throw UsageError(given + ": " + error.message() + ". Choose another output folder.");
  }
  // "out/" of a folder that does not exist yet keeps its slash.
  if (!path.has_filename()) path = path.parent_path();
  if (!path.has_filename())
    throw UsageError(given + ": the root folder cannot be an output folder. Choose a folder in it.");
  return path.string();
}

/// "a.txt, b.txt and 3 more files"
std::string listed(const std::vector<std::string>& files) {
  constexpr std::size_t kNamed = 10;
  std::string out;
  for (std::size_t i = 0; i < files.size() && i < kNamed; ++i) out += (i > 0 ? ", " : "") + files[i];
  return files.size() <= kNamed ? out : out + fmt::format(" and {} more files", files.size() - kNamed);
}

std::uint64_t size_of_tree(const std::string& path) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
    if (std::error_code no_size; entry->is_regular_file(no_size)) bytes += entry->file_size(no_size);
  return bytes;
}

void check_target(const std::string& target, bool force, const FolderKind& kind) {
  struct stat info {};
  if (::lstat(target.c_str(), &info) != 0) {
    if (errno == ENOENT) return;
    if (errno == ENOTDIR)
      throw UsageError(
          target + ": a part of this path is a file, so no folder can be made there. Choose another output folder.");
    throw UsageError(target + ": " + std::strerror(errno) + ". Choose another output folder.");
  }
  if (S_ISLNK(info.st_mode))
    throw OutputError(target + " is a link to nothing. Remove it, or choose another output folder.");
  if (!S_ISDIR(info.st_mode)) throw UsageError(target + " is a file, not a folder. Choose another output folder.");
  std::error_code error;
  if (fs::equivalent(target, fs::current_path(error), error) && !error)
    throw UsageError(target + " is the current folder, which cannot be replaced. Choose a folder in it.");
  struct stat parent {};
  if (::stat(fs::path(target).parent_path().c_str(), &parent) == 0 && parent.st_dev != info.st_dev)
    throw UsageError(target + " is a mount point, which cannot be replaced in one step. Choose a folder in it.");
  if (is_empty_folder(target)) return;
  if (!fs::exists(fs::path(target) / kind.marker, error))
    throw UsageError(target + " is not empty and is no earlier " + kind.name + " (it has no " + kind.marker + ")" +
                     (force ? "; --force does not replace such a folder" : "") + ". Choose another output folder.");
  if (!force)
    throw UsageError(target + " holds a " + kind.name +
                     " already. Add --force to replace it, or choose another folder.");
  if (kind.foreign)
    if (const std::vector<std::string> foreign = kind.foreign(target); !foreign.empty())
      throw UsageError(target + " holds " + listed(foreign) +
                       ", which the program did not write; --force would remove " +
                       (foreign.size() == 1 ? "it" : "them") + " with the old " + kind.name + ". Move " +
                       (foreign.size() == 1 ? "it" : "them") + " away, or choose another output folder.");
}

}  // namespace

// ---- StagedFile

struct StagedFile::State {
  std::string full_path, folder;
  PublishedFile file;
  Sha256 digest;
  bool counts_only = false;
  int descriptor = -1;
};

StagedFile::StagedFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
StagedFile::StagedFile(StagedFile&&) noexcept = default;

StagedFile::~StagedFile() {
  if (!state_ || state_->descriptor < 0) return;
  ::close(state_->descriptor);
  ::unlink(state_->full_path.c_str());
}

void StagedFile::append(std::string_view bytes) {
  state_->digest.add(bytes);
  state_->file.bytes += bytes.size();
  if (state_->counts_only) return;
  const WriteGate gate;
  while (!bytes.empty()) {
    const ssize_t n = ::write(state_->descriptor, bytes.data(), bytes.size());
    if (n >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(n));
    else if (errno != EINTR)
      throw output_error(state_->full_path, errno, state_->folder);
  }
}

PublishedFile StagedFile::close() {
  // Network file systems and quotas report a failed write here.
  const int result = state_->counts_only ? 0 : ::close(state_->descriptor);
  state_->descriptor = -1;
  if (result != 0 && errno != EINTR) throw output_error(state_->full_path, errno, state_->folder);
  state_->file.sha256 = state_->digest.finish();
  return state_->file;
}

// ---- StagedFolder

StagedFolder::StagedFolder(std::string target, bool force, FolderKind kind)
    : target_(resolve_target(target)), force_(force), kind_(std::move(kind)) {
  if (abandon().ended) wait_for_the_end();
  const std::unique_lock gate(abandon().gate);
  if (!kind_.counts_only) remove_stale();
  try {
    check_target(target_, force, kind_);
  } catch (const UsageError& error) {
    std::string also;
    for (const std::string& left : removed_) also += ". Removed what a run that died left: " + left;
    throw UsageError(error.what() + also);
  }
  if (kind_.counts_only)
    check_writable();
  else
    make_staging();
}

/// As far as that can be said without trying.
void StagedFolder::check_writable() {
  fs::path parent = fs::path(target_).parent_path();
  while (!fs::exists(parent)) parent = parent.parent_path();
  if (::access(parent.c_str(), W_OK | X_OK) != 0) throw_place_error(target_, errno);
  staging_ = parent.string();
}

void StagedFolder::make_staging() {
  const auto undo = [this] {
    for (auto parent = made_parents_.rbegin(); parent != made_parents_.rend(); ++parent) ::rmdir(parent->c_str());
  };
  std::vector<std::string> missing;
  for (fs::path p = fs::path(target_).parent_path(); !fs::exists(p); p = p.parent_path()) missing.push_back(p.string());
  for (auto parent = missing.rbegin(); parent != missing.rend(); ++parent) {
    if (::mkdir(parent->c_str(), 0777) == 0) {
      made_parents_.push_back(*parent);
    } else if (errno != EEXIST) {
      const int error = errno;
      undo();
      throw_place_error(*parent, error);
    }
  }
  const std::string base = sibling(target_, ".part-" + std::to_string(::getpid()));
  staging_ = base;
  for (int n = 2; ::mkdir(staging_.c_str(), 0777) != 0; ++n) {
    if (errno == EEXIST && n < 100) {
      staging_ = base + "." + std::to_string(n);
      continue;
    }
    const int error = errno;
    undo();
    throw_place_error(target_, error);
  }
  lock_ = lock_folder(staging_);
  abandon().folders.push_back(this);
  abandon().paths.push_back(staging_);
  abandon().parents.insert(abandon().parents.end(), made_parents_.begin(), made_parents_.end());
}

StagedFolder::~StagedFolder() {
  if (kind_.counts_only) return;
  if (abandon().ended) wait_for_the_end();
  const std::unique_lock gate(abandon().gate);
  auto& a = abandon();
  if (const auto found = std::find(a.folders.begin(), a.folders.end(), this); found != a.folders.end()) {
    a.paths.erase(a.paths.begin() + (found - a.folders.begin()));
    a.folders.erase(found);
  }
  for (const std::string& parent : made_parents_) std::erase(a.parents, parent);
  if (!published_) {
    remove_tree(staging_);
    for (auto parent = made_parents_.rbegin(); parent != made_parents_.rend(); ++parent) ::rmdir(parent->c_str());
  }
  if (lock_ >= 0) ::close(lock_);
}

void StagedFolder::remove_stale() {
  const fs::path path(target_);
  const std::string part = fs::path(sibling(target_, ".part-")).filename().string();
  const std::string old = fs::path(sibling(target_, ".old-")).filename().string();
  std::error_code error;
  std::vector<std::string> aside, stale;
  for (fs::directory_iterator entry(path.parent_path(), error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const pid_t of_part = pid_after(name, part), of_old = pid_after(name, old);
    const pid_t pid = of_part > 0 ? of_part : of_old;
    // In a container every run may have the same pid: a folder with ours is ours only while it is locked.
    if (pid <= 0 || (pid != ::getpid() && (::kill(pid, 0) == 0 || errno != ESRCH))) continue;
    const int lock = lock_folder(entry->path().string());
    if (lock < 0 && errno == EWOULDBLOCK) continue;
    if (lock >= 0) ::close(lock);
    (of_part > 0 ? stale : aside).push_back(entry->path().string());
  }
  std::sort(aside.begin(), aside.end());
  for (const std::string& build : aside) {
    // Its process died between the two renames of publish(): this is the user's only build.
    if (!fs::exists(target_, error) && ::rename(build.c_str(), target_.c_str()) == 0) continue;
    remove_tree(build);
  }
  for (const std::string& folder : stale) {
    const std::string size = with_byte_unit(size_of_tree(folder));
    if (remove_tree(folder)) removed_.push_back(folder + " (" + size + ")");
  }
}

StagedFile StagedFolder::create(const std::string& relative_path) {
  auto state = std::make_unique<StagedFile::State>();
  state->file.path = relative_path;
  state->full_path = staging_ + "/" + relative_path;
  state->folder = staging_;
  state->counts_only = kind_.counts_only;
  if (state->counts_only) return StagedFile(std::move(state));
  const WriteGate gate;
  std::error_code error;
  fs::create_directories(fs::path(state->full_path).parent_path(), error);
  if (error) throw output_error(state->full_path, error.value(), staging_);
  state->descriptor = ::open(state->full_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (state->descriptor < 0) throw output_error(state->full_path, errno, staging_);
  return StagedFile(std::move(state));
}

PublishedFile StagedFolder::write(const std::string& relative_path, std::string_view bytes) {
  StagedFile file = create(relative_path);
  file.append(bytes);
  return file.close();
}

void StagedFolder::link(const PublishedFile& file, const std::string& place) {
  const std::string path = staging_ + "/" + file.path;
  const WriteGate gate;
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  if (error) throw output_error(path, error.value(), staging_);
  if (::link(place.c_str(), path.c_str()) == 0) return;
  fs::copy_file(place, path, error);
  if (error) throw output_error(path, error.value(), staging_);
}

PublishedFile StagedFolder::adopt(const std::string& relative_path) const {
  const std::string path = staging_ + "/" + relative_path;
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(path, error);
  if (error) throw output_error(path, error.value(), staging_);
  try {
    return {relative_path, bytes, sha256_file(path)};
  } catch (const InputError& unreadable) {
    throw OutputError(unreadable.what());
  }
}

std::uint64_t StagedFolder::free_bytes() const {
  struct statvfs info {};
  if (::statvfs(staging_.c_str(), &info) != 0) return 0;
  return static_cast<std::uint64_t>(info.f_bavail) * info.f_frsize;
}

std::string StagedFolder::publish() {
  assert(!kind_.counts_only);
  std::string old;  // where the old build is now
  {
    if (abandon().ended) wait_for_the_end();
    const std::unique_lock gate(abandon().gate);
    struct stat info {};
    const bool exists = ::lstat(target_.c_str(), &info) == 0 && !is_empty_folder(target_);
    if (exists) {
      // Somebody else may have used the place in the meantime.
      try {
        check_target(target_, force_, kind_);
      } catch (const UsageError& error) {
        throw OutputError(error.what());
      }
    }
    const auto fail = [this](int error) {
      return output_error(target_, error, fs::path(target_).parent_path().string());
    };
    if (!exists) {
      if (::rename(staging_.c_str(), target_.c_str()) != 0) throw fail(errno);
    } else if (exchange_paths(staging_, target_)) {
      old = staging_;
    } else {
      old = sibling(target_, ".old-" + std::to_string(::getpid()));
      if (::rename(target_.c_str(), old.c_str()) != 0) throw fail(errno);
      if (::rename(staging_.c_str(), target_.c_str()) != 0) {
        const int error = errno;
        ::rename(old.c_str(), target_.c_str());
        throw fail(error);
      }
    }
    published_ = true;
    auto& a = abandon();
    if (const auto found = std::find(a.folders.begin(), a.folders.end(), this); found != a.folders.end()) {
      // An interruption from now on finishes the removal of the old build.
      a.paths[static_cast<std::size_t>(found - a.folders.begin())] = old;
      for (const std::string& parent : made_parents_) std::erase(a.parents, parent);
    }
  }
  if (!old.empty() && !remove_tree(old)) return old;
  return {};
}

std::string StagedFolder::publish_beside(const std::string& word) {
  std::error_code error;
  if (fs::exists(target_, error) && !is_empty_folder(target_)) {
    target_ += "." + word;
    force_ = true;
  }
  publish();
  return target_;
}

void tell_removed(const StagedFolder& folder, Progress& progress) {
  for (const std::string& left : folder.removed()) progress.warn("removed what a run that died left: " + left);
}

void refuse_inputs_in(const std::string& target, const std::vector<std::string>& inputs) {
  if (target.empty()) return;  // refused elsewhere
  const fs::path folder = resolve_target(target);
  for (const std::string& path : inputs) {
    std::error_code error;
    if (path.empty() || !fs::exists(path, error)) continue;
    const fs::path inner = fs::weakly_canonical(fs::absolute(path), error);
    if (!error && std::mismatch(folder.begin(), folder.end(), inner.begin(), inner.end()).first == folder.end())
      throw UsageError(path + " lies in the output folder " + target +
                       ", which is replaced as a whole. Move it, or choose another output folder.");
  }
}

void abandon_staged_folders() noexcept {
  auto& a = abandon();
  if (a.ended.exchange(true)) return;
  a.gate.lock();  // never unlocked: nobody may write again
  for (const std::string& path : a.paths)
    if (!path.empty()) remove_tree(path);
  for (auto parent = a.parents.rbegin(); parent != a.parents.rend(); ++parent) ::rmdir(parent->c_str());
}

}  // namespace blockrand::base
