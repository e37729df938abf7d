#include "pipeline/cli/spooled_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"

namespace blockrand::cli {
namespace {

namespace fs = std::filesystem;

/// A new file without a name. \returns its descriptor, or -1 with errno
int open_unnamed(const std::string& folder) {
#ifdef O_TMPFILE
  if (const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600); file >= 0) return file;
#endif
  // File systems without such files: a name for a moment.
  std::string name = folder + "/.blockrand-input-XXXXXX";
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(name.c_str());
  return file;
}

std::string existing_folder(const std::string& folder) {
  std::error_code error;
  fs::path path = fs::absolute(folder, error);
  while (!fs::is_directory(path, error) && path.has_relative_path()) path = path.parent_path();
  return path.string();
}

void write_all(int file, std::string_view bytes, const std::string& folder) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), bytes.size());
    if (n >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(n));
    else if (errno != EINTR)
      throw base::OutputError(fmt::format(
          "{}: standard input cannot be kept there while it is read: {}. Free some space, or name a file in place of -",
          folder, std::strerror(errno)));
  }
}

}  // namespace

SpooledInput::SpooledInput(const std::string& folder, base::Progress& progress) {
  struct stat info {};
  const char* const how =
      "Pipe an extract into it (osmium cat TOWN.osm.pbf -f pbf -o - | blockrand …), or name a file in place of -";
  if (::fstat(STDIN_FILENO, &info) != 0)
    throw base::UsageError(std::string("- is standard input, which is closed. ") + how);
  if (::isatty(STDIN_FILENO) != 0)
    throw base::UsageError(std::string("- is standard input, which is a terminal. ") + how);
  if (S_ISDIR(info.st_mode)) throw base::InputError(kStandardInput, "", "this is a directory", how);
  const std::string place = existing_folder(folder);
  file_ = open_unnamed(place);
  if (file_ < 0)
    throw base::OutputError(
        fmt::format("{}: standard input cannot be kept there while it is read: {}. Choose another "
                    "place, or name a file in place of -",
                    place, std::strerror(errno)));
  path_ = fmt::format("/proc/self/fd/{}", file_);
  constexpr std::uint64_t kMega = 1'000'000;
  progress.begin("take input", S_ISREG(info.st_mode) ? static_cast<std::uint64_t>(info.st_size) / kMega : 0, "MB");
  std::vector<char> buffer(1 << 20);
  std::uint64_t bytes = 0;
  while (true) {
    const ssize_t n = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw base::InputError(kStandardInput, "", std::strerror(errno), "");
    if (n == 0) break;
    write_all(file_, std::string_view(buffer.data(), static_cast<std::size_t>(n)), place);
    bytes += static_cast<std::uint64_t>(n);
    progress.advance_to(bytes / kMega);
  }
  if (bytes == 0)
    throw base::InputError(kStandardInput, "", "it is empty", "Did the program before the pipe end with an error?");
}

SpooledInput::SpooledInput(SpooledInput&& other) noexcept
    : file_(std::exchange(other.file_, -1)), path_(std::move(other.path_)) {}

SpooledInput::~SpooledInput() {
  if (file_ >= 0) ::close(file_);
}

std::optional<SpooledInput> take_standard_input(std::string& input, const std::string& output,
                                                base::Progress& progress) {
  if (input != "-") return std::nullopt;
  std::error_code error;
  std::string folder = output.empty() ? fs::temp_directory_path(error).string()
                                      : fs::absolute(output, error).lexically_normal().parent_path().string();
  std::optional<SpooledInput> spooled(std::in_place, folder.empty() ? "/tmp" : folder, progress);
  input = spooled->path();
  return spooled;
}

std::string with_told_input(std::string text, const SpooledInput& input) {
  for (std::size_t at = 0; (at = text.find(input.path(), at)) != std::string::npos;)
    text.replace(at, input.path().size(), kStandardInput);
  return text;
}

}  // namespace blockrand::cli
