#include "pipeline/validate/formats.h"

#include <algorithm>
#include <iterator>

namespace blockrand::validate {
namespace {

/// What stands between a path's start and its end; empty where it has another start or end.
std::string between(std::string_view path, std::string_view start, std::string_view end) {
  if (!path.starts_with(start) || !path.ends_with(end) || path.size() <= start.size() + end.size()) return {};
  return std::string(path.substr(start.size(), path.size() - start.size() - end.size()));
}

/// "15_17600_12900_lod1" → 1, and the name without its ending.
std::optional<int> cut_level(std::string& name) {
  constexpr std::string_view kLevel = "_lod";
  if (name.size() <= kLevel.size() + 1 || name.back() < '0' || name.back() > '2') return std::nullopt;
  const std::size_t cut = name.size() - kLevel.size() - 1;
  if (name.compare(cut, kLevel.size(), kLevel) != 0) return std::nullopt;
  const int level = name.back() - '0';
  name.resize(cut);
  return level;
}

/// "15_17600_12900_q21": whether it ends so, and the name without that.
bool cut_piece(std::string& name) {
  const std::size_t last = name.find_last_not_of("0123");
  if (last == std::string::npos || last + 1 == name.size() || last == 0 || name[last] != 'q' || name[last - 1] != '_')
    return false;
  name.resize(last - 1);
  return true;
}

}  // namespace

bool is_format(std::string_view key) {
  return std::any_of(std::begin(kFormats), std::end(kFormats), [&](const FormatRules& f) { return f.key == key; });
}

namespace {

constexpr std::string_view kSurroundings = "_surroundings", kGround = "_ground";

/// A file of a tile, whatever is in it.
std::optional<TilePath> any_tile_path(std::string_view path) {
  for (std::size_t f = 0; f < kTileFormats; ++f) {
    std::string_view bare = path;
    if (bare.ends_with(".gz")) bare.remove_suffix(3);
    std::string name = between(bare, kFormats[f].folder, kFormats[f].ending);
    if (name.empty()) continue;
    const auto format = static_cast<Format>(f);
    if (format != Format::gltf) return TilePath{std::move(name), format, {}};
    if (bare.size() != path.size()) return std::nullopt;  // GLBs are never zipped
    std::replace(name.begin(), name.end(), '/', '_');
    const std::optional<int> level = cut_level(name);
    const bool piece = !level && cut_piece(name);
    return TilePath{std::move(name), format, level, piece};
  }
  return std::nullopt;
}

}  // namespace

bool is_ground(std::string_view path) { return path.ends_with("_ground.glb"); }

std::optional<TilePath> tile_path(std::string_view path) {
  std::optional<TilePath> found = any_tile_path(path);
  if (found && (found->tile.ends_with(kSurroundings) || is_ground(path))) found.reset();
  return found;
}

std::optional<TilePath> surroundings_path(std::string_view path) {
  std::optional<TilePath> found = any_tile_path(path);
  for (const std::string_view ending : {kSurroundings, kGround}) {
    if (!found || !found->tile.ends_with(ending) || (ending == kGround && !is_ground(path))) continue;
    found->tile.resize(found->tile.size() - ending.size());
    return found;
  }
  return std::nullopt;
}

std::string explained_tile(std::string_view path) { return between(path, "explain/", ".jsonl.gz"); }

}  // namespace blockrand::validate
