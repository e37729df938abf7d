#include "pipeline/view/site.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/outputs/area_folders.h"
#include "pipeline/outputs/explain/explained_tile.h"
#include "pipeline/outputs/output.h"
#include "pipeline/outputs/view_record.h"
#include "viewer/page.h"

namespace blockrand::view {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kPageFiles = {"index.html", "viewer.js", "viewer.css", "LICENSES.txt"};
constexpr std::string_view kModel = "model/", kExplained = "explained/", kEnd = ".json";

std::string type_of(std::string_view path) {
  constexpr std::pair<std::string_view, std::string_view> types[] = {{".html", "text/html; charset=utf-8"},
                                                                     {".js", "text/javascript; charset=utf-8"},
                                                                     {".css", "text/css; charset=utf-8"},
                                                                     {".json", "application/json; charset=utf-8"},
                                                                     {".glb", "model/gltf-binary"},
                                                                     {".png", "image/png"},
                                                                     {".tsv", "text/plain; charset=utf-8"},
                                                                     {".txt", "text/plain; charset=utf-8"},
                                                                     {".csv", "text/csv; charset=utf-8"},
                                                                     {".gz", "application/gzip"},
                                                                     {".gpkg", "application/geopackage+sqlite3"},
                                                                     {".gml", "application/gml+xml; charset=utf-8"}};
  for (const auto& [end, type] : types)
    if (path.ends_with(end)) return std::string(type);
  return "application/octet-stream";
}

Json read_json(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Json json = file ? Json::parse(file, nullptr, false) : Json();
  if (!json.is_object())
    throw base::InputError(path, "", "cannot be read", "Build again; 'blockrand validate' lists all damage");
  return json;
}

bool exists(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool has_record(const std::string& place) {
  std::error_code error;
  return fs::is_regular_file(place + "/build.json", error);
}

/// Without links; empty where it does not exist.
std::string canonical(const std::string& place) {
  std::error_code error;
  const fs::path whole = fs::canonical(place, error);
  return error ? std::string() : whole.string();
}

/// Folders of the build whose files lie together: its areas, or itself.
std::vector<std::string> places_of(const std::string& root) {
  std::vector<std::string> folders = outputs::area_folders(root);
  if (folders.empty()) return {""};
  for (std::string& folder : folders) folder += '/';
  return folders;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

Site::Site(std::string folder, std::string name) : folder_(std::move(folder)), name_(std::move(name)) {
  while (folder_.size() > 1 && folder_.ends_with('/')) folder_.pop_back();
  if (!exists(shown().root + "/tileset.json"))
    throw base::UsageError(folder_ + " has no 3D Tiles, which are what is shown: build with gltf among the --formats");
  if (name_.empty()) name_ = fs::path(canonical(folder_)).filename().string();
}

Site Site::pinned() const { return Site(shown().root, name_); }

Site::Shown Site::shown() const {
  if (has_record(folder_)) return {canonical(folder_), ""};
  if (const std::string current = folder_ + "/current"; has_record(current)) {
    const std::string root = canonical(current);
    return {root, fs::path(root).filename().string() + "/"};
  }
  std::error_code error;
  throw base::UsageError(fs::is_regular_file(folder_, error) ? folder_ + " is a file: name the output folder of a build"
                         : exists(folder_)                   ? folder_ + " is no finished build: it has no build.json"
                                           : folder_ + " does not exist: name the output folder of a build");
}

std::optional<std::string> Site::root_of(std::string_view& path) const {
  if (has_record(folder_)) return canonical(folder_);
  const std::string build(path.substr(0, path.find('/')));
  if (build.empty() || build.find_first_not_of("0123456789") != std::string::npos || build.size() == path.size())
    return std::nullopt;
  const std::string root = canonical(folder_ + "/builds/" + build);
  if (root.empty() || !has_record(root)) return std::nullopt;
  path.remove_prefix(build.size() + 1);
  return root;
}

std::string Site::description() const {
  const auto [place, prefix] = shown();
  const Json record = read_json(place + "/build.json");
  const auto number = [](const Json& in, const char* key) -> std::uint64_t {
    const auto found = in.find(key);
    return found != in.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
  };
  const std::optional<outputs::TilesetExtent> extent = outputs::extent_of_tileset(text_of(place + "/tileset.json"));
  if (!extent && number(record.value("counts", Json::object()), "models") == 0)
    throw base::UsageError(folder_ + " holds a build without a single building: there is nothing to be seen");
  if (!extent)
    throw base::InputError(place + "/tileset.json", "root", "cannot be read, or has no region",
                           "Build again; 'blockrand validate' lists all damage");
  outputs::ViewRecord view;
  view.name = name_;
  view.lod = static_cast<int>(number(record.value("configuration", Json::object()), "lod"));
  const Json counts = record.value("counts", Json::object());
  view.buildings = number(counts, "buildings");
  view.attribution = outputs::kAttribution;
  view.extent = *extent;
  const std::string model = std::string(kModel) + prefix;
  view.tileset = model + "tileset.json";
  for (const std::string& part : places_of(place)) {
    if (exists(place + "/" + part + "explain/index.txt")) view.explained = std::string(kExplained) + prefix;
    if (exists(place + "/" + part + "explain/places.tsv")) view.places.push_back(model + part + "explain/places.tsv");
  }
  const Json time = record.value("data_time", Json());
  if (time.is_string()) view.data_time = time.get<std::string>();
  return outputs::view_json(view);
}

std::optional<Resource> Site::find(std::string_view path) const {
  if (path.empty()) path = kPageFiles[0];
  if (std::ranges::find(kPageFiles, path) != kPageFiles.end())
    return Resource{type_of(path), std::string(viewer::asset(path)), nullptr};
  if (path == "view.json") return Resource{type_of(path), description(), nullptr};
  if (path.starts_with(kExplained) && path.ends_with(kEnd) && path.size() > kExplained.size() + kEnd.size()) {
    std::string_view tile = path.substr(kExplained.size(), path.size() - kExplained.size() - kEnd.size());
    const std::optional<std::string> root = root_of(tile);
    std::optional<std::string> explained = root ? outputs::explained_tile(*root, tile) : std::nullopt;
    if (!explained) return std::nullopt;
    return Resource{type_of(path), std::move(*explained), nullptr};
  }
  if (path.starts_with(kModel)) {
    std::string_view rest = path.substr(kModel.size());
    const std::optional<std::string> root = root_of(rest);
    if (std::shared_ptr<const FileBeneath> file = root ? FileBeneath::open(*root, rest) : nullptr)
      return Resource{type_of(path), {}, std::move(file)};
  }
  return std::nullopt;
}

std::vector<std::string> Site::paths() const {
  std::vector<std::string> out(kPageFiles.begin(), kPageFiles.end());
  out.emplace_back("view.json");
  const auto [root, prefix] = shown();
  const auto asked_for = [](const std::string& path) {
    return path.ends_with(".glb") || path == "tileset.json" || path.starts_with("tilesets/") ||
           path == "explain/places.tsv";
  };
  std::vector<std::string> folders = {""};
  if (places_of(root) != folders) std::ranges::copy(places_of(root), std::back_inserter(folders));
  for (const std::string& folder : folders) {
    const Json record = read_json(root + "/" + folder + "build.json");
    const Json files = record.value("files", Json::object());
    for (const auto& [path, entry] : files.items()) {
      if (asked_for(path)) out.push_back(std::string(kModel) + prefix + folder + path);
      constexpr std::string_view kFolder = "explain/", kLines = ".jsonl.gz";
      if (path.starts_with(kFolder) && path.ends_with(kLines))
        out.push_back(std::string(kExplained) + prefix +
                      path.substr(kFolder.size(), path.size() - kFolder.size() - kLines.size()) + std::string(kEnd));
    }
  }
  return out;
}

}  // namespace blockrand::view
