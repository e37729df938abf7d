#include "pipeline/run/work_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "pipeline/base/error.h"
#include "pipeline/base/host.h"
#include "pipeline/base/pack.h"
#include "pipeline/base/sha256.h"
#include "pipeline/base/text.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEntry = "entry", kNew = "new", kProgram = "program", kOpen = "open", kLock = "lock",
                           kOf = "of", kParts = "parts";
constexpr std::size_t kHashLength = 64;  // hex digits of a SHA-256
/// What `program` begins with: a folder is known by it.
constexpr std::string_view kMark = "blockrand kept work\n";

struct KeptFile {
  base::PublishedFile file;
  std::int64_t changed = 0;  ///< ns since 1970, of its content
};

struct Stored {
  std::vector<KeptFile> files;
  std::string bytes;
};

std::optional<std::string> read_all(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return std::nullopt;
  struct stat s {};
  bool whole = ::fstat(descriptor, &s) == 0 && S_ISREG(s.st_mode);
  std::string bytes(whole ? static_cast<std::size_t>(s.st_size) : 0, '\0');
  for (std::size_t at = 0; whole && at < bytes.size();) {
    const ssize_t n = ::read(descriptor, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) whole = false;
    if (n > 0) at += static_cast<std::size_t>(n);
  }
  ::close(descriptor);
  if (!whole) return std::nullopt;
  return bytes;
}

void write_all(const std::string& path, std::string_view bytes) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) throw base::OutputError(path + ": " + std::strerror(errno));
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      ::close(descriptor);
      throw base::OutputError(path + ": " + std::strerror(error));
    }
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  if (::close(descriptor) != 0) throw base::OutputError(path + ": " + std::strerror(errno));
}

std::int64_t changed_of(const struct stat& s) {
  return static_cast<std::int64_t>(s.st_mtim.tv_sec) * 1'000'000'000 + s.st_mtim.tv_nsec;
}

/// \returns nothing where the entry is damaged
std::optional<Stored> read_entry(const std::string& folder) {
  const std::optional<std::string> bytes = read_all(folder + "/" + std::string(kEntry));
  if (!bytes || bytes->size() < kHashLength) return std::nullopt;
  const std::string_view content = std::string_view(*bytes).substr(0, bytes->size() - kHashLength);
  if (base::sha256_of(content) != bytes->substr(content.size())) return std::nullopt;
  try {
    Stored stored = base::unpacked<Stored>(content);
    // Whoever can write there must not write elsewhere by it.
    for (const KeptFile& kept : stored.files)
      for (const fs::path& part : fs::path("/" + kept.file.path).relative_path())
        if (part == ".." || kept.file.path.starts_with('/')) return std::nullopt;
    return stored;
  } catch (const base::UnpackError&) {
    return std::nullopt;
  }
}

bool file_is_whole(const std::string& path, const KeptFile& kept, bool read) {
  struct stat s {};
  if (::lstat(path.c_str(), &s) != 0 || !S_ISREG(s.st_mode) || static_cast<std::uint64_t>(s.st_size) != kept.file.bytes)
    return false;
  if (!read && changed_of(s) == kept.changed) return true;
  try {
    return base::sha256_file(path) == kept.file.sha256;
  } catch (const base::InputError&) {
    return false;
  }
}

bool entry_is_whole(const std::string& folder, const Stored& stored, bool read) {
  for (std::size_t i = 0; i < stored.files.size(); ++i)
    if (!file_is_whole(folder + "/" + std::to_string(i), stored.files[i], read)) return false;
  return true;
}

