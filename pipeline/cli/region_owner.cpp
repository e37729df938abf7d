#include "pipeline/cli/region_owner.h"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <optional>

namespace blockrand::cli {
namespace {

std::optional<uid_t> owner_number(const std::string& folder) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0) return std::nullopt;
  return status.st_uid;
}

}  // namespace

std::string owner_of(const std::string& folder) {
  const std::optional<uid_t> owner = owner_number(folder);
  const passwd* const user = owner ? ::getpwuid(*owner) : nullptr;
  return user ? user->pw_name : "";
}

void warn_of_root(const std::string& folder, base::Progress& progress) {
  std::error_code error;
  // A region that is not there yet will lie where its owner has another.
  const std::string there =
      std::filesystem::exists(folder, error) ? folder : std::filesystem::absolute(folder, error).parent_path().string();
  const std::optional<uid_t> owner = owner_number(there);
  if (::geteuid() != 0 || !owner || *owner == 0) return;
  const std::string known = owner_of(there), name = known.empty() ? std::to_string(*owner) : known;
  progress.warn(
      fmt::format("{0} is a region of {1}, who cannot remove what root writes there. Run this as {1} (runuser -u {1} "
                  "-- blockrand …), or afterwards: chown -R {1}: {0}",
                  folder, name));
}

}  // namespace blockrand::cli
