#include "tests/unit/importers/reference/gltf_support.h"

#include <cstring>

namespace blockrand::importers::reference::test {

int GltfMaker::view(const void* bytes, std::size_t size, int stride) {
  binary.resize((binary.size() + 7) / 8 * 8);
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", size}});
  if (stride > 0) json["bufferViews"].back()["byteStride"] = stride;
  binary.append(static_cast<const char*>(bytes), size);
  return static_cast<int>(json["bufferViews"].size()) - 1;
}

int GltfMaker::mesh(nlohmann::json attributes, int indices, int mode) {
  nlohmann::json primitive = {{"attributes", std::move(attributes)}, {"mode", mode}};
  if (indices >= 0) primitive["indices"] = indices;
  json["meshes"].push_back({{"primitives", {primitive}}});
  return static_cast<int>(json["meshes"].size()) - 1;
}

int GltfMaker::node(nlohmann::json members) {
  json["nodes"].push_back(std::move(members));
  return static_cast<int>(json["nodes"].size()) - 1;
}

int GltfMaker::cube(float s, nlohmann::json attributes) {
  const std::vector<float> corners{0, 0, 0, s, 0, 0, s, 0, -s, 0, 0, -s, 0, s, 0, s, s, 0, s, s, -s, 0, s, -s};
  const std::vector<std::uint16_t> triangles{0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                             1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  attributes["POSITION"] = accessor(corners, "VEC3", 5126);
  return mesh(std::move(attributes), accessor(triangles, "SCALAR", 5123));
}

void GltfMaker::place(double lon, double lat, double height, const std::string& crs) {
  json["asset"]["extras"]["georeference"] = {
      {"crs", crs},
      {"height_reference", "heights above local ground, ground at ellipsoid height 0"},
      {"origin", {{"longitude", lon}, {"latitude", lat}, {"height", height}}}};
}

nlohmann::json GltfMaker::texts(const std::vector<std::string>& values) {
  std::string all;
  std::vector<std::uint32_t> offsets{0};
  for (const std::string& v : values) {
    all += v;
    offsets.push_back(static_cast<std::uint32_t>(all.size()));
  }
  const int bytes = view(all.data(), all.size());
  return {{"values", bytes}, {"stringOffsets", view(offsets.data(), offsets.size() * 4)}};
}

std::string GltfMaker::glb() const {
  nlohmann::json whole = json;
  if (!binary.empty()) whole["buffers"][0] = {{"byteLength", binary.size()}};
  return glb_of(whole.dump(), binary);
}

std::string GltfMaker::gltf(const std::string& buffer_file) const {
  nlohmann::json whole = json;
  std::string uri = buffer_file;
  if (uri.empty()) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uri = "data:application/octet-stream;base64,";
    for (std::size_t i = 0; i < binary.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k)
        bits = bits << 8 | (i + k < binary.size() ? static_cast<unsigned char>(binary[i + k]) : 0U);
      for (std::size_t k = 0; k < 4; ++k) uri += i + k <= binary.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  whole["buffers"] = {{{"byteLength", binary.size()}, {"uri", uri}}};
  return whole.dump();
}

std::string glb_of(std::string_view json, std::string_view binary) {
  std::string out = "glTF";
  const auto word = [&](std::uint32_t v) { out.append(reinterpret_cast<const char*>(&v), 4); };
  std::string text(json), bytes(binary);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  bytes.resize((bytes.size() + 3) / 4 * 4);
  word(2);
  word(static_cast<std::uint32_t>(12 + 8 + text.size() + (bytes.empty() ? 0 : 8 + bytes.size())));
  word(static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  if (bytes.empty()) return out;
  word(static_cast<std::uint32_t>(bytes.size()));
  out += std::string("BIN\0", 4) + bytes;
  return out;
}

}  // namespace blockrand::importers::reference::test
