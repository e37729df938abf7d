#include "pipeline/outputs/gltf/material.h"

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

}  // namespace blockrand::outputs
