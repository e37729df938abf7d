#include "pipeline/cli/presets_folder.h"

#include <filesystem>

#include "pipeline/base/error.h"

namespace blockrand::cli {
namespace {

namespace fs = std::filesystem;

bool holds_presets(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "defaults" / "uses.toml", error);
}

}  // namespace

std::string presets_folder(const std::string& given) {
  if (!given.empty()) {
    if (holds_presets(given)) return given;
    throw base::UsageError("--presets: " + given +
                           " has no defaults/uses.toml. Name a folder like the program's configs/.");
  }
  std::error_code error;
  fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (; !error && folder.has_relative_path(); folder = folder.parent_path())
    for (const char* place : {"configs", "share/blockrand/configs"})
      if (holds_presets(folder / place)) return (folder / place).string();
  if (holds_presets(BLOCKRAND_SOURCE_CONFIGS)) return BLOCKRAND_SOURCE_CONFIGS;
  throw base::UsageError("the folder configs/ that came with the program is not found. Name it with --presets.");
}

}  // namespace blockrand::cli
