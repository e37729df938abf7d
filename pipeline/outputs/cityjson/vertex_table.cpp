#include "pipeline/outputs/cityjson/vertex_table.h"

#include <algorithm>
#include <cassert>

namespace blockrand::outputs {

VertexTable::Packed VertexTable::pack(const GridPoint& p) {
  assert(p.x < (1LL << 47) && p.x >= -(1LL << 47) && p.y < (1LL << 47) && p.y >= -(1LL << 47));
  const auto z = static_cast<std::uint32_t>(static_cast<std::int32_t>(p.z));
  return {static_cast<std::uint64_t>(p.x) << 16 | z >> 16, static_cast<std::uint64_t>(p.y) << 16 | (z & 0xffff)};
}

GridPoint VertexTable::unpack(const Packed& p) {
  const auto z = static_cast<std::int32_t>(static_cast<std::uint32_t>(p.x & 0xffff) << 16 |
                                           static_cast<std::uint32_t>(p.y & 0xffff));
  return {static_cast<std::int64_t>(p.x) >> 16, static_cast<std::int64_t>(p.y) >> 16, z};
}

std::size_t VertexTable::hash(const Packed& p) {
  std::uint64_t h = p.x * 0x9E3779B97F4A7C15u;
  h = (h ^ (h >> 29) ^ p.y) * 0xBF58476D1CE4E5B9u;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

std::uint32_t VertexTable::number(const GridPoint& p) {
  const Packed packed = pack(p);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(packed) & mask;
  for (; slots_[slot] != kFree; slot = (slot + 1) & mask)
    if ((*chunks_[slots_[slot] / kChunk])[slots_[slot] % kChunk] == packed) return slots_[slot];
  slots_[slot] = size_;
  if (size_ / kChunk == chunks_.size()) chunks_.push_back(std::make_unique<std::array<Packed, kChunk>>());
  (*chunks_[size_ / kChunk])[size_ % kChunk] = packed;
  ++size_;
  if (size_ > slots_.size() / 4 * 3) grow();
  return size_ - 1;
}

void VertexTable::grow() {
  const std::size_t wanted = slots_.size() * 2;
  slots_ = {};  // the old table is not needed to fill the new one
  slots_.assign(wanted, kFree);
  for (std::uint32_t i = 0; i < size_; ++i) {
    std::size_t slot = hash((*chunks_[i / kChunk])[i % kChunk]) & (wanted - 1);
    while (slots_[slot] != kFree) slot = (slot + 1) & (wanted - 1);
    slots_[slot] = i;
  }
}

void VertexTable::clear() {
  size_ = 0;
  if (slots_.size() > 16 * kSmallest)
    slots_.assign(kSmallest, kFree);
  else
    std::fill(slots_.begin(), slots_.end(), kFree);
}

}  // namespace blockrand::outputs
