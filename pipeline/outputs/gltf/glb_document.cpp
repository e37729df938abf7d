#include "pipeline/outputs/gltf/glb_document.h"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "pipeline/base/parallel.h"
#include "pipeline/outputs/gltf/meshopt.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {

static_assert(std::endian::native == std::endian::little, "buffers are copied as they lie in memory");

namespace {

constexpr std::size_t kAlignment = 8;              // what property tables need; of all views, for simplicity
constexpr std::uint64_t kMostBytes = 0xFFFF0000u;  // sizes are 32-bit numbers

struct StreamInfo {
  std::size_t size;  ///< bytes of an element
  bool vertices;     ///< a vertex attribute: its stride is stated
  MeshoptCoding coding;
};

StreamInfo info_of(Stream stream) {
  switch (stream) {
    case Stream::positions:
      return {12, true, MeshoptCoding::steps};
    case Stream::tile_positions:
      return {12, true, MeshoptCoding::tile_steps};
    case Stream::far_positions:
      return {12, true, MeshoptCoding::attributes};
    case Stream::normals:
    case Stream::features:
    case Stream::wide_features:
    case Stream::texture_places:
      return {4, true, MeshoptCoding::attributes};
    case Stream::colours:
    case Stream::element_positions:
    case Stream::texture_repeats:
      return {8, true, MeshoptCoding::attributes};
    case Stream::indices:
      return {2, false, MeshoptCoding::triangles};
    case Stream::translations:
      return {12, false, MeshoptCoding::whole};
    case Stream::far_translations:
    case Stream::scales:
      return {12, false, MeshoptCoding::attributes};
    case Stream::piece_scales:
      return {12, false, MeshoptCoding::scales};
    case Stream::rotations:
      return {8, false, MeshoptCoding::attributes};
    case Stream::wide_instance_features:
      return {4, false, MeshoptCoding::attributes};
    case Stream::instance_features:
      return {2, false, MeshoptCoding::attributes};
  }
  return {};
}

/// The stride that meshopt is told: its elements have a multiple of four bytes, so that two words go together.
std::size_t coded_size(Stream stream) {
  const std::size_t size = info_of(stream).size;
  return stream == Stream::instance_features ? 2 * size : size;
}

void pad(std::string& bytes, std::size_t alignment, char with = '\0') {
  bytes.resize((bytes.size() + alignment - 1) / alignment * alignment, with);
}

void append_list(std::string& out, const char* name, const std::vector<std::string>& entries) {
  if (entries.empty()) return;
  out += ",\"";
  out += name;
  out += "\":[";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i) out += ',';
    out += entries[i];
  }
  out += ']';
}

void field(std::string& out, const char* name, std::size_t value) {
  if (out.back() != '{') out += ',';
  out += '"';
  out += name;
  out += "\":";
  append_number(out, static_cast<std::int64_t>(value));
}

void append_word(std::string& out, std::uint64_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  out.append(reinterpret_cast<const char*>(&word), sizeof(word));
}

}  // namespace

GlbDocument::GlbDocument()
    : asset_(std::make_unique<nlohmann::json>()), extensions_(std::make_unique<nlohmann::ordered_json>()) {}
GlbDocument::~GlbDocument() = default;

int GlbDocument::view_of(Stream stream) {
  const auto [place, added] = view_numbers_.try_emplace(stream, static_cast<int>(views_.size()));
  if (added) views_.push_back({{}, stream});
  return place->second;
}

std::size_t GlbDocument::append_bytes(Stream stream, const void* bytes, std::size_t size) {
  std::string& to = views_[static_cast<std::size_t>(view_of(stream))].bytes;
  const std::size_t at = to.size();
  if (const auto more = expected_.find(stream); more != expected_.end()) {
    to.reserve(at + more->second * info_of(stream).size);
    expected_.erase(more);
  }
  to.append(static_cast<const char*>(bytes), size);
  return at;
}

int GlbDocument::add_view(std::string bytes) {
  views_.push_back({std::move(bytes), std::nullopt});
  return static_cast<int>(views_.size()) - 1;
}

