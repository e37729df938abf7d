#include "pipeline/outputs/zip_file.h"

#include <cassert>
#include <cstdint>
#include <limits>

#include "pipeline/base/deflate.h"

namespace blockrand::outputs {
namespace {

void append_number(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

}  // namespace

std::string zip_file(std::string_view name, std::string_view bytes) {
  assert(bytes.size() < std::numeric_limits<std::uint32_t>::max());
  constexpr std::uint32_t kDeflated = 8, kVersion = 20, kFirstDay = 1 << 5 | 1;  // 1980-01-01
  constexpr int kLevel = 9;
  const std::string data = base::deflated(bytes, kLevel, base::DeflateFormat::raw);
  // What the file's own header and its line in the directory have in common.
  std::string common;
  append_number(common, kVersion, 2);
  append_number(common, 0, 2);  // flags
  append_number(common, kDeflated, 2);
  append_number(common, 0, 2);  // time of day
  append_number(common, kFirstDay, 2);
  append_number(common, base::crc32_of(bytes), 4);
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
