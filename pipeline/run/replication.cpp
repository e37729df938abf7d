#include "pipeline/run/replication.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>

#include "pipeline/base/error.h"

namespace blockrand::run {
namespace {

namespace fs = std::filesystem;

struct State {
  std::optional<std::uint64_t> sequence;
  std::string time;
};

/// Lines KEY=VALUE; colons are escaped by a backslash, as Java's properties have them.
State read_state(const std::string& path) {
  State state;
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    const std::size_t equals = line.find('=');
    if (line.starts_with('#') || equals == std::string::npos) continue;
    const std::string key = line.substr(0, equals);
    std::string value = line.substr(equals + 1);
    std::erase(value, '\\');
    if (key == "timestamp") state.time = value;
    if (key != "sequenceNumber") continue;
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error == std::errc() && end == value.data() + value.size() && number <= 999'999'999) state.sequence = number;
  }
  return state;
}

}  // namespace

std::vector<ReplicationFile> replication_files(const std::string& folder, std::uint64_t from) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw base::InputError(folder, "", "is no folder of change files", "Check replication in region.toml");
  const std::string newest = folder + "/state.txt";
  if (!fs::is_regular_file(newest, error))
    throw base::InputError(newest, "", "is missing: it names the newest change file",
                           "Fetch it with the change files from where they come");
  const State state = read_state(newest);
  if (!state.sequence)
    throw base::InputError(newest, "", "has no line sequenceNumber=N",
                           "Fetch it again from where the change files come");
  if (*state.sequence + 1 < from)
    throw base::InputError(newest, fmt::format("sequence {}", *state.sequence),
                           fmt::format("is behind: the region has change file {} already", from - 1),
                           "Is it the folder of another server, or was its file cut off? Fetch it again");
  std::vector<ReplicationFile> files;
  for (std::uint64_t n = from; n <= *state.sequence; ++n) {
    const std::string stem = fmt::format("{}/{:03}/{:03}/{:03}", folder, n / 1'000'000, n / 1000 % 1000, n % 1000);
    ReplicationFile file{n, "", read_state(stem + ".state.txt").time};
    for (const char* end : {".osc.gz", ".osc.bz2", ".osc"})
      if (file.path.empty() && fs::is_regular_file(stem + end, error)) file.path = stem + end;
    if (file.path.empty())
      throw base::InputError(stem + ".osc.gz", fmt::format("sequence {}", n),
                             fmt::format("is missing; {} to {} are wanted", from, *state.sequence),
                             "Fetch it, or update from a full extract that is newer");
    files.push_back(std::move(file));
  }
  return files;
}

}  // namespace blockrand::run
