// Numbers of equal points: the first of them stands for all.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/base/random.h"
#include "pipeline/model/point.h"

namespace blockrand::outputs {

/// Of a point; 0 and -0 are equal, and so are their hashes.
inline std::uint64_t hash_of(const model::Point3& p) {
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v + 0.0); };
  return base::mix64(base::mix64(base::mix64(bits(p.x)) ^ bits(p.y)) ^ bits(p.z));
}

/// Open addressing; no order of its own reaches a result. Starting anew costs nothing.
class PointNumbers {
 public:
  /// Forgets everything. \param most  keys that may come
  void start(std::size_t most) {
    std::size_t size = 16;
    while (size < most * 2) size *= 2;
    if (size > slots_.size()) slots_.assign(size, {});
    mask_ = slots_.size() - 1;
    ++stamp_;
  }
  /// The number under which an equal one came first; `number` where this is the first. \param equal  asked with such numbers
  template <class Equal>
  std::uint32_t first(std::uint64_t hash, std::uint32_t number, Equal&& equal) {
    for (std::size_t i = hash & mask_;; i = (i + 1) & mask_) {
      Slot& slot = slots_[i];
      if (slot.stamp != stamp_) {
        slot = {stamp_, number};
        return number;
      }
      if (equal(slot.number)) return slot.number;
    }
  }

 private:
  struct Slot {
    std::uint32_t stamp = 0, number = 0;
  };
  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  std::uint32_t stamp_ = 0;
};

}  // namespace blockrand::outputs