bool is_hex(const std::string& text, std::size_t length) {
  return text.size() == length && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Calls `visit` with kind, key and path of each entry: of what looks like one. Links are not followed.
template <class Visit>
void for_each_entry(const std::string& folder, Visit&& visit) {
  const auto folders_in = [](const fs::path& place) {
    std::vector<fs::path> out;
    std::error_code error;
    for (fs::directory_iterator entry(place, error), end; !error && entry != end; entry.increment(error))
      // Asked of the entry and not of its path: the folder that lists it says it, for most file systems.
      if (std::error_code no_status; !entry->is_symlink(no_status) && entry->is_directory(no_status))
        out.push_back(entry->path());
    return out;
  };
  for (const fs::path& kind : folders_in(folder)) {
    const std::string name = kind.filename().string();
    if (name == kNew || name == kOf) continue;
    for (const fs::path& part : folders_in(kind)) {
      if (!is_hex(part.filename().string(), 2)) continue;
      for (const fs::path& entry : folders_in(part))
        if (const std::string key = entry.filename().string(); is_hex(key, kHashLength))
          visit(name, key, entry.string());
    }
  }
}

/// \returns how many
std::uint64_t remove_damaged(const std::string& folder) {
  std::uint64_t damaged = 0;
  for_each_entry(folder, [&](const std::string&, const std::string&, const std::string& path) {
    const std::optional<Stored> stored = read_entry(path);
    if (stored && entry_is_whole(path, *stored, true)) return;
    std::error_code error;
    fs::remove_all(path, error);
    ++damaged;
  });
  return damaged;
}

std::uint64_t count_entries(const std::string& folder) {
  std::uint64_t n = 0;
  for_each_entry(folder, [&](const std::string&, const std::string&, const std::string&) { ++n; });
  return n;
}

void remove(const std::string& path) {
  std::error_code error;
  fs::remove_all(path, error);
}

/// The program whose work it is; nothing where the folder is none of kept work.
std::optional<std::string> program_of(const std::string& folder) {
  std::optional<std::string> text = read_all(folder + "/" + std::string(kProgram));
  if (!text || !text->starts_with(kMark)) return std::nullopt;
  return text->substr(kMark.size());
}

/// \throws base::UsageError  it is there, and neither one of kept work nor empty (but for what a run that was killed while it made
///                           one left)
void check_is_cache(const std::string& folder) {
  std::error_code error;
  if (!fs::exists(folder, error) || program_of(folder)) return;
  bool ours = fs::is_directory(folder, error);
  for (fs::directory_iterator entry(folder, error), end; ours && !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code not_empty;
    ours = name == kLock || name == kOpen || name == std::string(kProgram) + ".new" ||
           (name == kNew && fs::is_empty(entry->path(), not_empty));
  }
  if (!ours) throw base::UsageError(folder + ": is no folder of kept work, and not empty: name another one");
}

}  // namespace

WorkCache::WorkCache(std::string folder, const std::string& program, base::Progress& progress, Mode mode,
                     std::string area)
    : folder_(std::move(folder)), area_(std::move(area)), mode_(mode) {
  check_is_cache(folder_);
  read_parts();
  if (mode_ != Mode::work) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw base::OutputError(folder_ + ": cannot be made: " + error.message());
  lock_ = ::open((folder_ + "/" + std::string(kLock)).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) throw base::OutputError(folder_ + ": cannot be written: " + std::strerror(errno));
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    ::close(lock_);
    if (reason != EWOULDBLOCK) throw base::OutputError(folder_ + ": cannot be locked: " + std::strerror(reason));
    throw base::UsageError(folder_ + ": another run works with it. Wait for its end, or name another folder");
  }
  try {
    const std::optional<std::string> earlier = program_of(folder_);
    if (!program.empty() && earlier != program) {
      if (const std::uint64_t n = earlier ? count_entries(folder_) : 0; n > 0)
        progress.warn(
            fmt::format("{}: the program is another one than that which kept the {} pieces of work there: it "
                        "works all out anew",
                        folder_, base::with_thousands(n)));
      const std::string made_by = folder_ + "/" + std::string(kProgram);
      write_all(made_by + ".new", std::string(kMark) + program);
      fs::rename(made_by + ".new", made_by, error);
      if (error) throw base::OutputError(made_by + ": cannot be written: " + error.message());
    }
    remove(folder_ + "/" + std::string(kNew));
    fs::create_directories(folder_ + "/" + std::string(kNew), error);
    if (error) throw base::OutputError(folder_ + ": cannot be written: " + error.message());
    const std::string open = folder_ + "/" + std::string(kOpen);
    // The run before did not end: its machine may have lost what it had not written to the disk.
    if (fs::exists(open, error)) damaged_ += remove_damaged(folder_);
    write_all(open, "");
  } catch (const base::OutputError&) {
    ::close(lock_);
    throw;
  }
}

void WorkCache::mark_open(const std::string& folder) {
  if (program_of(folder)) write_all(folder + "/" + std::string(kOpen), "");
}

std::string WorkCache::notes() const {
  return folder_ + "/" + std::string(kParts) + (area_.empty() ? "" : "." + area_);
}

void WorkCache::read_parts() {
  if (const std::optional<std::string> noted = read_all(notes())) try {
      parts_before_ = base::unpacked<std::map<std::string, std::vector<std::uint64_t>>>(*noted);
    } catch (const base::UnpackError&) {
      parts_before_.clear();
    }
}

