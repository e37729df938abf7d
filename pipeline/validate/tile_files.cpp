#include "pipeline/validate/tile_files.h"

namespace blockrand::validate {

std::map<std::string, TileFiles> files_by_tile(const BuildRecord& record, FindingLog& log) {
  std::map<std::string, TileFiles> tiles;
  for (const auto& [path, file] : record.files)
    if (const auto t = tile_path(path)) {
      TileFiles& files = tiles[t->tile];
      files.name = t->tile;
      if (t->coarser)
        files.levels[*t->coarser] = path;
      else if (t->piece)
        files.pieces.push_back(path);
      else
        files.path[static_cast<std::size_t>(t->format)] = path;
    } else if (std::string tile = explained_tile(path); !tile.empty()) {
      TileFiles& files = tiles[tile];
      files.name = tile;
      files.explanations = path;
    }
  for (auto& [name, files] : tiles) {
    if (files.pieces.empty()) continue;
    std::string& whole = files.path[static_cast<std::size_t>(Format::gltf)];
    if (!whole.empty()) log.add(Check::tile_missing, whole, name, "the tile has a GLB, and GLBs of its parts as well");
    whole = files.pieces.front();
  }
  return tiles;
}

}  // namespace blockrand::validate
