#include "pipeline/validate/packed_files.h"

#include <filesystem>
#include <set>
#include <string_view>

#include "pipeline/validate/bytes_of_file.h"

namespace blockrand::validate {

namespace fs = std::filesystem;

std::uint64_t check_packed_beside(const std::string& folder, std::span<const std::string> files, FindingLog& log) {
  constexpr std::string_view kPacked = ".gz";
  const std::set<std::string_view> listed(files.begin(), files.end());
  std::uint64_t count = 0;
  for (const std::string& path : files) {
    if (!path.ends_with(kPacked)) continue;
    const std::string plain = path.substr(0, path.size() - kPacked.size());
    if (!listed.contains(plain)) continue;
    ++count;
    const auto packed = file_bytes((fs::path(folder) / path).string());
    const auto unpacked = packed ? gunzip(*packed) : std::nullopt;
    if (!unpacked)
      log.add(Check::gzip_differs, path, "", "cannot be decompressed");
    else if (unpacked != file_bytes((fs::path(folder) / plain).string()))
      log.add(Check::gzip_differs, path, "", "does not hold " + plain);
  }
  return count;
}

}  // namespace blockrand::validate