WorkCache::~WorkCache() {
  if (mode_ == Mode::look) return;
  std::error_code error;
  // A run that fails knows of some tiles alone.
  if (std::uncaught_exceptions() > 0) parts_.merge(parts_before_);
  if (!parts_.empty()) try {
      const std::string place = notes();
      write_all(place + ".new", base::packed(parts_));
      fs::rename(place + ".new", place, error);
    } catch (const base::OutputError&) {
      // The next run does not know why, and no more.
    }
  if (mode_ == Mode::part) return;
  // Only what the disk has is known to be whole.
  if (::syncfs(lock_) == 0) fs::remove(folder_ + "/" + std::string(kOpen), error);
  ::close(lock_);
}

std::string WorkCache::place(std::string_view kind, const std::string& key) const {
  return folder_ + "/" + std::string(kind) + "/" + key.substr(0, 2) + "/" + key;
}

std::optional<WorkCache::Found> WorkCache::find(std::string_view kind, const std::string& key) {
  const std::string folder = place(kind, key);
  std::error_code error;
  if (!fs::exists(folder, error)) return std::nullopt;
  std::optional<Stored> stored = read_entry(folder);
  if (!stored || !entry_is_whole(folder, *stored, false)) {
    if (mode_ != Mode::look) remove(folder);
    ++damaged_;
    return std::nullopt;
  }
  Found found;
  found.bytes = std::move(stored->bytes);
  for (std::size_t i = 0; i < stored->files.size(); ++i) {
    found.files.push_back(std::move(stored->files[i].file));
    found.places.push_back(folder + "/" + std::to_string(i));
  }
  // The time of its folder says when it was last of use.
  if (mode_ != Mode::look) ::utimensat(AT_FDCWD, folder.c_str(), nullptr, 0);
  const std::lock_guard lock(mutex_);
  used_.insert(std::string(kind) + "/" + key);
  return found;
}

bool WorkCache::has(std::string_view kind, const std::string& key) const {
  std::error_code error;
  return fs::exists(place(kind, key), error);
}

void WorkCache::keep(std::string_view kind, const std::string& key, std::string_view bytes,
                     std::span<const base::PublishedFile> files, const std::string& folder) {
  if (mode_ == Mode::look) return;
  // Hosts that share a disk have the same numbers of processes.
  const std::string making = fmt::format("{}/{}/{}-{}", folder_, kNew, base::process_name(), made_++);
  try {
    std::error_code error;
    fs::create_directory(making, error);
    if (error) throw base::OutputError(making + ": " + error.message());
    Stored stored;
    stored.bytes = bytes;
    for (std::size_t i = 0; i < files.size(); ++i) {
      const std::string from = folder + "/" + files[i].path, to = making + "/" + std::to_string(i);
      if (::link(from.c_str(), to.c_str()) != 0) {
        fs::copy_file(from, to, error);  // another disk, too many links
        if (error) throw base::OutputError(to + ": " + error.message());
      }
      struct stat s {};
      if (::stat(to.c_str(), &s) != 0) throw base::OutputError(to + ": " + std::strerror(errno));
      stored.files.push_back({files[i], changed_of(s)});
    }
    std::string content = base::packed(stored);
    content += base::sha256_of(content);
    write_all(making + "/" + std::string(kEntry), content);
    const std::string to = place(kind, key);
    fs::create_directories(fs::path(to).parent_path(), error);
    fs::rename(making, to, error);
    if (error && !fs::exists(to)) throw base::OutputError(to + ": " + error.message());
    if (error) remove(making);
    const std::lock_guard lock(mutex_);
    used_.insert(std::string(kind) + "/" + key);
  } catch (const base::OutputError& failed) {
    remove(making);
    const std::lock_guard lock(mutex_);
    if (trouble_.empty()) trouble_ = failed.what();
  }
}

std::optional<std::vector<std::uint64_t>> WorkCache::parts_before(const std::string& piece) const {
  const auto found = parts_before_.find(piece);
  return found == parts_before_.end() ? std::nullopt : std::optional(found->second);
}

void WorkCache::note_parts(const std::string& piece, std::span<const std::uint64_t> parts) {
  const std::lock_guard lock(mutex_);
  parts_[piece].assign(parts.begin(), parts.end());
}

void WorkCache::keep_note(const std::string& piece) {
  if (const std::optional<std::vector<std::uint64_t>> parts = parts_before(piece)) note_parts(piece, *parts);
}

std::set<std::string> WorkCache::used() const {
  const std::lock_guard lock(mutex_);
  return used_;
}

std::string WorkCache::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

