// Colours as people write them: sRGB, 8 bits a channel.
#pragma once

#include <compare>
#include <cstdint>

namespace blockrand::model {

struct Colour {
  std::uint8_t r = 0, g = 0, b = 0;
  friend auto operator<=>(const Colour&, const Colour&) = default;
};

}  // namespace blockrand::model
