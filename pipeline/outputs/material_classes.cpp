#include "pipeline/outputs/material_classes.h"

#include <algorithm>

namespace blockrand::outputs {
namespace {

/// Nearest ten-thousandth; `value` in [0, 1].
int rounded(double value) { return static_cast<int>(value * 10000 + 0.5); }

}  // namespace

X3dMaterial x3d_material(const model::MaterialClass& material, model::Colour colour) {
  X3dMaterial out;
  out.name = material.name + " " + model::text(colour);
  const double metallic = std::clamp(static_cast<double>(material.metallic), 0.0, 1.0);
  const std::uint8_t channels[3] = {colour.r, colour.g, colour.b};
  for (std::size_t i = 0; i < 3; ++i) {
    out.diffuse[i] = (channels[i] * 10000 + 127) / 255;
    out.specular[i] = rounded(0.04 * (1 - metallic) + channels[i] / 255.0 * metallic);
  }
  const double roughness = std::clamp(static_cast<double>(material.roughness), 0.05, 1.0);
  const double exponent = 2 / (roughness * roughness * roughness * roughness) - 2;
  out.shininess = rounded(std::clamp(exponent / 128, 0.0, 1.0));
  return out;
}

void append_ten_thousandths(std::string& out, int value) {
  if (value <= 0 || value >= 10000) {
    out += value <= 0 ? '0' : '1';
    return;
  }
  char text[6] = {'0', '.'};
  int length = 6;
  for (int i = 5; i > 1; --i) {
    text[i] = static_cast<char>('0' + value % 10);
    value /= 10;
  }
  while (text[length - 1] == '0') --length;
  out.append(text, static_cast<std::size_t>(length));
}

void append_ten_thousandths(std::string& out, const std::array<int, 3>& values, char separator) {
  append_ten_thousandths(out, values[0]);
  out += separator;
  append_ten_thousandths(out, values[1]);
  out += separator;
  append_ten_thousandths(out, values[2]);
}

std::uint32_t MaterialNumbers::number(std::uint32_t key) {
  // A building has a handful: looking through them is faster than hashing.
  const std::size_t near = std::min(keys_.size(), kShort);
  for (std::size_t i = 0; i < near; ++i)
    if (keys_[i] == key) return static_cast<std::uint32_t>(i);
  const auto next = static_cast<std::uint32_t>(keys_.size());
  if (next >= kShort) {
    const auto [found, added] = numbers_.try_emplace(key, next);
    if (!added) return found->second;
  }
  keys_.push_back(key);
  return next;
}

void MaterialNumbers::clear() {
  keys_.clear();
  numbers_.clear();
}

}  // namespace blockrand::outputs
