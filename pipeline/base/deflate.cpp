#include "pipeline/base/deflate.h"

#include <libdeflate.h>

#include <cassert>
#include <memory>
#include <new>

namespace blockrand::base {

std::string deflated(std::string_view bytes, int level, DeflateFormat format) {
  assert(level >= 1 && level <= 12);
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(level), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  const bool zlib = format == DeflateFormat::zlib;
  const std::size_t most = zlib ? libdeflate_zlib_compress_bound(compressor.get(), bytes.size())
                                : libdeflate_deflate_compress_bound(compressor.get(), bytes.size());
  // Not cleared: most of it is never touched.
  const auto room = std::make_unique_for_overwrite<char[]>(most);
  const auto compress = zlib ? libdeflate_zlib_compress : libdeflate_deflate_compress;
  const std::size_t size = compress(compressor.get(), bytes.data(), bytes.size(), room.get(), most);
  assert(size > 0);
  return {room.get(), size};
}

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before) {
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

}  // namespace blockrand::base
