#include "importers/reference/read_model.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "importers/reference/citygml.h"
#include "importers/reference/cityjson.h"
#include "importers/reference/coordinate_text.h"
#include "importers/reference/file_bytes.h"
#include "importers/reference/gltf.h"
#include "importers/reference/json_access.h"
#include "pipeline/base/error.h"

namespace blockrand::importers::reference {
namespace {

namespace fs = std::filesystem;

enum class Format { unknown, too_deep, citygml, cityjson, gltf, tileset, old_tile };

bool any_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Reads JSON until a member of the outermost object says of which format it is.
class FormatSniffer : public nlohmann::json_sax<Json> {
 public:
  Format format = Format::unknown;
  bool has_asset = false;  ///< of glTF and of 3D Tiles

  bool key(std::string& name) override {
    if (depth_ != 1) return true;
    key_ = name;
    if (any_of(name, {"CityObjects", "vertices"})) format = Format::cityjson;
    if (any_of(name, {"root", "geometricError"})) format = Format::tileset;
    if (any_of(name, {"accessors", "buffers", "bufferViews", "materials", "meshes", "nodes", "scene", "scenes"}))
      format = Format::gltf;
    has_asset = has_asset || name == "asset";
    return format == Format::unknown;
  }
  bool string(std::string& value) override {
    if (depth_ == 1 && key_ == "type" && value.starts_with("CityJSON")) format = Format::cityjson;
    return format == Format::unknown;
  }
  bool start_object(std::size_t) override { return enter(); }
  bool end_object() override { return depth_-- > 1; }
  bool start_array(std::size_t) override { return enter() && depth_ > 1; }  // no format is an array
  bool end_array() override { return depth_-- > 0; }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const std::string&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }

 private:
  bool enter() {
    if (++depth_ > kDeepestJson) format = Format::too_deep;
    return format == Format::unknown;
  }

  std::size_t depth_ = 0;
  std::string key_;
};

Format format_of_json(std::string_view text) {
  FormatSniffer sniffer;
  Json::sax_parse(text.begin(), text.end(), &sniffer, Json::input_format_t::json, false);
  return sniffer.format == Format::unknown && sniffer.has_asset ? Format::gltf : sniffer.format;
}

std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return trimmed(text);
}

/// \throws base::InputError  when the file cannot be opened
Format format_of(const std::string& path) {
  constexpr std::size_t kEnough = 1U << 20;
  const std::string head = first_bytes(path, kEnough);
  const std::string_view text = without_byte_order_mark(head);
  if (text.starts_with("glTF")) return Format::gltf;
  if (any_of(text.substr(0, 4), {"b3dm", "i3dm", "pnts", "cmpt"})) return Format::old_tile;
  if (text.starts_with("{")) {
    const Format format = format_of_json(text);
    if (format != Format::unknown || head.size() < kEnough) return format;
    const std::string all = all_bytes(path);
    return format_of_json(without_byte_order_mark(all));
  }
  // UTF-16 begins with FE FF or FF FE; libxml2 knows better whether it is XML.
  if (text.starts_with("<") || text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE")) return Format::citygml;
  return Format::unknown;
}

/// The name's end without ".gz".
std::string extension_of(const fs::path& path) {
  fs::path name = path.filename();
  if (name.extension() == ".gz") name = name.stem();
  std::string out = name.extension().string();
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

/// Whether a file is a model, by its name first.
bool is_model(const fs::path& path) {
  const std::string extension = extension_of(path);
  if (any_of(extension, {".gml", ".jsonl", ".glb", ".gltf"})) return true;
  if (extension == ".xml") {  // code lists and others are XML, too
    constexpr std::size_t kRoot = 1U << 14;
    return first_bytes(path.string(), kRoot).find("citygml") != std::string::npos;
  }
  if (extension != ".json") return false;
  const Format format = format_of(path.string());
  return format != Format::unknown && format != Format::too_deep;
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) out.push_back(*it);
  std::sort(out.begin(), out.end());
  return out;
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}
bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

std::vector<std::string> files_with(const fs::path& folder, std::string_view extension) {
  std::vector<std::string> out;
  for (const fs::path& entry : sorted_entries(folder))
    if (is_file(entry) && extension_of(entry) == extension) out.push_back(entry.string());
  return out;
}

/// The best format of a build: solids with classes, and no reader of triangles can know more.
std::vector<std::string> files_of_build(const fs::path& folder) {
  std::vector<std::string> out = files_with(folder / "citygml", ".gml");
  if (out.empty()) out = files_with(folder / "cityjson", ".jsonl");
  if (out.empty()) out = files_with(folder, ".json");
  std::erase_if(out, [](const std::string& path) {
    const std::string name = fs::path(path).filename().string();
    return extension_of(path) == ".json" && name != "model.city.json" && name != "tileset.json";
  });
  if (out.size() > 1 && fs::path(out[0]).filename() == "model.city.json") out.resize(1);  // the tileset has the same
  if (out.empty()) out = files_with(folder, ".glb");
  return out;
}

void collect(const fs::path& folder, bool in_tileset, int depth, std::vector<std::string>& out) {
  constexpr int kDeepest = 64;  // links to folders may stand in a circle
  if (depth > kDeepest) return;
  if (is_file(folder / "build.json") && is_folder(folder / "areas")) {
    collect(folder / "areas", true, depth + 1, out);  // each is a build
    return;
  }
  if (is_file(folder / "build.json")) {
    for (std::string& path : files_of_build(folder)) out.push_back(std::move(path));
    return;
  }
  const bool has_tileset = is_file(folder / "tileset.json");
  if (has_tileset && !in_tileset) out.push_back((folder / "tileset.json").string());
  in_tileset = in_tileset || has_tileset;
  for (const fs::path& entry : sorted_entries(folder)) {
    if (is_folder(entry)) {
      collect(entry, in_tileset, depth + 1, out);
    } else if (is_file(entry) && is_model(entry)) {
      const std::string extension = extension_of(entry);
      const bool placed = in_tileset && (any_of(extension, {".glb", ".gltf"}) ||
                                         (extension == ".json" && format_of(entry.string()) != Format::cityjson));
      if (!placed) out.push_back(entry.string());
    }
  }
}

}  // namespace

ReferenceModel read_model(const std::string& path, const ReadOptions& options) {
  check_readable(path);
  switch (format_of(path)) {
    case Format::citygml:
      return read_citygml(path, options);
    case Format::cityjson:
      return read_cityjson(path, options);
    case Format::gltf:
    case Format::tileset:
    case Format::old_tile:  // refused with what to do
      return read_gltf(path, options);
    case Format::too_deep:
      throw base::InputError(path, "", too_deep_text(), "The file is damaged, or no model");
    case Format::unknown:
      break;
  }
  throw base::InputError(path, "", "is no model of a format that is read",
                         "CityGML, CityJSON, glTF and 3D Tiles are, also gzipped");
}

std::vector<std::string> model_files(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw base::InputError(path, "", "there is no such file or folder", "");
  if (!is_folder(path)) return {path};
  std::vector<std::string> out;
  collect(path, false, 0, out);
  if (out.empty())
    throw base::InputError(path, "", "no model in this folder",
                           "CityGML (.gml, .xml), CityJSON (.json, .jsonl), glTF (.glb, .gltf) and 3D Tiles "
                           "(tileset.json) are read, also with .gz");
  return out;
}

}  // namespace blockrand::importers::reference
