#include "pipeline/validate/bytes_of_file.h"

#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace blockrand::validate {
namespace {

constexpr std::size_t kLargest = std::size_t{4} << 30;

}  // namespace

std::optional<std::string> file_bytes(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) return std::nullopt;
  std::string bytes(size, '\0');
  if (size > 0 && !stream.read(bytes.data(), static_cast<std::streamsize>(size))) return std::nullopt;
  return bytes;
}

std::optional<std::string> gunzip(std::string_view bytes) {
  std::string out;
  while (!bytes.empty()) {
    z_stream z{};
    constexpr int kGzipOnly = 16;
    if (inflateInit2(&z, kGzipOnly + MAX_WBITS) != Z_OK) return std::nullopt;
    int status = Z_OK;
    std::size_t fed = 0;
    char block[1 << 16];
    while (status == Z_OK) {
      if (z.avail_in == 0) {
        const std::size_t next = std::min<std::size_t>(bytes.size() - fed, 1u << 30);
        if (next == 0) break;  // truncated
        z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + fed));
        z.avail_in = static_cast<uInt>(next);
        fed += next;
      }
      z.next_out = reinterpret_cast<Bytef*>(block);
      z.avail_out = sizeof(block);
      status = inflate(&z, Z_NO_FLUSH);
      if (status == Z_OK || status == Z_STREAM_END) out.append(block, sizeof(block) - z.avail_out);
      if (out.size() > kLargest) status = Z_MEM_ERROR;
    }
    const std::size_t used = fed - z.avail_in;
    inflateEnd(&z);
    if (status != Z_STREAM_END) return std::nullopt;
    bytes.remove_prefix(used);
  }
  return out;
}

std::optional<std::string> content_of(const std::string& path, std::string& why) {
  auto bytes = file_bytes(path);
  if (!bytes) {
    why = "cannot be read";
    return std::nullopt;
  }
  if (!path.ends_with(".gz")) return bytes;
  auto content = bytes->empty() ? std::nullopt : gunzip(*bytes);
  if (!content) why = "the compressed data are damaged";
  return content;
}

}  // namespace blockrand::validate
