#include "pipeline/outward/part_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/outward/target.h"

namespace blockrand::outward {

namespace fs = std::filesystem;

void cannot_put(const std::string& path, int error) {
  throw base::OutputError(path + ": cannot be written: " + std::strerror(error) +
                          (error == ENOSPC || error == EDQUOT
                               ? ". Make room there, and publish again: it goes on there"
                               : ". Check the folder's permissions and its disk, and publish again"));
}

PartFile::PartFile(const std::string& place) : place_(place), part_(place + ".blockrand-part") {
  descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0) cannot_put(part_, errno);
}

PartFile::~PartFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!done_) ::unlink(part_.c_str());
}

void PartFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) cannot_put(part_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void PartFile::publish() {
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0 || ::rename(part_.c_str(), place_.c_str()) != 0) cannot_put(place_, errno);
  done_ = true;
}

void PartFile::publish_on_disk() {
  if (::fsync(descriptor_) != 0) cannot_put(part_, errno);
  publish();
  const fs::path parent = fs::path(place_).parent_path();
  const int folder = ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) cannot_put(place_, errno);
  const int synced = ::fsync(folder), error = errno;
  ::close(folder);
  // Some network file systems have no sync of folders.
  if (synced != 0 && error != EINVAL) cannot_put(place_, error);
}

void throw_damaged(const std::string& place) {
  throw base::InputError(place, "", "is not the file that build.json names: the build is damaged",
                         "It was not sent. 'blockrand validate' tells what else is; build again");
}

std::string whole_file(const std::string& build, const BuildFile& file) {
  check_there(build, file);
  const std::string place = build + "/" + file.path;
  std::ifstream in(place, std::ios::binary);
  std::string bytes(file.bytes, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in || base::sha256_of(bytes) != file.sha256) throw_damaged(place);
  return bytes;
}

void refuse_own_folders(const std::string& option, const std::string& place) {
  const auto has = [](const fs::path& folder, const char* name) {
    std::error_code error;
    return fs::exists(folder / name, error);
  };
  for (fs::path at = fs::weakly_canonical(fs::absolute(place)); at.has_relative_path(); at = at.parent_path()) {
    // A web root has the build.json of what was sent to it, but not run.json.
    const bool build = has(at, "build.json") && has(at, "run.json");
    if (build || has(at, "region.toml"))
      throw base::UsageError(option + " " + place + " lies in the " + (build ? "build " : "region ") + at.string() +
                             ". Name a place beside it.");
  }
}

}  // namespace blockrand::outward
