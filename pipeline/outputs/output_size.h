// How large the outputs of a build become, told before it.
#pragma once

#include <algorithm>
#include <cstdint>

namespace blockrand::outputs {

/// What is built.
struct BuiltSize {
  std::uint64_t buildings = 0;  ///< objects with an outline to build from, parts among them
  double walls = 0;             ///< m2 of outer walls of what is no outbuilding: where windows and doors are
};

/// What a format takes, roughly: fitted to builds of eleven towns with tests/bench/estimate.py; docs/internal/RESULTS.md has the figures.
struct OutputSize {
  double once = 0;  ///< bytes on the disk, whatever is built; of a few buildings less: their pictures are mostly empty
  double per_building = 0;  ///< bytes on the disk
  /// Bytes on the disk of a m2 of outer wall, for windows, doors and ornaments. A middle figure: they depend on the style
  /// by a factor of two either way, so that run::sample_walls() measures them where it matters.
  double per_wall = 0;
  double memory = 0;  ///< bytes in memory, whatever is built

  double bytes(const BuiltSize& size) const {
    constexpr double kOncePerBuilding = 50'000;
    return std::min(once, kOncePerBuilding * static_cast<double>(size.buildings)) +
           per_building * static_cast<double>(size.buildings) + per_wall * size.walls;
  }
  OutputSize& operator+=(const OutputSize& other) {
    once += other.once, per_building += other.per_building, per_wall += other.per_wall, memory += other.memory;
    return *this;
  }
};

}  // namespace blockrand::outputs
