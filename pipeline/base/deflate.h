// Deflated bytes, the same each time.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace blockrand::base {

enum class DeflateFormat { raw, zlib };

/// `bytes` as one deflate stream (RFC 1951), bare or in a zlib stream (RFC 1950). Equal input gives equal output on every CPU (with
/// the same libdeflate).
/// \param level  1 (fast) to 12 (small); 6 is as small as zlib's 6 for half the time
/// \throws std::bad_alloc  there is no memory
std::string deflated(std::string_view bytes, int level, DeflateFormat format);

/// CRC-32 of gzip, ZIP and PNG. \param before  of what precedes
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

}  // namespace blockrand::base
