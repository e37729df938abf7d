#include "pipeline/outputs/gltf/material.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "pipeline/model/building.h"
#include "pipeline/outputs/gltf/linear_light.h"
#include "pipeline/outputs/number_text.h"

namespace blockrand::outputs {
namespace {

/// 0.9f is 0.89999997615814209 as a double.
double two_decimals(float value) {
  return std::nearbyint(std::clamp(static_cast<double>(value), 0.0, 1.0) * 100) / 100;
}

/// Five decimals lead back to the same sRGB byte: the darkest step is 20/65535.
double linear(std::uint8_t value) { return std::nearbyint(kLinearLight[value] / 0.65535) / 1e5; }

void append_big_endian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xFF);
}

void append_chunk(std::string& png, const std::string& type_and_data) {
  append_big_endian(png, static_cast<std::uint32_t>(type_and_data.size() - 4));
  png += type_and_data;
  append_big_endian(png, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(type_and_data.data()),
                                                          static_cast<uInt>(type_and_data.size()))));
}

}  // namespace

std::string material_json(const model::MaterialClass& material, const std::optional<model::Colour>& colour,
                          MaterialName name) {
  std::string json = "{\"name\":";
  append_json(json, colour && name == MaterialName::with_colour ? material.name + " " + model::text(*colour)
                                                                : std::string(material.name));
  json += ",\"pbrMetallicRoughness\":{";
  if (colour) {
    json += "\"baseColorFactor\":[";
    for (const std::uint8_t part : {colour->r, colour->g, colour->b}) {
      append_number(json, linear(part));
      json += ',';
    }
    json += "1],";
  }
  json += "\"metallicFactor\":";
  append_number(json, two_decimals(material.metallic));
  json += ",\"roughnessFactor\":";
  append_number(json, two_decimals(material.roughness));
  json += "}}";
  return json;
}

MaterialTable::MaterialTable(std::span<const model::MaterialClass> classes) : classes_(classes) {
  while (width_ < classes.size()) width_ *= 2;
}

std::string MaterialTable::png() const {
  // Not compressed: other versions of a library would compress it otherwise.
  std::string row(1, '\0');
  for (std::size_t i = 0; i < width_; ++i) {
    const auto byte = [](float value) { return static_cast<char>(std::lround(two_decimals(value) * 255)); };
    const bool known = i < classes_.size();
    row += '\0';
    row += known ? byte(classes_[i].roughness) : '\xff';
    row += known ? byte(classes_[i].metallic) : '\0';
  }
  const auto size = static_cast<std::uint16_t>(row.size()), other = static_cast<std::uint16_t>(~size);
  std::string header = "IHDR", data = "IDAT\x78\x01\x01";
  append_big_endian(header, static_cast<std::uint32_t>(width_));
  append_big_endian(header, 1);
  header.append("\x08\x02\0\0\0", 5);  // 8 bits, RGB
  for (const std::uint16_t word : {size, other}) data += {static_cast<char>(word & 0xFF), static_cast<char>(word >> 8)};
  data += row;
  append_big_endian(data, static_cast<std::uint32_t>(
                              adler32(1, reinterpret_cast<const Bytef*>(row.data()), static_cast<uInt>(row.size()))));
  std::string out("\x89PNG\r\n\x1a\n", 8);
  append_chunk(out, header);
  append_chunk(out, data);
  append_chunk(out, "IEND");
  return out;
}

std::string MaterialTable::material_json(int texture) const {
  std::string json = "{\"extras\":{\"classes\":[";
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (i) json += ',';
    append_json(json, classes_[i].name);
  }
  json += "]},\"name\":\"surfaces\",\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":";
  append_number(json, std::int64_t{texture});
  return json + "}}}";
}

std::array<std::uint16_t, 2> MaterialTable::place(std::uint8_t material) const {
  // The middle of the pixel.
  const std::size_t u = ((2 * std::size_t{material} + 1) * 65535 + width_) / (2 * width_);
  return {static_cast<std::uint16_t>(u), 32768};
}

}  // namespace blockrand::outputs