int GlbDocument::add_accessor(const GlbAccessor& a) {
  std::string json = "{";
  field(json, "bufferView", static_cast<std::size_t>(view_of(a.stream)));
  if (a.offset > 0) field(json, "byteOffset", a.offset);
  field(json, "componentType", static_cast<std::size_t>(a.component));
  field(json, "count", a.count);
  if (a.bounds)
    for (const int end : {1, 0}) {
      json += end ? ",\"max\":[" : ",\"min\":[";
      for (std::size_t i = 0; i < 3; ++i) {
        if (i) json += ',';
        append_number(json, (*a.bounds)[static_cast<std::size_t>(end)][i]);
      }
      json += ']';
    }
  if (a.normalised) json += ",\"normalized\":true";
  json += ",\"type\":\"";
  json += a.type;
  json += "\"}";
  accessors_.push_back(std::move(json));
  return static_cast<int>(accessors_.size()) - 1;
}

int GlbDocument::add_material(const std::string& json) {
  const auto [place, added] = material_numbers_.try_emplace(json, static_cast<int>(materials_.size()));
  if (added) materials_.push_back(json);
  return place->second;
}
int GlbDocument::add_texture(std::string png) {
  std::string json = "{";
  field(json, "bufferView", static_cast<std::size_t>(add_view(std::move(png))));
  images_.push_back(json + ",\"mimeType\":\"image/png\"}");
  textures_.push_back({.sampler = Sampler::nearest, .extensions = {}, .image = images_.size() - 1});
  return static_cast<int>(textures_.size()) - 1;
}
int GlbDocument::add_repeated_texture(const std::string& webp, const std::string& png) {
  return add_file_texture(webp, png, Sampler::repeated);
}
int GlbDocument::add_covering_texture(const std::string& webp, const std::string& png) {
  return add_file_texture(webp, png, Sampler::covering);
}
int GlbDocument::add_file_texture(const std::string& webp, const std::string& png, Sampler sampler) {
  const auto [place, added] = file_textures_.try_emplace(webp, static_cast<int>(textures_.size()));
  if (!added) return place->second;
  for (const auto& [path, type] : {std::pair(&png, "image/png"), std::pair(&webp, "image/webp")}) {
    std::string image = "{\"mimeType\":\"";
    image += type;
    image += "\",\"uri\":";
    append_json(image, *path);
    images_.push_back(image + '}');
  }
  std::string extensions = "\"extensions\":{\"EXT_texture_webp\":{";
  field(extensions, "source", images_.size() - 1);
  textures_.push_back({.sampler = sampler, .extensions = extensions + "}},", .image = images_.size() - 2});
  use("EXT_texture_webp", false);
  return place->second;
}
int GlbDocument::add_mesh(std::string json) {
  meshes_.push_back(std::move(json));
  return static_cast<int>(meshes_.size()) - 1;
}
int GlbDocument::add_node(std::string json) {
  nodes_.push_back(std::move(json));
  return static_cast<int>(nodes_.size()) - 1;
}

void GlbDocument::use(const std::string& extension, bool required) {
  bool& known = used_[extension];
  known = known || required;
}

