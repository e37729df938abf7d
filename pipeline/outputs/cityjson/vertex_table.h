// The vertices of a CityJSON object: integer grid points, each once.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "pipeline/model/point.h"

namespace blockrand::outputs {

/// A grid point in steps of 1/1024 m from the origin of its file.
struct GridPoint {
  std::int64_t x = 0, y = 0, z = 0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

/// Numbers points in order of first appearance. About 20 bytes a vertex, and no second copy while it grows, so that a
/// whole city fits. |x|, |y| below 2^47 steps, |z| below 2^31 (2,000 km).
class VertexTable {
 public:
  VertexTable() : slots_(kSmallest, kFree) {}

  std::uint32_t number(const GridPoint& p);
  std::uint32_t size() const { return size_; }
  GridPoint operator[](std::uint32_t number) const { return unpack((*chunks_[number / kChunk])[number % kChunk]); }
  /// Forgets all points; cheap after few of them.
  void clear();

 private:
  struct Packed {  // x and y with half of z each
    std::uint64_t x, y;
    friend bool operator==(const Packed&, const Packed&) = default;
  };
  static constexpr std::uint32_t kChunk = 4096, kFree = 0xffffffff;
  static constexpr std::size_t kSmallest = 256;

  static Packed pack(const GridPoint& p);
  static GridPoint unpack(const Packed& p);
  static std::size_t hash(const Packed& p);
  void grow();

  std::vector<std::unique_ptr<std::array<Packed, kChunk>>> chunks_;
  std::vector<std::uint32_t> slots_;  // open addressing, a power of two
  std::uint32_t size_ = 0;
};

}  // namespace blockrand::outputs
