#include "pipeline/run/region_folder.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/base/host.h"
#include "pipeline/base/text.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRefused = ".refused";
/// s: a lock of another host that nobody touched for so long is stale; how often its run touches it.
constexpr std::time_t kStale = 24L * 3600;
constexpr std::chrono::seconds kTouched{300};

/// Removes a file or folder; what could not be removed is added to `failed`.
void remove_or_tell(const std::string& path, std::vector<std::string>& failed) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) failed.push_back(path + ": " + error.message());
}

/// The number that a name is or begins with, six digits, and what follows; -1: it has none.
struct Numbered {
  int number = -1;
  std::string rest;
};
Numbered numbered(const std::string& name) {
  Numbered out;
  if (name.size() < 6) return out;
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + 6, number);
  if (error == std::errc() && end == name.data() + 6) out = {number, name.substr(6)};
  return out;
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// `.000012.part-4711`: what base::StagedFolder makes beside a build.
bool is_staging(const std::string& name) {
  if (!name.starts_with('.')) return false;
  const Numbered n = numbered(name.substr(1));
  const std::size_t dash = n.rest.find('-');
  return n.number >= 0 && dash != std::string::npos && is_number(std::string_view(n.rest).substr(dash + 1));
}

/// \throws base::OutputError  nobody can tell
bool is_there(const std::string& path) {
  std::error_code error;
  const bool there = fs::exists(path, error);
  if (error) throw base::OutputError(path + ": cannot be looked at: " + error.message() + ". Nothing was removed");
  return there;
}

std::vector<fs::path> entries(const std::string& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    out.push_back(entry->path());
  std::sort(out.begin(), out.end());
  return out;
}

[[noreturn]] void cannot_write(const std::string& path, int error) {
  throw base::OutputError(path + ": cannot be written: " + std::strerror(error) +
                          ". Check permissions and free space; what is published stays as it was");
}

std::string read_all(int descriptor) {
  std::string out(4096, '\0');
  const ssize_t size = ::pread(descriptor, out.data(), out.size(), 0);
  out.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return out;
}

}  // namespace

void sync_disk(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) cannot_write(folder, errno);
  const bool synced = ::syncfs(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  if (!synced) cannot_write(folder, error);
}

RegionFolder::RegionFolder(std::string path) : path_(std::move(path)) {
  while (path_.size() > 1 && path_.ends_with('/')) path_.pop_back();
  std::error_code error;
  if (fs::exists(path_, error) && !fs::is_directory(path_, error))
    throw base::UsageError(path_ + " is a file. Name the folder of a region, or one that is to become one.");
  if (fs::exists(path_ + "/build.json", error))
    throw base::UsageError(path_ +
                           " is a build, not a region. A region is a folder of its own, which holds its builds: "
                           "name another one; the first 'blockrand update' makes it.");
  if (exists() || entries(path_).empty()) return;
  if (fs::exists(path_ + "/log/runs.jsonl", error) || fs::is_symlink(path_ + "/current", error))
    throw base::UsageError(settings() +
                           " is missing: it says how the region is built. Put it back, or write a new one.");
  throw base::UsageError(path_ + " is no region and not empty. Name a region, or a new or empty folder.");
}

std::string RegionFolder::name() const {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path_), error);
  return (error ? fs::absolute(path_).lexically_normal() : place).filename().string();
}

std::string RegionFolder::digits(int number) { return fmt::format("{:06}", number); }

bool RegionFolder::exists() const {
  std::error_code error;
  return fs::is_regular_file(settings(), error);
}

void RegionFolder::make() const {
  for (const char* folder : {"", "/store", "/builds", "/log"}) {
    std::error_code error;
    fs::create_directories(path_ + folder, error);
    if (error) cannot_write(path_ + folder, error.value());
  }
}

