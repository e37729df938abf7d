#include "pipeline/view/export_site.h"

#include "pipeline/base/error.h"
#include "pipeline/base/publish.h"

namespace blockrand::view {

ExportFigures export_site(const Site& site, const std::string& folder, bool force) {
  base::StagedFolder place(folder, force, {.name = "site", .marker = "view.json"});
  ExportFigures figures;
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
  }
  place.publish();
  return figures;
}

}  // namespace blockrand::view
