#include "pipeline/outputs/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <new>
#include <stdexcept>

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
  assert(level >= 1 && level <= 9);
  z_stream stream{};
  constexpr int kGzipHeader = 16;
  if (deflateInit2(&stream, level, Z_DEFLATED, MAX_WBITS + kGzipHeader, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  gz_header header{};
  header.os = 255;  // "unknown": zlib's own default depends on the machine it was built for
  std::string said = latin(comment);
  if (!said.empty()) header.comment = reinterpret_cast<Bytef*>(said.data());
  deflateSetHeader(&stream, &header);

  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  std::size_t consumed = 0, produced = 0;
  int status = Z_OK;
  while (status == Z_OK || status == Z_BUF_ERROR) {
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();  // zlib counts in 32 bits
    const std::size_t input = std::min(kMost, bytes.size() - consumed);
    if (produced == out.size()) out.resize(out.size() + 4096);
    const std::size_t room = std::min(kMost, out.size() - produced);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + consumed));
    stream.avail_in = static_cast<uInt>(input);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + produced);
    stream.avail_out = static_cast<uInt>(room);
    status = deflate(&stream, consumed + input == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    consumed += input - stream.avail_in;
    produced += room - stream.avail_out;
  }
  deflateEnd(&stream);
  assert(status == Z_STREAM_END);
  out.resize(produced);
  return out;
}

std::string gunzip(std::string_view bytes) {
  z_stream stream{};
  constexpr int kGzipHeader = 16;
  if (inflateInit2(&stream, MAX_WBITS + kGzipHeader) != Z_OK) throw std::bad_alloc();
  std::string out;
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
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::runtime_error("the gzip data are damaged or cut off");
  return out;
}

}  // namespace blockrand::outputs