base::Memo memo_in(WorkCache& cache, std::string shared) {
  return {.shared = std::move(shared),
          .find = [&cache](std::string_view kind, const std::string& key) -> std::optional<std::string> {
            std::optional<WorkCache::Found> found = cache.find(kind, key);
            return found ? std::optional(std::move(found->bytes)) : std::nullopt;
          },
          .keep = [&cache](std::string_view kind, const std::string& key,
                           std::string_view bytes) { cache.keep(kind, key, bytes, {}, ""); }};
}

void keep_work_of(const std::string& folder, const std::string& build, const std::set<std::string>& used,
                  const std::set<std::string>& builds) {
  const std::string notes = folder + "/" + std::string(kOf);
  std::error_code error;
  fs::create_directories(notes, error);
  std::string text;
  for (const std::string& name : used) text += name + "\n";
  write_all(notes + "/" + build + ".new", text);
  fs::rename(notes + "/" + build + ".new", notes + "/" + build, error);
  const auto entry_of = [](const std::string& line) { return line.substr(line.find(' ') + 1); };
  std::set<std::string> wanted;
  for (const std::string& line : used) wanted.insert(entry_of(line));
  for (fs::directory_iterator note(notes, error), end; !error && note != end; note.increment(error)) {
    const std::string name = note->path().filename().string();
    if (!builds.contains(name)) {
      remove(note->path().string());
      continue;
    }
    std::ifstream lines(note->path());
    for (std::string line; std::getline(lines, line);) wanted.insert(entry_of(line));
  }
  std::vector<std::string> unused;
  for_each_entry(folder, [&](const std::string& kind, const std::string& key, const std::string& path) {
    if (!wanted.contains(kind + "/" + key)) unused.push_back(path);
  });
  for (const std::string& path : unused) remove(path);
}

std::set<std::string> work_of(const std::string& folder, const std::string& build) {
  std::set<std::string> out;
  std::ifstream lines(folder + "/" + std::string(kOf) + "/" + build);
  for (std::string line; std::getline(lines, line);) out.insert(line);
  return out;
}

// ---- questions of a user

namespace {

struct EntrySize {
  std::uint64_t bytes = 0, shared = 0, files = 0;
};

EntrySize size_of(const std::string& entry) {
  EntrySize size;
  std::error_code error;
  for (fs::directory_iterator file(entry, error), end; !error && file != end; file.increment(error)) {
    struct stat s {};
    if (::stat(file->path().c_str(), &s) != 0) continue;
    ++size.files;
    size.bytes += static_cast<std::uint64_t>(s.st_size);
    if (s.st_nlink > 1) size.shared += static_cast<std::uint64_t>(s.st_size);
  }
  return size;
}

void require(const std::string& folder) {
  if (!program_of(folder))
    throw base::InputError(folder, "", "holds no kept work",
                           "Name the folder cache/ of a region, or that of build --cache");
}

}  // namespace

CacheFigures cache_figures(const std::string& folder) {
  require(folder);
  CacheFigures figures;
  figures.program = program_of(folder).value_or("");
  for_each_entry(folder, [&](const std::string&, const std::string&, const std::string& path) {
    const EntrySize size = size_of(path);
    ++figures.entries;
    figures.bytes += size.bytes, figures.shared_bytes += size.shared, figures.files += size.files;
  });
  return figures;
}

CacheFigures verify_cache(const std::string& folder, base::Progress& progress) {
  require(folder);
  const WorkCache opened(folder, "", progress);
  const std::uint64_t damaged = opened.damaged() + remove_damaged(folder);
  CacheFigures figures = cache_figures(folder);
  figures.damaged = figures.removed = damaged;
  return figures;
}

CacheFigures prune_cache(const std::string& folder, std::uint64_t bytes, base::Progress& progress) {
  require(folder);
  const WorkCache opened(folder, "", progress);
  struct Entry {
    std::int64_t used = 0;
    std::string path;
    std::uint64_t bytes = 0;
  };
  std::vector<Entry> entries;
  std::uint64_t sum = 0;
  for_each_entry(folder, [&](const std::string&, const std::string&, const std::string& path) {
    struct stat s {};
    if (::stat(path.c_str(), &s) != 0) return;
    const EntrySize size = size_of(path);
    entries.push_back({changed_of(s), path, size.bytes - size.shared});
    sum += entries.back().bytes;
  });
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return std::tie(a.used, a.path) < std::tie(b.used, b.path); });
  std::uint64_t removed = 0;
  for (const Entry& entry : entries) {
    if (sum <= bytes) break;
    remove(entry.path);
    sum -= entry.bytes;
    ++removed;
  }
  CacheFigures figures = cache_figures(folder);
  figures.removed = removed;
  return figures;
}

}  // namespace blockrand::run
