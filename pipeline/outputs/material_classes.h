// How faces look in CityGML and CityJSON: both have the material of X3D.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "pipeline/model/region.h"

namespace blockrand::outputs {

/// The appearance theme that holds the colours.
inline constexpr std::string_view kVisualTheme = "visual";

/// An X3D material, its numbers in ten-thousandths, so that every format prints the same digits.
struct X3dMaterial {
  std::string name;              ///< "plaster #decdaa": material class and colour
  std::array<int, 3> diffuse{};  ///< sRGB / 255; four decimals give the byte back exactly
  std::array<int, 3> specular{};
  int shininess = 0;
};

/// The X3D material of a material class in a colour.
///
/// The diffuse colour is the face's own, of metals too: it is what readers without lighting models show. The specular
/// colour goes from 0.04 (dielectrics) to the colour itself (metals), as glTF 2.0 mixes them (appendix B). Shininess is
/// a Blinn-Phong exponent over 128 (ISO/IEC 19775-1, Material); the exponent that matches a roughness r is
/// 2 / r^4 - 2 (B. Karis, Specular BRDF Reference, 2013), bounded to [0, 128].
X3dMaterial x3d_material(const model::MaterialClass& material, model::Colour colour);

/// Appends 0, 1 or 0.xxxx without trailing zeros. `value` in [0, 10000].
void append_ten_thousandths(std::string& out, int value);
/// Appends three of them with `separator` between.
void append_ten_thousandths(std::string& out, const std::array<int, 3>& values, char separator);

/// Numbers the pairs of material class and colour in order of first appearance.
class MaterialNumbers {
 public:
  /// Material class and colour of a face in one number.
  static std::uint32_t key(std::uint8_t material, model::Colour c) {
    return std::uint32_t{material} << 24 | std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | c.b;
  }
  static std::uint8_t material(std::uint32_t key) { return static_cast<std::uint8_t>(key >> 24); }
  static model::Colour colour(std::uint32_t key) {
    return {static_cast<std::uint8_t>(key >> 16), static_cast<std::uint8_t>(key >> 8), static_cast<std::uint8_t>(key)};
  }

  std::uint32_t number(std::uint32_t key);
  const std::vector<std::uint32_t>& keys() const { return keys_; }  ///< by number
  void clear();

 private:
  std::vector<std::uint32_t> keys_;
  std::unordered_map<std::uint32_t, std::uint32_t> numbers_;  // only beyond kShort keys
  static constexpr std::size_t kShort = 16;
};

}  // namespace blockrand::outputs
