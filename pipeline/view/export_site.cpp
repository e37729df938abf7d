#include "pipeline/view/export_site.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <vector>

#include "pipeline/base/error.h"
#include "pipeline/base/publish.h"

namespace blockrand::view {

namespace {

namespace fs = std::filesystem;

/// What an export wrote, one path a line: what else lies there is its owner's.
constexpr const char* kList = "files.txt";

std::vector<std::string> foreign_files(const std::string& folder) {
  std::set<std::string> ours = {kList};
  std::ifstream list(folder + "/" + kList);
  for (std::string path; std::getline(list, path);) ours.insert(path);
  std::vector<std::string> out;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_directory(error) && !entry->is_symlink(error)) continue;
    std::string path = entry->path().lexically_relative(folder).generic_string();
    if (!ours.contains(path)) out.push_back(std::move(path));
  }
  std::ranges::sort(out);
  return out;
}

/// A build or a region would be spoilt by files of others.
void refuse_within_builds(const std::string& folder) {
  std::error_code error;
  for (fs::path place = fs::weakly_canonical(folder, error); !place.empty(); place = place.parent_path()) {
    for (const char* record : {"build.json", "region.toml"})
      if (fs::exists(place / record, error))
        throw base::UsageError(folder + " lies in " + place.string() +
                               ", which is a build or a region: export to another place");
    if (place == place.parent_path()) break;
  }
}

}  // namespace

ExportFigures export_site(const Site& shown, const std::string& folder, bool force) {
  refuse_within_builds(folder);
  const Site site = shown.pinned();
  base::StagedFolder place(folder, force, {.name = "site", .marker = kList, .foreign = foreign_files});
  ExportFigures figures;
  std::string list;
  for (const std::string& path : site.paths()) {
    const auto broken = [&] {
      return base::InputError(path, "", "cannot be read",
                              "Build again; 'blockrand validate' lists all damage of a build");
    };
    std::optional<Resource> found = site.find(path);
    if (!found) throw broken();
    std::uint64_t bytes = 0;
    if (!found->file) {
      bytes = place.write(path, found->bytes).bytes;
    } else {
      base::StagedFile file = place.create(path);
      constexpr std::size_t kPiece = 1 << 22;
      while (bytes < found->file->size()) {
        const std::optional<std::string> piece = found->file->read(bytes, kPiece);
        if (!piece || piece->empty()) throw broken();
        file.append(*piece);
        bytes += piece->size();
      }
      file.close();
    }
    ++figures.files, figures.bytes += bytes;
    list += path + "\n";
  }
  place.write(kList, list);
  place.publish();
  return figures;
}

}  // namespace blockrand::view