std::string GlbDocument::write(Compression compression) {
  const bool compress = compression == Compression::meshopt && !view_numbers_.empty();
  if (compress) use("EXT_meshopt_compression", true);

  std::vector<std::size_t> lengths;  // of views before they are compressed
  for (View& view : views_) {
    if (view.stream && info_of(*view.stream).coding != MeshoptCoding::triangles)
      pad(view.bytes, coded_size(*view.stream));
    lengths.push_back(view.bytes.size());
  }
  if (compress)
    base::share(views_.size(), [&](std::size_t i) {
      View& view = views_[i];
      if (!view.stream) return;
      const std::size_t size = coded_size(*view.stream);
      view.bytes = meshopt_encode(view.bytes, size, lengths[i] / size, info_of(*view.stream).coding);
    });

  // Bytes stay in their views until the file is put together: each is copied once.
  std::uint64_t end = 0;       // of the binary part
  std::uint64_t unpacked = 0;  // size of the buffer that is there once everything is decompressed
  std::vector<std::string> views;
  const auto aligned = [](std::uint64_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; };
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const View& view = views_[i];
    std::string json = "{";
    end = aligned(end);
    if (!view.stream) {
      field(json, "buffer", 0);
      field(json, "byteLength", view.bytes.size());
      if (end > 0) field(json, "byteOffset", end);
    } else {
      const StreamInfo info = info_of(*view.stream);
      const std::size_t length = lengths[i];
      const std::uint64_t offset = compress ? unpacked : end;
      field(json, "buffer", compress ? 1 : 0);
      field(json, "byteLength", length);
      if (offset > 0) field(json, "byteOffset", offset);
      if (info.vertices) field(json, "byteStride", info.size);
      if (compress) {
        const std::size_t size = coded_size(*view.stream);
        const std::size_t count = length / size;
        json += ",\"extensions\":{\"EXT_meshopt_compression\":{";
        field(json, "buffer", 0);
        field(json, "byteLength", view.bytes.size());
        if (end > 0) field(json, "byteOffset", end);
        field(json, "byteStride", size);
        field(json, "count", count);
        json += info.coding == MeshoptCoding::triangles ? ",\"mode\":\"TRIANGLES\"" : ",\"mode\":\"ATTRIBUTES\"";
        if (has_filter(info.coding)) json += ",\"filter\":\"EXPONENTIAL\"";
        json += "}}";
        unpacked += aligned(length);
      }
      if (info.vertices || *view.stream == Stream::indices) field(json, "target", info.vertices ? 34962 : 34963);
    }
    json += '}';
    views.push_back(std::move(json));
    end += view.bytes.size();
    if (end > kMostBytes || unpacked > kMostBytes) throw std::length_error("too much data for one GLB");
  }

  std::string json = "{\"asset\":" + asset_->dump();
  std::vector<std::string> used, required;
  for (const auto& [name, must] : used_) {
    used.push_back('"' + name + '"');
    if (must) required.push_back(used.back());
  }
  append_list(json, "extensionsUsed", used);
  append_list(json, "extensionsRequired", required);
  if (!extensions_->is_null()) json += ",\"extensions\":" + extensions_->dump();
  if (!roots_.empty()) {
    json += ",\"scene\":0,\"scenes\":[{\"nodes\":[";
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      if (i) json += ',';
      append_number(json, static_cast<std::int64_t>(roots_[i]));
    }
    json += "]}]";
  }
  append_list(json, "nodes", nodes_);
  append_list(json, "meshes", meshes_);
  append_list(json, "materials", materials_);
  append_list(json, "images", images_);
  if (!textures_.empty()) {
    std::vector<std::string> samplers, textures;
    std::map<Sampler, std::int64_t> number;
    for (const auto& [sampler, json_text] :
         {// Nearest pixel, not beyond the edge.
          std::pair(Sampler::nearest, "{\"magFilter\":9728,\"minFilter\":9728,\"wrapS\":33071,\"wrapT\":33071}"),
          // Mixed and repeated; from afar the mean.
          std::pair(Sampler::repeated, "{\"magFilter\":9729,\"minFilter\":9987,\"wrapS\":10497,\"wrapT\":10497}"),
          std::pair(Sampler::covering, "{\"magFilter\":9729,\"minFilter\":9987,\"wrapS\":33071,\"wrapT\":33071}")}) {
      if (std::ranges::none_of(textures_, [&](const Texture& t) { return t.sampler == sampler; })) continue;
      number[sampler] = static_cast<std::int64_t>(samplers.size());
      samplers.emplace_back(json_text);
    }
    for (const Texture& texture : textures_) {
      std::string& text = textures.emplace_back("{" + texture.extensions);
      text += "\"sampler\":";
      append_number(text, number.at(texture.sampler));
      text += ",\"source\":";
      append_number(text, static_cast<std::int64_t>(texture.image));
      text += '}';
    }
    append_list(json, "samplers", samplers);
    append_list(json, "textures", textures);
  }
  append_list(json, "accessors", accessors_);
  append_list(json, "bufferViews", views);
  std::vector<std::string> buffers;
  if (end > 0) {
    buffers.emplace_back("{");
    field(buffers.back(), "byteLength", end);
    buffers.back() += '}';
  }
  if (compress) {
    // Only a loader that decompresses gives it bytes.
    buffers.emplace_back("{");
    field(buffers.back(), "byteLength", unpacked);
    buffers.back() += ",\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}";
  }
  append_list(json, "buffers", buffers);
  json += '}';
  pad(json, 4, ' ');
  const std::uint64_t binary = (end + 3) / 4 * 4;

  std::string out = "glTF";
  const std::uint64_t total = 12 + 8 + json.size() + (binary == 0 ? 0 : 8 + binary);
  if (total > kMostBytes) throw std::length_error("too much data for one GLB");
  out.reserve(total);
  append_word(out, 2);
  append_word(out, total);
  append_word(out, json.size());
  out += "JSON";
  out += json;
  if (binary > 0) {
    append_word(out, binary);
    out.append("BIN\0", 4);
    const std::size_t begin = out.size();
    for (View& view : views_) {
      out.resize(begin + aligned(out.size() - begin));
      out += view.bytes;
      view.bytes = {};
    }
    out.resize(begin + binary);
  }
  return out;
}

}  // namespace blockrand::outputs
