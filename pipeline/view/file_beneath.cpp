#include "pipeline/view/file_beneath.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

namespace blockrand::view {
namespace {

/// A FIFO must not hold the server up.
constexpr int kFlags = O_RDONLY | O_NONBLOCK | O_CLOEXEC;

/// Where the kernel cannot keep a path beneath a folder (before Linux 5.6, some containers): links are followed first, then looked at.
int open_checked(const std::string& folder, const std::string& path) {
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::canonical(folder + "/" + path, error);
  if (error || !whole.string().starts_with(folder == "/" ? folder : folder + "/")) return -1;
  return ::open(whole.c_str(), kFlags | O_NOFOLLOW);
}

int open_beneath(const std::string& folder, const std::string& path) {
  const int root = ::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (root < 0) return -1;
  open_how how{};
  how.flags = kFlags;
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  const long opened = ::syscall(SYS_openat2, root, path.c_str(), &how, sizeof how);
  const bool unknown = opened < 0 && (errno == ENOSYS || errno == EPERM);
  ::close(root);
  return unknown ? open_checked(folder, path) : static_cast<int>(opened);
}

}  // namespace

bool is_plain_path(std::string_view path) {
  if (path.empty()) return false;
  for (const char c : path)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '\\') return false;
  for (std::size_t at = 0; at <= path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    if (end == at || path[at] == '.') return false;
    at = end + 1;
  }
  return true;
}

std::shared_ptr<const FileBeneath> FileBeneath::open(const std::string& folder, std::string_view path) {
  if (!is_plain_path(path)) return nullptr;
  const int descriptor = open_beneath(folder, std::string(path));
  if (descriptor < 0) return nullptr;
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    return nullptr;
  }
  return std::shared_ptr<const FileBeneath>(new FileBeneath(
      descriptor, static_cast<std::uint64_t>(status.st_size),
      static_cast<std::int64_t>(status.st_mtim.tv_sec) * 1'000'000'000 + status.st_mtim.tv_nsec, status.st_ino));
}

FileBeneath::~FileBeneath() { ::close(descriptor_); }

std::string FileBeneath::version() const { return fmt::format("{:x}-{:x}-{:x}", inode_, size_, changed_); }

std::optional<std::string> FileBeneath::read(std::uint64_t offset, std::size_t length) const {
  std::string bytes(length, '\0');
  std::size_t got = 0;
  while (got < length) {
    const ssize_t n = ::pread(descriptor_, bytes.data() + got, length - got, static_cast<off_t>(offset + got));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return std::nullopt;
    if (n == 0) break;
    got += static_cast<std::size_t>(n);
  }
  bytes.resize(got);
  return bytes;
}

}  // namespace blockrand::view
