#include "pipeline/outputs/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>

#include "pipeline/base/deflate.h"

namespace blockrand::outputs {

namespace {

/// UTF-8 as ISO 8859-1.
std::string latin(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80) {
      out += text[i];
    } else if ((byte == 0xC2 || byte == 0xC3) && i + 1 < text.size()) {
      out += static_cast<char>((byte & 3) << 6 | (static_cast<unsigned char>(text[++i]) & 0x3F));
    } else if (byte >= 0xC0) {
      out += '?';
    }
  }
  return out;
}

}  // namespace

std::string gzip(std::string_view bytes, int level, std::string_view comment) {
  // RFC 1952: deflate, flags, time 0, no hint, and a system that is not known.
  const std::string said = latin(comment);
  std::string out{"\x1f\x8b\x08\0\0\0\0\0\0\xff", 10};
  if (!said.empty()) {
    constexpr char kHasComment = 16;
    out[3] = kHasComment;
    out.append(said.c_str(), said.size() + 1);
  }
  out += base::deflated(bytes, level, base::DeflateFormat::raw);
  const auto append_number = [&](std::uint32_t value) {
    for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
  };
  append_number(base::crc32_of(bytes));
  append_number(static_cast<std::uint32_t>(bytes.size()));  // modulo 2^32, as the format has it
  return out;
}

std::string gunzip(std::string_view bytes) {
  z_stream stream{};
  constexpr int kGzipHeader = 16;
  if (inflateInit2(&stream, MAX_WBITS + kGzipHeader) != Z_OK) throw std::bad_alloc();
  std::string out;
  // The last member says its size at the end (RFC 1952). What is damaged may say anything.
  if (bytes.size() >= 4) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i)
      size |= std::size_t{static_cast<unsigned char>(bytes[bytes.size() - 4 + i])} << (8 * i);
    constexpr std::size_t kMostAtOnce = 64'000'000;
    out.reserve(std::min(size, kMostAtOnce) + (1 << 16));
  }
  std::size_t consumed = 0;
  int status = Z_OK;
  constexpr std::size_t kPiece = 1 << 16;
  while (status == Z_OK) {
    const std::size_t input = std::min<std::size_t>(std::numeric_limits<uInt>::max(), bytes.size() - consumed);
    const std::size_t produced = out.size();
    out.resize(produced + kPiece);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + consumed));
    stream.avail_in = static_cast<uInt>(input);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + produced);
    stream.avail_out = kPiece;
    status = inflate(&stream, Z_NO_FLUSH);
    consumed += input - stream.avail_in;
    out.resize(produced + kPiece - stream.avail_out);
    if (status == Z_STREAM_END && consumed < bytes.size()) status = inflateReset(&stream);  // the next member
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::runtime_error("the gzip data are damaged or cut off");
  return out;
}

}  // namespace blockrand::outputs