std::optional<int> RegionFolder::current() const {
  std::error_code error;
  const fs::path link = path_ + "/current";
  if (!fs::is_symlink(link, error)) {
    if (fs::exists(link, error))
      throw base::InputError(link.string(), "", "is no link to a build",
                             "The region was copied without its links: remove it, then blockrand rollback --to N");
    if (const std::vector<int> there = passed(); !there.empty())
      throw base::InputError(link.string(), "", "is missing, but there are builds",
                             fmt::format("Publish one: blockrand rollback {} --to {}", path_, there.back()));
    return std::nullopt;
  }
  const int number = numbered(fs::read_symlink(link, error).filename().string()).number;
  if (number < 0 || !fs::is_regular_file(build(number) + "/build.json", error))
    throw base::InputError(link.string(), "", "leads to no build",
                           "Put the build back, or go to an earlier one: blockrand rollback");
  return number;
}

std::vector<int> RegionFolder::passed() const {
  std::vector<int> out;
  std::error_code error;
  for (const fs::path& entry : entries(path_ + "/builds")) {
    const Numbered name = numbered(entry.filename().string());
    if (name.number >= 0 && name.rest.empty() && fs::is_regular_file(entry / "build.json", error) &&
        is_there(state(name.number)))
      out.push_back(name.number);
  }
  return out;
}

int RegionFolder::next() const {
  int most = 0;
  for (const char* folder : {"/builds", "/store", "/log"})
    for (const fs::path& entry : entries(path_ + folder))
      most = std::max(most, numbered(entry.filename().string()).number);
  return most + 1;
}

std::vector<std::string> RegionFolder::remove_unfinished() const {
  std::vector<std::string> removed;
  const auto remove = [&](const fs::path& path) {
    std::error_code error;
    fs::remove_all(path, error);
    if (error) throw base::OutputError(path.string() + ": cannot be removed: " + error.message());
    removed.push_back(path.string());
  };
  for (const fs::path& entry : entries(path_ + "/builds")) {
    const std::string name = entry.filename().string();
    const Numbered n = numbered(name);
    const bool lost =
        n.number >= 0 && n.rest.empty() && is_there((entry / "build.json").string()) && !is_there(state(n.number));
    if (lost || is_staging(name)) remove(entry);
  }
  for (const fs::path& entry : entries(path_ + "/store")) {
    const Numbered n = numbered(entry.filename().string());
    const bool part =
        n.rest == ".osm.pbf.part" || n.rest == ".json.part" || n.rest == ".toml.part" || n.rest == ".compare.json.part";
    const bool of_build = n.rest == ".osm.pbf" || n.rest == ".toml" || n.rest == ".compare.json";
    if (n.number >= 0 && (part || (of_build && !is_there(state(n.number))))) remove(entry);
  }
  for (const fs::path& entry : entries(path_ + "/log"))
    if (const Numbered n = numbered(entry.filename().string()); n.number >= 0 && n.rest.ends_with(".part"))
      remove(entry);
  std::error_code error;
  if (fs::is_symlink(path_ + "/current.new", error)) remove(path_ + "/current.new");
  return removed;
}

