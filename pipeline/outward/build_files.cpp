#include "pipeline/outward/build_files.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "pipeline/base/error.h"
#include "pipeline/base/sha256.h"
#include "pipeline/outputs/area_folders.h"

namespace blockrand::outward {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const char* const kRemedy = "Build again; 'blockrand validate FOLDER' tells what else is damaged.";

Json read_object(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw base::InputError(path, "", "cannot be read", kRemedy);
  Json json = Json::parse(file, nullptr, false);
  if (!json.is_object()) throw base::InputError(path, "", "is no JSON object: it is damaged", kRemedy);
  return json;
}

/// Whether a path stays below its folder and can stand in a list with a file a line.
bool is_plain(const std::string& path) {
  if (path.empty() || path.front() == '/') return false;
  if (std::ranges::any_of(path, [](char c) { return static_cast<unsigned char>(c) < 0x20; })) return false;
  return std::ranges::none_of(fs::path(path), [](const fs::path& part) { return part == ".." || part == "."; });
}

void add_record(const std::string& folder, const std::string& prefix, std::map<std::string, BuildFile>& files) {
  const std::string place = folder + "/" + prefix + "build.json";
  const Json record = read_object(place);
  if (!record.contains("files") || !record["files"].is_object())
    throw base::InputError(place, "files", "is missing: this program does not know builds without it", kRemedy);
  const auto add = [&](BuildFile file) {
    file.step = step_of(file.path);
    files[file.path] = std::move(file);
  };
  for (const auto& [path, entry] : record["files"].items()) {
    if (!is_plain(path) || !entry.is_object() || !entry.contains("sha256") || !entry["sha256"].is_string())
      throw base::InputError(place, "files", "'" + path + "' is no file of a build, or has no hash", kRemedy);
    add({.path = prefix + path, .bytes = entry.value("bytes", std::uint64_t{0}), .sha256 = entry["sha256"]});
  }
  BuildFile own{.path = prefix + "build.json", .bytes = fs::file_size(place), .sha256 = base::sha256_file(place)};
  own.level = prefix.empty() ? 1 : 0;
  add(own);
}

/// `uri` of a file at `from`, relative to the build; empty where it leads elsewhere.
std::string resolved(const std::string& from, const std::string& uri) {
  if (uri.empty() || uri.starts_with("data:") || uri.find("://") != std::string::npos) return {};
  const std::string file = uri.substr(0, uri.find_first_of("?#"));
  return (fs::path(from).parent_path() / file).lexically_normal().generic_string();
}

/// Addresses of contents of a tile and of all below it.
void add_contents(const Json& tile, std::vector<std::string>& uris) {
  // A stack of our own: a damaged file may nest deeper than the machine's.
  std::vector<const Json*> waiting{&tile};
  while (!waiting.empty()) {
    const Json& here = *waiting.back();
    waiting.pop_back();
    if (!here.is_object()) continue;
    const auto take = [&](const Json& content) {
      if (content.is_object() && content.contains("uri") && content["uri"].is_string()) uris.push_back(content["uri"]);
    };
    if (here.contains("content")) take(here["content"]);
    if (here.contains("contents") && here["contents"].is_array())
      for (const Json& content : here["contents"]) take(content);
    if (here.contains("children") && here["children"].is_array())
      for (const Json& child : here["children"]) waiting.push_back(&child);
  }
}

/// Sets the level of each tileset that the outermost one leads to.
class Levels {
 public:
  Levels(const std::string& folder, std::map<std::string, BuildFile>& files) : folder_(folder), files_(files) {}

