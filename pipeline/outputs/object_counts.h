// What became of the objects of an extract, counted.
#pragma once

#include <array>
#include <cstdint>

namespace blockrand::outputs {

struct ObjectCounts {
  std::uint64_t buildings_in = 0, parts_in = 0;
  std::uint64_t models = 0, represented = 0, duplicates = 0, reported = 0;
  std::array<std::uint64_t, 4> models_by_lod{};  ///< objects whose best solid is LoD 0, 1, 2, 3
};

}  // namespace blockrand::outputs
