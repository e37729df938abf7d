// Which colours of an image are those of its roofs, and which are those of its ground.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/observation/image_windows.h"

namespace blockrand::observation {

/// Learns from what is mapped. Counts are integers: the same in any order.
class RoofColours {
 public:
  /// \param kinds  of each pixel: 1 roof, 2 ground, any other: left out
  void learn(const Patch& patch, std::span<const std::uint8_t> kinds);
  /// Ends learning.
  void settle();
  /// Logarithm of how much more often a roof has this colour than the ground has, from -kMostLikely to kMostLikely;
  /// 0 where neither has it, or nothing was learnt.
  float likeness(std::uint8_t red, std::uint8_t green, std::uint8_t blue) const {
    return table_.empty() ? 0.0F : table_[cell(red, green, blue)];
  }
  static constexpr double kMostLikely = 3;

 private:
  static constexpr int kSide = 32, kLevels = 256 / kSide;  ///< cells along each band; levels of each
  static std::size_t cell(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    return static_cast<std::size_t>((red / kLevels * kSide + green / kLevels) * kSide + blue / kLevels);
  }
  std::vector<std::uint32_t> roofs_ = std::vector<std::uint32_t>(kSide * kSide * kSide, 0), ground_ = roofs_;
  std::vector<float> table_;
};

}  // namespace blockrand::observation
