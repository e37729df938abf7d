#include "pipeline/cli/configs_folder.h"

#include "pipeline/base/error.h"

namespace blockrand::cli {
namespace {

namespace fs = std::filesystem;

bool holds_configs(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "defaults" / "uses.toml", error) &&
         fs::is_regular_file(folder / "materials" / "materials.toml", error);
}

}  // namespace

std::string configs_folder(const std::string& given, const fs::path& program) {
  if (!given.empty()) {
    if (holds_configs(given)) return given;
    throw base::UsageError(
        "--configs: " + given +
        " lacks defaults/uses.toml or materials/materials.toml. Name a folder like the program's configs/.");
  }
  const fs::path bin = program.parent_path();
  std::string tried;
  for (const fs::path& folder : {bin / "configs", bin / BLOCKRAND_INSTALLED_CONFIGS}) {
    const fs::path place = folder.lexically_normal();
    if (holds_configs(place)) return place.string();
    tried += (tried.empty() ? "" : " nor at ") + place.string();
  }
  throw base::UsageError("the configs that came with the program are not at " + tried +
                         ". Name their folder with --configs.");
}

fs::path program_file() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

}  // namespace blockrand::cli
