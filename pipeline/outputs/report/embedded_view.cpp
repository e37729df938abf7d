#include "pipeline/outputs/report/embedded_view.h"

#include <algorithm>

#include "pipeline/base/markup.h"
#include "pipeline/outputs/gzip.h"
#include "viewer/page.h"

namespace blockrand::outputs {
namespace {

constexpr int kLevel = 1;  // 0.18 s for 28 MB, a fifth more than level 6 leaves
constexpr std::string_view kTileset = "tileset.json", kModel = "model/";

bool is_tile(const std::string& path) { return path.starts_with("tiles/") && path.ends_with(".glb"); }

void append_packed(std::string& out, std::string_view name, std::string_view content, int level) {
  if (out.back() != '{') out += ',';
  base::append_json(out, name);
  out += ":\"";
  base::append_base64(out, gzip(content, level));
  out += '"';
}

}  // namespace

std::optional<std::string> embedded_view(std::span<const base::PublishedFile> files,
                                         const std::function<std::string(const std::string& path)>& read,
                                         ViewRecord view, std::uint64_t most) {
  if (std::ranges::find(files, kTileset, &base::PublishedFile::path) == files.end()) return std::nullopt;
  // Measured: a byte of the page holds 3.7 of a LoD3 tile. What is far beyond that need not be read to know that it is too much.
  constexpr std::uint64_t kBestRatio = 6;
  std::uint64_t bytes = 0;
  for (const base::PublishedFile& file : files)
    if (is_tile(file.path)) bytes += file.bytes;
  if (bytes == 0 || bytes / kBestRatio > most) return std::nullopt;

  const std::string tileset = read(std::string(kTileset));
  const std::optional<TilesetExtent> extent = extent_of_tileset(tileset);
  if (!extent) return std::nullopt;
  view.extent = *extent;
  view.tileset = std::string(kModel) + std::string(kTileset);
  view.places.clear();
  view.explained.reset();

  std::string out = "{\"files\":{";
  constexpr std::uint64_t kUsualRatio = 3;  // room is not touched before it is filled
  out.reserve(std::min(bytes / kUsualRatio, most));
  bool fits = true;
  const auto add = [&](const std::string& path, std::string_view content) {
    append_packed(out, path, content, kLevel);
    fits = out.size() <= most;
  };
  add("view.json", view_json(view));
  add(view.tileset, tileset);
  for (const base::PublishedFile& file : files) {
    if (!is_tile(file.path)) continue;
    add(std::string(kModel) + file.path, read(file.path));
    if (!fits) return std::nullopt;
  }
  out += "}}";
  return out;
}

std::string embedded_viewer() {
  std::string out = "{";
  for (const std::string_view name : {"viewer.js", "viewer.css"}) append_packed(out, name, viewer::asset(name), 6);
  return out + '}';
}

}  // namespace blockrand::outputs
