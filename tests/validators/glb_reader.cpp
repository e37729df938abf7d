#include "tests/validators/glb_reader.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace blockrand::validators {
namespace {

using nlohmann::json;

/// The container, with checked access.
struct Glb {
  json document;
  std::string bin;

  explicit Glb(const std::string& bytes) {
    if (bytes.size() < 20 || bytes.compare(0, 4, "glTF") != 0) throw std::runtime_error("not a GLB");
    for (std::size_t at = 12; at + 8 <= bytes.size();) {
      std::uint32_t length = 0, type = 0;
      std::memcpy(&length, &bytes[at], 4);
      std::memcpy(&type, &bytes[at + 4], 4);
      if (at + 8 + length > bytes.size()) throw std::runtime_error("truncated GLB");
      if (type == 0x4E4F534A) document = json::parse(bytes.substr(at + 8, length));
      if (type == 0x004E4942) bin = bytes.substr(at + 8, length);
      at += 8 + length;
    }
    if (document.is_null()) throw std::runtime_error("no JSON chunk");
  }

  template <class T>
  T read(std::size_t at) const {
    if (at + sizeof(T) > bin.size()) throw std::runtime_error("read beyond the buffer");
    T value;
    std::memcpy(&value, &bin[at], sizeof(T));
    return value;
  }

  std::size_t view_start(const json& index) const {
    return document.at("bufferViews").at(index.get<std::size_t>()).value("byteOffset", 0u);
  }

