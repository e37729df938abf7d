#include "pipeline/run/region_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRefused = ".refused";
/// s: a lock of another host that nobody touched for so long is stale.
constexpr std::time_t kStale = 24L * 3600;

/// The number that a name begins with, six digits; -1: it has none.
int number_of(const std::string& name) {
  int number = -1;
  if (name.size() < 6) return -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + 6, number);
  return error == std::errc() && end == name.data() + 6 && (name.size() == 6 || name[6] == '.') ? number : -1;
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

void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

std::string host_name() {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  return host;
}

std::string read_all(int descriptor) {
  std::string out(4096, '\0');
  const ssize_t size = ::pread(descriptor, out.data(), out.size(), 0);
  out.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return out;
}

}  // namespace

RegionFolder::RegionFolder(std::string path) : path_(std::move(path)) {
  while (path_.size() > 1 && path_.ends_with('/')) path_.pop_back();
  std::error_code error;
  if (fs::exists(path_, error) && !fs::is_directory(path_, error))
    throw base::UsageError(path_ + " is a file. Name the folder of a region, or one that is to become one.");
  if (fs::exists(path_ + "/build.json", error))
    throw base::UsageError(path_ +
                           " is a build, not a region. A region is a folder of its own, which holds its builds: "
                           "name another one; the first 'blockrand update' makes it.");
  if (!exists() && !entries(path_).empty() && !fs::exists(settings(), error))
    throw base::UsageError(path_ + " is no region and not empty. Name a region, or a new or empty folder.");
}

std::string RegionFolder::name() const { return fs::absolute(path_).lexically_normal().filename().string(); }

std::string RegionFolder::digits(int number) { return fmt::format("{:06}", number); }

bool RegionFolder::exists() const {
  std::error_code error;
  return fs::is_directory(path_ + "/builds", error) && fs::is_directory(path_ + "/store", error);
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
  if (!fs::is_symlink(link, error)) return std::nullopt;
  const int number = number_of(fs::read_symlink(link, error).filename().string());
  if (number < 0 || !fs::is_regular_file(build(number) + "/build.json", error))
    throw base::InputError(link.string(), "", "leads to no build",
                           "Put the build back, or go to an earlier one: blockrand rollback");
  return number;
}

std::vector<int> RegionFolder::published() const {
  std::error_code error;
  const fs::path link = path_ + "/current";
  const int now = fs::is_symlink(link, error) ? number_of(fs::read_symlink(link, error).filename().string()) : -1;
  std::vector<int> out;
  for (const fs::path& entry : entries(path_ + "/builds")) {
    const std::string name = entry.filename().string();
    const int number = number_of(name);
    if (number >= 0 && name.size() == 6 && (number == now || fs::exists(log(number), error))) out.push_back(number);
  }
  return out;
}

int RegionFolder::next() const {
  int most = 0;
  for (const char* folder : {"/builds", "/store", "/log"})
    for (const fs::path& entry : entries(path_ + folder)) most = std::max(most, number_of(entry.filename().string()));
  return most + 1;
}

std::vector<std::string> RegionFolder::remove_unfinished() const {
  const std::vector<int> good = published();
  const std::set<int> known(good.begin(), good.end());
  std::vector<std::string> removed;
  const auto remove = [&](const fs::path& path) {
    std::error_code error;
    fs::remove_all(path, error);
    if (error) throw base::OutputError(path.string() + ": cannot be removed: " + error.message());
    removed.push_back(path.string());
  };
  // What has another name is somebody else's.
  for (const fs::path& entry : entries(path_ + "/builds")) {
    const std::string name = entry.filename().string();
    const bool staged = name.starts_with('.') && name.find(".part-") != std::string::npos;
    const bool lost = number_of(name) >= 0 && name.size() == 6 && !known.contains(number_of(name));
    if (staged || lost) remove(entry);
  }
  for (const fs::path& entry : entries(path_ + "/store")) {
    const int number = number_of(entry.filename().string());
    if (number >= 0 && (!known.contains(number) || entry.string().ends_with(".part"))) remove(entry);
  }
  for (const fs::path& entry : entries(path_))
    if (entry.filename() == "current.new") remove(entry);
  return removed;
}

void RegionFolder::publish(int number) const {
  const std::string fresh = path_ + "/current.new", place = path_ + "/current";
  ::unlink(fresh.c_str());
  if (::symlink(("builds/" + digits(number)).c_str(), fresh.c_str()) != 0) cannot_write(fresh, errno);
  sync_folder(path_ + "/builds");
  if (::rename(fresh.c_str(), place.c_str()) != 0) cannot_write(place, errno);
  sync_folder(path_);
}

std::string RegionFolder::set_aside(int number) const {
  std::error_code error;
  for (const fs::path& entry : entries(path_ + "/builds"))
    if (entry.string().ends_with(kRefused)) fs::remove_all(entry, error);
  const std::string aside = build(number) + kRefused;
  fs::rename(build(number), aside, error);
  for (const std::string& path : {data(number), state(number)}) fs::remove(path, error);
  return aside;
}

void RegionFolder::prune(int keep) const {
  std::vector<int> all = published();
  const std::optional<int> now = current();
  std::erase_if(all, [&](int number) { return number == now; });
  std::error_code error;
  // What goes first is its entry in the log: a run that is broken off here removes the rest.
  while (all.size() + 1 > static_cast<std::size_t>(keep)) {
    const int oldest = all.front();
    all.erase(all.begin());
    fs::remove(log(oldest), error);
    fs::remove_all(build(oldest), error);
    for (const std::string& path : {data(oldest), state(oldest), changes(oldest) + ".json", changes(oldest) + ".html"})
      fs::remove(path, error);
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
  const std::string who = fmt::format("process {} on {}, since {}", text("pid"), text("host"), text("since"));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
    give_up("another run works on this region (" + who + "). Wait for it, or end it.");
  if (!before.empty()) {
    // Its process is gone, if it ran here: the kernel let go of the lock. Network disks may keep locks apart.
    struct stat info {};
    ::fstat(descriptor_, &info);
    const bool elsewhere = text("host") != host_name(), old = std::time(nullptr) - info.st_mtime > kStale;
    if (elsewhere && !old && !take_over)
      give_up("a run on another host may work on this region (" + who +
              "). If it is gone for sure, add --break-lock; after a day that is not needed.");
    progress.warn(fmt::format("{}: left by {}, which is gone; taken over", path, who));
  }
  const nlohmann::json mine = {{"pid", std::to_string(::getpid())},
                               {"host", host_name()},
                               {"since", fmt::format("{} (Unix time)", std::time(nullptr))}};
  const std::string bytes = mine.dump() + "\n";
  if (::ftruncate(descriptor_, 0) != 0 ||
      ::pwrite(descriptor_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    const int error = errno;
    ::close(descriptor_);
    descriptor_ = -1;
    cannot_write(path, error);
  }
}

RegionLock::~RegionLock() {
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
