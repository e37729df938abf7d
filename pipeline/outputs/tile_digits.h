// A tile in few letters, for ids that no other file of the build has.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "pipeline/model/region.h"

namespace blockrand::outputs {

/// Digits and small letters, as ids may have them.
inline void append_base36(std::string& out, std::uint64_t number) {
  std::string digits;
  do {
    digits += "0123456789abcdefghijklmnopqrstuvwxyz"[number % 36];
    number /= 36;
  } while (number != 0);
  out.append(digits.rbegin(), digits.rend());
}

/// A number that no other tile of any level has: all tiles of lower levels come first.
inline std::uint64_t number_of(const model::TileId& tile) {
  const std::uint64_t side = std::uint64_t{1} << std::clamp(tile.level, 0, 28);
  return (side * side - 1) / 3 + tile.y * side + tile.x;
}

}  // namespace blockrand::outputs
