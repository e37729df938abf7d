#include "pipeline/outputs/zip_file.h"

#include <zlib.h>

#include <cassert>
#include <cstdint>
#include <limits>
#include <new>

namespace blockrand::outputs {
namespace {

std::string deflated(std::string_view bytes) {
  z_stream stream{};
  // A negative number of bits: no header of zlib's around the data.
  if (deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  [[maybe_unused]] const int status = deflate(&stream, Z_FINISH);
  assert(status == Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

void append_number(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

}  // namespace

std::string zip_file(std::string_view name, std::string_view bytes) {
  assert(bytes.size() < std::numeric_limits<std::uint32_t>::max());
  constexpr std::uint32_t kDeflated = 8, kVersion = 20, kFirstDay = 1 << 5 | 1;  // 1980-01-01
  const std::string data = deflated(bytes);
  // What the file's own header and its line in the directory have in common.
  std::string common;
  append_number(common, kVersion, 2);
  append_number(common, 0, 2);  // flags
  append_number(common, kDeflated, 2);
  append_number(common, 0, 2);  // time of day
  append_number(common, kFirstDay, 2);
  append_number(common,
                static_cast<std::uint32_t>(
                    crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()))),
                4);
  append_number(common, static_cast<std::uint32_t>(data.size()), 4);
  append_number(common, static_cast<std::uint32_t>(bytes.size()), 4);
  append_number(common, static_cast<std::uint32_t>(name.size()), 2);
  append_number(common, 0, 2);  // extra fields

  std::string out = "PK\x03\x04" + common;
  out += name;
  out += data;
  const auto directory = static_cast<std::uint32_t>(out.size());
  out += "PK\x01\x02";
  append_number(out, kVersion, 2);
  out += common;
  append_number(out, 0, 2);  // comment
  append_number(out, 0, 2);  // disk
  append_number(out, 0, 2);  // attributes
  append_number(out, 0, 4);
  append_number(out, 0, 4);  // where the file begins
  out += name;
  const auto directory_size = static_cast<std::uint32_t>(out.size()) - directory;
  out += "PK\x05\x06";
  append_number(out, 0, 4);  // disks
  append_number(out, 1, 2);
  append_number(out, 1, 2);
  append_number(out, directory_size, 4);
  append_number(out, directory, 4);
  append_number(out, 0, 2);  // comment
  return out;
}

}  // namespace blockrand::outputs
