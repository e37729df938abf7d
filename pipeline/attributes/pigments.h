// What colours look like on a building: a colour's name means a pigment, and drawn roofs have weathered.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/toml_file.h"
#include "pipeline/model/colour.h"

namespace blockrand::attributes {

/// A word for a colour, and what paint, clay, metal or stone of that name looks like.
struct Pigment {
  std::string name;                                   ///< "red"
  std::map<std::uint8_t, model::Colour> on_material;  ///< by index of the material class
  model::Colour elsewhere;                            ///< on all other materials
};

/// How roofs whose colour is drawn look after some decades.
struct DrawnRoofs {
  double alike = 0;  ///< share of the roofs of a block that have the block's colour of their palette
  double least_weathered = 0, most_weathered = 0;  ///< share of `dirt` in their colour
  model::Colour dirt;
  double tone = 0;  ///< share by which they are lighter or darker
};

/// Read from configs/materials/materials.toml.
struct Pigments {
  std::map<model::Colour, Pigment> by_screen_colour;  ///< by the colour that CSS gives the word
  std::vector<double>
      most_saturated;  ///< HSV saturation of words without a pigment and of drawn walls, by material class
  std::optional<DrawnRoofs> drawn_roofs;  ///< none: drawn for each building, as the palette has it

  /// What a word means on a material. \param screen  the colour that CSS gives the word
  model::Colour on_material(model::Colour screen, std::uint8_t material) const;
  /// A wall's colour out of a palette, as saturated as its material gets.
  model::Colour muted(model::Colour drawn, std::uint8_t material) const;
  /// A drawn roof's colour after some decades. \param bits  random, the building's own
  model::Colour weathered(model::Colour drawn, std::uint64_t bits) const;
};

/// Reads `[pigment.…]` and `[drawn_roofs]`; both may be absent. \param material  index by name of a class; -1: there is none
/// \throws base::InputError  with the place of what is wrong
Pigments read_pigments(base::TomlTable& file, const std::function<int(std::string_view)>& material);

/// The same colour with at most that HSV saturation: its value and hue stay (A. R. Smith, Color Gamut Transform Pairs, 1978).
model::Colour less_saturated(model::Colour colour, double most);

}  // namespace blockrand::attributes
