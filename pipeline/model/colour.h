// Colours as people write them: sRGB, 8 bits a channel.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace blockrand::model {

struct Colour {
  std::uint8_t r = 0, g = 0, b = 0;
  friend auto operator<=>(const Colour&, const Colour&) = default;
};

/// "#rrggbb", in small or capital letters; nothing for any other text.
constexpr std::optional<Colour> colour_of_hex(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::uint8_t channels[3] = {};
  for (std::size_t i = 0; i < 6; ++i) {
    const char c = text[i + 1];
    int digit = 0;
    if (c >= '0' && c <= '9')
      digit = c - '0';
    else if (c >= 'a' && c <= 'f')
      digit = c - 'a' + 10;
    else if (c >= 'A' && c <= 'F')
      digit = c - 'A' + 10;
    else
      return std::nullopt;
    channels[i / 2] = static_cast<std::uint8_t>(channels[i / 2] * 16 + digit);
  }
  return Colour{channels[0], channels[1], channels[2]};
}

}  // namespace blockrand::model
