#include "importers/reference/gltf_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <utility>

#include "importers/reference/file_bytes.h"
#include "importers/reference/matrix4.h"
#include "importers/reference/meshopt_views.h"
#include "pipeline/base/error.h"
#include "pipeline/base/json_depth.h"

namespace blockrand::importers::reference {
namespace {

static_assert(std::endian::native == std::endian::little, "buffers are read as they lie in memory");

namespace fs = std::filesystem;

/// Values of an accessor that no buffer stands behind: more are a mistake or an attack.
constexpr std::size_t kMostWithoutBytes = 10'000'000;

/// Extensions of a packed buffer view: the ratified name and the vendors'.
constexpr std::array<const char*, 2> kMeshopt{"EXT_meshopt_compression", "KHR_meshopt_compression"};

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  std::memcpy(&out, bytes.data() + at, sizeof(out));
  return out;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (low >= 0) {
      out += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

/// Nothing where there is a foreign character.
std::optional<std::string> base64_decoded(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> value{};
  value.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i) value[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  std::string out;
  std::uint32_t bits = 0;
  int have = 0;
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  for (const char c : text) {
    const int v = value[static_cast<unsigned char>(c)];
    if (v < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(v);
    have += 6;
    if (have >= 8) {
      have -= 8;
      out += static_cast<char>(bits >> have & 0xFF);
    }
  }
  return out;
}

std::size_t components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  return 0;  // matrices are never positions, indices or features
}

}  // namespace

Matrix4 from_parts(const std::array<double, 3>& t, const std::array<double, 4>& rotation,
                   const std::array<double, 3>& s) {
  double norm = 0;
  for (const double v : rotation) norm += v * v;
  if (!(norm > 0)) norm = 1;
  const double scale = std::sqrt(norm);
  const double x = rotation[0] / scale, y = rotation[1] / scale, z = rotation[2] / scale, w = rotation[3] / scale;
  return {(1 - 2 * (y * y + z * z)) * s[0],
          2 * (x * y + z * w) * s[0],
          2 * (x * z - y * w) * s[0],
          0,
          2 * (x * y - z * w) * s[1],
          (1 - 2 * (x * x + z * z)) * s[1],
          2 * (y * z + x * w) * s[1],
          0,
          2 * (x * z + y * w) * s[2],
          2 * (y * z - x * w) * s[2],
          (1 - 2 * (x * x + y * y)) * s[2],
          0,
          t[0],
          t[1],
          t[2],
          1};
}

Json parse_json(const std::string& path, std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (base::json_depth(text) > kDeepestJson)
    throw base::InputError(path, "", too_deep_text(), "The file is damaged, or no model");
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::exception& error) {
    std::string what = error.what();
    if (const std::size_t end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
    throw base::InputError(path, "", "is no JSON that can be read: " + what, "The file is damaged or cut off");
  }
}

std::string file_of_uri(const std::string& folder, const std::string& uri) {
  if (uri.find("://") != std::string::npos) return "";
  const std::string name = percent_decoded(std::string_view(uri).substr(0, uri.find_first_of("?#")));
  return (fs::path(folder) / fs::path(name)).lexically_normal().string();
}

std::size_t component_size(int component_type) {
  switch (component_type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5124:  // INT: in property tables only
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

namespace {
template <class T>
double load(const unsigned char* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<double>(value);
}
}  // namespace

double component_at(const unsigned char* bytes, int component_type) {
  switch (component_type) {
    case 5120:
      return load<std::int8_t>(bytes);
    case 5121:
      return load<std::uint8_t>(bytes);
    case 5122:
      return load<std::int16_t>(bytes);
    case 5123:
      return load<std::uint16_t>(bytes);
    case 5124:
      return load<std::int32_t>(bytes);
    case 5125:
      return load<std::uint32_t>(bytes);
    case 5126:
      return load<float>(bytes);
    default:
      return 0;
  }
}

double component_maximum(int component_type) {
  switch (component_type) {
    case 5120:
      return 127;
    case 5121:
      return 255;
    case 5122:
      return 32767;
    case 5123:
      return 65535;
    case 5124:
      return 2147483647;
    case 5125:
      return 4294967295;
    default:
      return 0;
  }
}

GltfFile::GltfFile(const std::string& path, NoteLog& notes)
    : path_(path), folder_(fs::path(path).parent_path().string()), notes_(notes), bytes_(size_on_disk(path)) {
  check_readable(path);
  std::string bytes = all_bytes(path), text, binary;
  if (bytes.starts_with("glTF")) {
    read_container(bytes, text, binary);
  } else {
    text = std::move(bytes);
  }
  json_ = parse_json(path, text);
  const std::string version = reference::text(member(member(json_, "asset"), "version"));
  if (version.empty()) throw base::InputError(path, "", "is no glTF: it has no asset.version", "");
  if (!version.starts_with("2."))
    throw base::InputError(path, "", "is glTF " + version, "Version 2.0 is read; gltf-pipeline converts it");
  check_extensions(notes);
  read_buffers(std::move(binary));
  unpack_views();
}

void GltfFile::read_container(std::string& bytes, std::string& json, std::string& binary) const {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw base::InputError(path_, "", what, remedy);
  };
  if (bytes.size() < kHeader) refuse("is a GLB that ends in its header", "The file is cut off");
  if (const std::uint32_t version = word_at(bytes, 4); version != 2)
    refuse("is a GLB of version " + std::to_string(version), "Version 2 is read; gltf-pipeline converts it");
  const std::size_t stated = word_at(bytes, 8);
  if (stated > bytes.size())
    refuse("is a GLB of " + std::to_string(stated) + " bytes of which " + std::to_string(bytes.size()) + " are there",
           "The file is cut off");
  for (std::size_t at = kHeader; at + kChunkHeader <= stated;) {
    const std::size_t size = word_at(bytes, at);
    const std::uint32_t type = word_at(bytes, at + 4);
    at += kChunkHeader;
    if (size > stated - at) refuse("has a chunk that reaches beyond its end", "The file is damaged");
    if (type == kJsonChunk && json.empty()) json = bytes.substr(at, size);
    if (type == kBinaryChunk && binary.empty()) binary = bytes.substr(at, size);
    at += size;
  }
  if (json.empty()) refuse("is a GLB without JSON", "The file is damaged");
  bytes.clear();
}

void GltfFile::refuse_compression(const std::string& what) const {
  throw base::InputError(path_, "", "its geometry is compressed by " + what + ", which is not read",
                         "Decompress it first, for instance: npx @gltf-transform/cli copy IN OUT");
}

void GltfFile::check_extensions(NoteLog& notes) const {
  // What changes no geometry needs no reading.
  constexpr std::array<std::string_view, 8> kRead{
      "KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "EXT_mesh_features",       "EXT_structural_metadata",
      "EXT_instance_features", "KHR_texture_transform",   "EXT_meshopt_compression", "KHR_meshopt_compression"};
  for (const Json& name : member(json_, "extensionsRequired")) {
    const std::string extension = text(name);
    if (extension == "KHR_draco_mesh_compression") refuse_compression("Draco (" + extension + ")");
    const bool looks = extension.starts_with("KHR_materials") || extension.starts_with("KHR_texture") ||
                       extension.starts_with("EXT_texture") || extension.starts_with("KHR_lights");
    if (!looks && std::find(kRead.begin(), kRead.end(), extension) == kRead.end())
      notes.add(NoteKind::not_read, 0, "extension " + extension + ", which the file requires");
  }
  // Where compression is not required, there is a way without it, unless it stands in for missing bytes.
  for (const Json& mesh : member(json_, "meshes"))
    for (const Json& primitive : member(mesh, "primitives")) {
      const Json& accessor =
          element_of(member(json_, "accessors"), member(member(primitive, "attributes"), "POSITION"));
      if (!member(member(primitive, "extensions"), "KHR_draco_mesh_compression").is_null() &&
          member(accessor, "bufferView").is_null())
        refuse_compression("Draco (KHR_draco_mesh_compression)");
    }
}

void GltfFile::refuse_files_beside() const {
  for (const Json& buffer : member(json_, "buffers"))
    if (const std::string uri = text(member(buffer, "uri")); !uri.empty() && !uri.starts_with("data:"))
      throw base::InputError(path_, "", "keeps its geometry in another file, " + uri, "Pack it into one .glb");
}

void GltfFile::read_buffers(std::string binary) {
  bool first = true;
  for (const Json& buffer : member(json_, "buffers")) {
    const std::string uri = text(member(buffer, "uri"));
    std::string bytes;
    if (uri.empty()) {
      // A stand-in for what unpack_views() makes.
      const bool packed = std::any_of(kMeshopt.begin(), kMeshopt.end(), [&](const char* name) {
        return member(member(buffer, "extensions"), name).is_object();
      });
      if (!first && packed) {
        buffers_.emplace_back();
        continue;
      }
      if (!first) throw base::InputError(path_, "", "has a buffer without bytes", "");
      bytes = std::move(binary);
    } else if (uri.starts_with("data:")) {
      const std::size_t comma = uri.find(',');
      const bool base64 = comma != std::string::npos && uri.substr(0, comma).ends_with(";base64");
      const auto decoded = base64 ? base64_decoded(std::string_view(uri).substr(comma + 1)) : std::nullopt;
      if (!decoded) throw base::InputError(path_, "", "has a buffer whose data uri is not base64", "");
      bytes = *decoded;
    } else {
      const std::string file = file_of_uri(folder_, uri);
      if (file.empty())
        throw base::InputError(path_, "", "its buffer " + uri + " lies on the network", "Fetch it and name the copy");
      std::error_code error;
      if (!fs::is_regular_file(file, error))
        throw base::InputError(path_, "", "its buffer " + file + " is missing", "Put it beside the .gltf file");
      bytes = all_bytes(file);
      bytes_ += size_on_disk(file);
    }
    first = false;
    buffers_.push_back(std::move(bytes));
  }
}

void GltfFile::unpack_views() {
  if (!member(json_, "bufferViews").is_array()) return;
  std::size_t number = 0;
  for (Json& view : json_["bufferViews"]) {
    for (const char* name : kMeshopt) {
      const Json& packed = member(member(view, "extensions"), name);
      if (!packed.is_object()) continue;
      std::string why;
      auto bytes = unpacked_view(packed, buffers_, why);
      if (!bytes)
        throw base::InputError(path_, "",
                               "has a bufferView " + std::to_string(number) + " that " + why + " (" + name + ")",
                               "Decompress it first, for instance: npx @gltf-transform/cli copy IN OUT");
      view["byteLength"] = bytes->size();
      view["byteOffset"] = 0;
      view["buffer"] = buffers_.size();
      buffers_.push_back(std::move(*bytes));
      break;
    }
    ++number;
  }
}

std::optional<std::span<const unsigned char>> GltfFile::view(const Json& number) {
  const auto i = index(number);
  const Json& view = element_of(member(json_, "bufferViews"), number);
  const auto buffer = index(member(view, "buffer"));
  const std::size_t offset = index(member(view, "byteOffset")).value_or(0);
  const auto length = index(member(view, "byteLength"));
  if (!buffer || *buffer >= buffers_.size() || !length || offset > buffers_[*buffer].size() ||
      *length > buffers_[*buffer].size() - offset) {
    notes_.add(NoteKind::bad_index, 0,
               "bufferView " + (i ? std::to_string(*i) : "without number") + " has no such bytes");
    return std::nullopt;
  }
  const auto* bytes = reinterpret_cast<const unsigned char*>(buffers_[*buffer].data());
  return std::span(bytes + offset, *length);
}

/// \param stride  bytes from one element to the next
/// \return false where there are not so many
bool GltfFile::fill(const Json& view_number, std::size_t offset, int component_type, std::size_t components,
                    std::size_t stride, std::size_t count, bool normalized, std::vector<double>& out) {
  const auto bytes = view(view_number);
  const std::size_t size = component_size(component_type);
  if (!bytes || size == 0 || stride < size * components) return false;
  if (count > 0 && (offset > bytes->size() || bytes->size() - offset < size * components ||
                    (bytes->size() - offset - size * components) / stride < count - 1))
    return false;
  const double largest = normalized ? component_maximum(component_type) : 0;
  out.resize(count * components);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < components; ++c) {
      double value = component_at(bytes->data() + offset + i * stride + c * size, component_type);
      if (largest > 0) value = std::max(value / largest, -1.0);
      out[i * components + c] = value;
    }
  return true;
}

std::size_t GltfFile::accessor_count(const Json& number) const {
  const Json& stated = element_of(member(json_, "accessors"), number);
  const std::size_t count = index(member(stated, "count")).value_or(0);
  const Json& view = member(stated, "bufferView");
  const auto bytes = index(member(element_of(member(json_, "bufferViews"), view), "byteLength"));
  std::size_t held = kMostWithoutBytes;
  if (!view.is_null()) {
    held = 0;
    for (const std::string& buffer : buffers_) held = std::max(held, buffer.size());
    held = std::min(held, bytes.value_or(0));
  }
  return count <= held ? count : 0;
}

std::optional<AccessorValues> GltfFile::accessor(const Json& number) {
  const auto i = index(number);
  const Json& stated = element_of(member(json_, "accessors"), number);
  const auto bad = [&](const std::string& what) {
    notes_.add(NoteKind::bad_index, 0, "accessor " + (i ? std::to_string(*i) : "without number") + what);
    return std::nullopt;
  };
  if (!stated.is_object()) return bad(" does not exist");
  const int type = static_cast<int>(index(member(stated, "componentType")).value_or(0) & 0xFFFF);
  const auto count = index(member(stated, "count"));
  const bool normalized = member(stated, "normalized") == true;
  AccessorValues out;
  out.components = components_of(text(member(stated, "type")));
  const std::size_t size = component_size(type);
  if (out.components == 0 || size == 0 || !count) return bad(" is of no type that is read");
  const Json& view_number = member(stated, "bufferView");
  if (view_number.is_null()) {
    if (*count > kMostWithoutBytes) return bad(" counts " + std::to_string(*count) + " values without bytes");
    out.values.assign(*count * out.components, 0);
  } else {
    const Json& view = element_of(member(json_, "bufferViews"), view_number);
    const std::size_t packed = size * out.components;
    const std::size_t stride = index(member(view, "byteStride")).value_or(0);
    if (!fill(view_number, index(member(stated, "byteOffset")).value_or(0), type, out.components,
              stride == 0 ? packed : stride, *count, normalized, out.values))
      return bad(" reaches out of its buffer");
  }
  const Json& sparse = member(stated, "sparse");
  if (!sparse.is_object()) return out;
  const Json &indices = member(sparse, "indices"), &values = member(sparse, "values");
  const auto changes = index(member(sparse, "count"));
  const int index_type = static_cast<int>(index(member(indices, "componentType")).value_or(0) & 0xFFFF);
  std::vector<double> places, replacements;
  if (!changes ||
      !fill(member(indices, "bufferView"), index(member(indices, "byteOffset")).value_or(0), index_type, 1,
            component_size(index_type), *changes, false, places) ||
      !fill(member(values, "bufferView"), index(member(values, "byteOffset")).value_or(0), type, out.components,
            size * out.components, *changes, normalized, replacements))
    return bad(" has sparse values that reach out of their buffers");
  for (std::size_t change = 0; change < *changes; ++change) {
    if (!(places[change] >= 0 && places[change] < static_cast<double>(*count)))
      return bad(" has a sparse value beyond its end");
    const auto at = static_cast<std::size_t>(places[change]) * out.components;
    std::copy_n(replacements.begin() + static_cast<std::ptrdiff_t>(change * out.components), out.components,
                out.values.begin() + static_cast<std::ptrdiff_t>(at));
  }
  return out;
}

}  // namespace blockrand::importers::reference