  int level_of(const std::string& path, int depth = 0) {
    if (const auto known = levels_.find(path); known != levels_.end()) return known->second;
    constexpr int kDeepest = 64;  // a quadtree has 32 levels
    if (depth > kDeepest)
      throw base::InputError(folder_ + "/" + path, "", "tilesets lead to each other in a circle", kRemedy);
    int level = 0;
    for (const std::string& to : contents_of_tileset(folder_, path)) {
      const auto found = files_.find(to);
      if (found == files_.end())
        throw base::InputError(folder_ + "/" + path, "", "leads to " + to + ", which the build does not name", kRemedy);
      if (!to.ends_with(".json")) continue;
      found->second.step = Step::tilesets;
      level = std::max(level, 1 + level_of(to, depth + 1));
    }
    levels_[path] = level;
    files_.at(path).level = level;
    return level;
  }

 private:
  const std::string& folder_;
  std::map<std::string, BuildFile>& files_;
  std::map<std::string, int> levels_;
};

}  // namespace

std::string_view name(Step step) {
  switch (step) {
    case Step::contents:
      return "contents";
    case Step::tiles:
      return "tiles";
    case Step::tilesets:
      return "tilesets";
    case Step::documents:
      return "documents";
    case Step::record:
      return "record";
  }
  return "";
}

Step step_of(std::string_view path) {
  // Servers hand it out as the plain file (build --precompress).
  if (path.ends_with(".gz")) return step_of(path.substr(0, path.size() - 3));
  const std::string_view file = path.substr(path.rfind('/') == std::string_view::npos ? 0 : path.rfind('/') + 1);
  if (file == "build.json") return Step::record;
  if (file == "tileset.json" || path.starts_with("tilesets/")) return Step::tilesets;
  if (file.ends_with(".glb")) return Step::tiles;
  for (const std::string_view end : {".html", ".vrt", ".qgz"})
    if (file.ends_with(end)) return Step::documents;
  return Step::contents;
}

std::vector<std::string> contents_of_tileset(const std::string& folder, const std::string& path) {
  const Json tileset = read_object(folder + "/" + path);
  std::vector<std::string> uris, out;
  if (tileset.contains("root")) add_contents(tileset["root"], uris);
  for (const std::string& uri : uris)
    if (std::string to = resolved(path, uri); !to.empty()) out.push_back(std::move(to));
  return out;
}

std::vector<std::string> companions_of_glb(const std::string& folder, const std::string& path) {
  // glTF 2.0, 4.4: a header of 12 bytes, then the JSON chunk: length, type, text.
  std::ifstream file(folder + "/" + path, std::ios::binary);
  char head[20];
  std::uint32_t length = 0;
  if (!file.read(head, sizeof head) || std::memcmp(head, "glTF", 4) != 0)
    throw base::InputError(folder + "/" + path, "", "is no GLB file", kRemedy);
  std::memcpy(&length, head + 12, 4);
  std::error_code error;
  if (length > fs::file_size(folder + "/" + path, error) || error)
    throw base::InputError(folder + "/" + path, "", "is cut off", kRemedy);
  std::string text(length, '\0');
  file.read(text.data(), length);
  const Json gltf = Json::parse(text, nullptr, false);
  std::vector<std::string> out;
  for (const char* list : {"buffers", "images"})
    if (gltf.is_object() && gltf.contains(list) && gltf[list].is_array())
      for (const Json& entry : gltf[list])
        if (entry.is_object() && entry.contains("uri") && entry["uri"].is_string())
          if (std::string to = resolved(path, entry["uri"]); !to.empty()) out.push_back(std::move(to));
  return out;
}

std::map<std::string, BuildFile> files_of_build(const std::string& folder) {
  std::map<std::string, BuildFile> files;
  add_record(folder, "", files);
  for (const std::string& area : outputs::area_folders(folder)) add_record(folder, area + "/", files);
  if (files.contains("tileset.json")) Levels(folder, files).level_of("tileset.json");
  for (auto& [path, file] : files)
    if (path.ends_with(".gz"))
      if (const auto plain = files.find(path.substr(0, path.size() - 3)); plain != files.end())
        file.step = plain->second.step, file.level = plain->second.level;
  return files;
}

}  // namespace blockrand::outward