void RegionFolder::publish(int number) const {
  const std::string fresh = path_ + "/current.new", place = path_ + "/current";
  sync_disk(path_);
  ::unlink(fresh.c_str());
  if (::symlink(("builds/" + digits(number)).c_str(), fresh.c_str()) != 0) cannot_write(fresh, errno);
  if (::rename(fresh.c_str(), place.c_str()) != 0) cannot_write(place, errno);
  // From here on it is published: whether the disk has it already changes nothing for readers.
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

std::string RegionFolder::set_aside(int number) const {
  std::error_code error;
  const std::string aside = build(number) + std::string(kRefused);
  fs::rename(build(number), aside, error);
  if (error) cannot_write(aside, error.value());
  for (const fs::path& entry : entries(path_ + "/builds"))
    if (const Numbered n = numbered(entry.filename().string());
        n.number >= 0 && n.number != number && n.rest == kRefused)
      fs::remove_all(entry, error);
  for (const std::string& path : {data(number), state(number)}) fs::remove(path, error);
  return aside;
}

std::vector<int> RegionFolder::unmark(int keep, const std::vector<int>& also, std::vector<std::string>& failed) const {
  const std::vector<int> all = passed();
  const std::optional<int> now = current();
  std::size_t kept = all.size();
  std::vector<int> unmarked;
  for (const int number : all) {
    if (kept <= static_cast<std::size_t>(keep)) break;
    if (number == now || std::ranges::find(also, number) != also.end()) continue;
    remove_or_tell(state(number), failed);
    unmarked.push_back(number);
    --kept;
  }
  return unmarked;
}

void RegionFolder::remove(const std::vector<int>& unmarked, std::vector<std::string>& failed) const {
  for (const int number : unmarked)
    for (const std::string& path : {build(number), data(number), settings_of(number), comparison(number)})
      remove_or_tell(path, failed);
  const std::vector<int> all = passed();
  for (const fs::path& entry : entries(path_ + "/log")) {
    const Numbered n = numbered(entry.filename().string());
    if (n.number >= 0 && !all.empty() && n.number < all.front()) remove_or_tell(entry.string(), failed);
  }
}

RegionLock::RegionLock(const RegionFolder& region, bool take_over, base::Progress& progress) {
  const std::string path = region.path() + "/lock";
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) cannot_write(path, errno);
  const auto give_up = [&](const std::string& why) {
    ::close(descriptor_);
    descriptor_ = -1;
    throw base::UsageError(path + ": " + why);
  };
  const std::string before = read_all(descriptor_);
  const nlohmann::json holder = nlohmann::json::parse(before, nullptr, false);
  const auto text = [&](const char* key) {
    return holder.is_object() && holder.contains(key) && holder[key].is_string() ? holder[key].get<std::string>()
                                                                                 : std::string();
  };
  const std::string who = holder.is_object()
                              ? fmt::format("process {} on {}, since {}", text("pid"), text("host"), text("since"))
                              : std::string("one that has just begun");
  int locked = 0;
  do locked = ::flock(descriptor_, LOCK_EX | LOCK_NB);
  while (locked != 0 && errno == EINTR);
  if (locked != 0 && errno == EWOULDBLOCK)
    give_up("another run works on this region (" + who + "). Wait for it, or end it.");
  if (locked != 0) {
    const int error = errno;
    ::close(descriptor_);
    descriptor_ = -1;
    throw base::OutputError(path + ": cannot be locked: " + std::strerror(error) +
                            ". The disk must know locks (flock); put the region on another one");
  }
  if (!before.empty()) {
    // Its process is gone, if it ran here: the kernel let go of the lock. Network disks may keep locks apart.
    struct stat info {};
    ::fstat(descriptor_, &info);
    const bool elsewhere = text("host") != base::host_name(), old = std::time(nullptr) - info.st_mtime > kStale;
    if (elsewhere && !old && !take_over)
      give_up("a run on another host may work on this region (" + who +
              "). If it is gone for sure, add --break-lock; after a day that is not needed.");
    progress.warn(fmt::format("{}: left by {}, which is gone; taken over", path, who));
  }
  const nlohmann::json mine = {{"pid", std::to_string(::getpid())},
                               {"host", base::host_name()},
                               {"since", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))}};
  const std::string bytes = mine.dump() + "\n";
  if (::ftruncate(descriptor_, 0) != 0 ||
      ::pwrite(descriptor_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    const int error = errno;
    ::close(descriptor_);
    descriptor_ = -1;
    cannot_write(path, error);
  }
  alive_ = std::jthread([descriptor = descriptor_](const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, stop, kTouched, [&] { return stop.stop_requested(); }))
      ::futimens(descriptor, nullptr);
  });
}

RegionLock::~RegionLock() {
  alive_ = {};
  if (descriptor_ < 0) return;
  // An empty file is nobody's.
  if (::ftruncate(descriptor_, 0) != 0) { /* the next run tells it */
  }
  ::close(descriptor_);
}

void write_whole(const std::string& path, std::string_view bytes) {
  const std::string part = path + ".part";
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) cannot_write(part, errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = errno;
      ::close(descriptor);
      ::unlink(part.c_str());
      cannot_write(path, error);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  const bool synced = ::fsync(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  if (!synced || ::rename(part.c_str(), path.c_str()) != 0) {
    const int failed = synced ? errno : error;
    ::unlink(part.c_str());
    cannot_write(path, failed);
  }
}

}  // namespace blockrand::run
