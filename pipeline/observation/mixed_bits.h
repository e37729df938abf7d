// An order that spreads what is chosen over an extract, and hangs on nothing but ids or places.
#pragma once

#include <cstdint>

namespace blockrand::observation {

/// The finaliser of MurmurHash3 (Appleby, 2011, public domain): each bit of the result hangs on all of `v`.
inline std::uint64_t mixed(std::uint64_t v) {
  v ^= v >> 33, v *= 0xff51afd7ed558ccdULL, v ^= v >> 33, v *= 0xc4ceb9fe1a85ec53ULL, v ^= v >> 33;
  return v;
}

}  // namespace blockrand::observation