  /// Component `c` of element `i`, decoded where normalised.
  std::vector<std::array<double, 4>> accessor(const json& index) const {
    const json& a = document.at("accessors").at(index.get<std::size_t>());
    const json& view = document.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
    const int type = a.at("componentType");
    const std::string shape = a.at("type");
    const int width = shape == "SCALAR" ? 1 : shape == "VEC2" ? 2 : shape == "VEC3" ? 3 : 4;
    const int size = type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
    const bool normalised = a.value("normalized", false);
    const std::size_t start = view.value("byteOffset", 0u) + a.value("byteOffset", 0u);
    const std::size_t stride = view.value("byteStride", static_cast<unsigned>(width * size));
    std::vector<std::array<double, 4>> out(a.at("count").get<std::size_t>());
    for (std::size_t i = 0; i < out.size(); ++i)
      for (int c = 0; c < width; ++c) {
        const std::size_t at = start + i * stride + static_cast<std::size_t>(c * size);
        double v = 0, scale = 1;
        switch (type) {
          case 5120:
            v = read<std::int8_t>(at);
            scale = 127;
            break;
          case 5121:
            v = read<std::uint8_t>(at);
            scale = 255;
            break;
          case 5122:
            v = read<std::int16_t>(at);
            scale = 32767;
            break;
          case 5123:
            v = read<std::uint16_t>(at);
            scale = 65535;
            break;
          case 5125:
            v = read<std::uint32_t>(at);
            break;
          case 5126:
            v = static_cast<double>(read<float>(at));
            break;
          default:
            throw std::runtime_error("unknown component type");
        }
        out[i][static_cast<std::size_t>(c)] = normalised ? v / scale : v;
      }
    return out;
  }
};

void read_table(const Glb& glb, GlbFile& file) {
  const json& document = glb.document;
  if (!document.contains("extensions") || !document["extensions"].contains("EXT_structural_metadata")) return;
  const json& extension = document["extensions"]["EXT_structural_metadata"];
  const json& table = extension.at("propertyTables").at(0);
  const json& schema = extension.at("schema");
  const json& properties = schema.at("classes").at(table.at("class").get<std::string>()).at("properties");
  file.features.resize(table.at("count").get<std::size_t>());
  for (const auto& [name, column] : table.at("properties").items()) {
    const json& property = properties.at(name);
    const std::string type = property.at("type");
    const std::size_t start = glb.view_start(column.at("values"));
    for (std::size_t i = 0; i < file.features.size(); ++i) {
      GlbFeature& feature = file.features[i];
      if (type == "STRING") {
        const std::size_t offsets = glb.view_start(column.at("stringOffsets"));
        const bool narrow = column.value("stringOffsetType", "UINT32") == "UINT16";
        const auto offset = [&](std::size_t k) {
          return narrow ? std::uint32_t{glb.read<std::uint16_t>(offsets + 2 * k)}
                        : glb.read<std::uint32_t>(offsets + 4 * k);
        };
        if (offset(i + 1) < offset(i) || start + offset(i + 1) > glb.bin.size())
          throw std::runtime_error("bad offsets");
        const std::string text = glb.bin.substr(start + offset(i), offset(i + 1) - offset(i));
        if (!property.contains("noData") || property["noData"] != text) feature.texts[name] = text;
      } else if (type == "ENUM") {
        const int value = glb.read<std::uint8_t>(start + i);
        std::string text;
        bool found = false;
        for (const json& entry : schema.at("enums").at(property.at("enumType").get<std::string>()).at("values"))
          if (entry.at("value") == value) {
            text = entry.at("name");
            found = true;
          }
        if (!found) throw std::runtime_error("no such value in the enum of " + name);
        if (!property.contains("noData") || property["noData"] != text) feature.texts[name] = text;
      } else {
        const std::string component = property.at("componentType");
        double value = component == "FLOAT64" ? glb.read<double>(start + 8 * i)
                       : component == "INT64" ? static_cast<double>(glb.read<std::int64_t>(start + 8 * i))
                       : component == "INT8"  ? static_cast<double>(glb.read<std::int8_t>(start + i))
                                              : static_cast<double>(glb.read<std::uint8_t>(start + i));
        if (property.contains("noData") && property["noData"] == value) continue;
        if (property.value("normalized", false)) value /= 255;
        feature.numbers[name] = value;
      }
      if (name == "id") feature.id = feature.texts["id"];
    }
  }
}

void read_mesh(const Glb& glb, GlbFile& file) {
  const json& document = glb.document;
  for (const json& node : document.value("nodes", json::array())) {
    const auto translation = node.value("translation", std::vector<double>{0, 0, 0});
    const auto scale = node.value("scale", std::vector<double>{1, 1, 1});
    for (const json& primitive : document.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives")) {
      const json& attributes = primitive.at("attributes");
      const auto position = glb.accessor(attributes.at("POSITION"));
      const auto normal = glb.accessor(attributes.at("NORMAL"));
      std::vector<std::array<double, 4>> colour;  // of the vertices, else of the material
      if (attributes.contains("COLOR_0"))
        colour = glb.accessor(attributes["COLOR_0"]);
      else
        colour.assign(position.size(), document.at("materials")
                                           .at(primitive.at("material").get<std::size_t>())
                                           .at("pbrMetallicRoughness")
                                           .at("baseColorFactor")
                                           .get<std::array<double, 4>>());
      const auto feature = glb.accessor(attributes.at("_FEATURE_ID_0"));
      const auto index = glb.accessor(primitive.at("indices"));
      const json& look = document.at("materials").at(primitive.at("material").get<std::size_t>());
      // Classes are pixels of a picture of one row, its width the next power of two.
      std::vector<std::string> classes;
      std::vector<std::array<double, 4>> texture;
      std::size_t width = 1;
      if (look.contains("extras")) {
        classes = look["extras"].at("classes").get<std::vector<std::string>>();
        texture = glb.accessor(attributes.at("TEXCOORD_0"));
        while (width < classes.size()) width *= 2;
      }
      for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
        GlbTriangle triangle;
        triangle.material = look.value("name", "");
        if (!classes.empty())
          triangle.material = classes.at(static_cast<std::size_t>(texture.at(static_cast<std::size_t>(index[i][0]))[0] *
                                                                  static_cast<double>(width)));
        std::size_t row = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto v = static_cast<std::size_t>(index[i + k][0]);
          const auto& p = position.at(v);
          const double x = p[0] * scale[0] + translation[0];
          const double y = p[1] * scale[1] + translation[1];
          const double z = p[2] * scale[2] + translation[2];
          triangle.corners[k] = {x, -z, y};
          if (k == 0) {
            triangle.normal = {normal[v][0], -normal[v][2], normal[v][1]};
            triangle.colour = {colour[v][0], colour[v][1], colour[v][2]};
            row = static_cast<std::size_t>(feature[v][0]);
          } else if (static_cast<std::size_t>(feature[v][0]) != row) {
            throw std::runtime_error("a triangle belongs to two features");
          }
        }
        file.features.at(row).triangles.push_back(std::move(triangle));
      }
    }
  }
}

}  // namespace

GlbFile read_glb_bytes(const std::string& bytes) {
  const Glb glb(bytes);
  GlbFile file;
  const json& asset = glb.document.at("asset");
  file.copyright = asset.value("copyright", "");
  if (asset.contains("extras") && asset["extras"].contains("georeference")) {
    const json& g = asset["extras"]["georeference"];
    file.crs = g.at("crs");
    file.height_reference = g.at("height_reference");
    file.longitude = g.at("origin").at("longitude");
    file.latitude = g.at("origin").at("latitude");
    file.height = g.at("origin").at("height");
    file.local_to_ecef = g.at("local_to_ecef").get<std::array<double, 16>>();
  }
  read_table(glb, file);
  read_mesh(glb, file);
  return file;
}

GlbFile read_glb(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot open " + path);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  try {
    return read_glb_bytes(bytes);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

}  // namespace blockrand::validators
