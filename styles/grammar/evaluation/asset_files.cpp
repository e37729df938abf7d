#include "styles/grammar/evaluation/asset_files.h"

#include <charconv>
#include <cmath>

#include "styles/grammar/shapes/mesh_tools.h"

namespace blockrand::grammar {

namespace {

/// The next number of a line; moves `at` behind it.
bool read_number(std::string_view line, std::size_t& at, double& out) {
  while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  const auto read = std::from_chars(line.data() + at, line.data() + line.size(), out);
  if (read.ec != std::errc() || !std::isfinite(out)) return false;
  at = static_cast<std::size_t>(read.ptr - line.data());
  return true;
}

std::uint32_t byte(std::string_view bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }
std::uint32_t word(std::string_view bytes, std::size_t at) { return byte(bytes, at) << 8 | byte(bytes, at + 1); }

}  // namespace

std::optional<AssetBox> obj_box(std::string_view bytes) {
  Box box;
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    if (line.size() < 2 || line[0] != 'v' || (line[1] != ' ' && line[1] != '\t')) continue;
    std::size_t at = 1;
    Vector3 p;
    if (read_number(line, at, p.x) && read_number(line, at, p.y) && read_number(line, at, p.z)) box.add(p);
  }
  if (box.empty) return std::nullopt;
  return AssetBox{box.extent(), box.low};
}

std::optional<Vector2> picture_size(std::string_view bytes) {
  constexpr std::string_view kPng("\x89PNG\r\n\x1a\n", 8);
  if (bytes.starts_with(kPng) && bytes.size() >= 24 && bytes.substr(12, 4) == "IHDR")
    return Vector2{static_cast<double>(word(bytes, 16) << 16 | word(bytes, 18)),
                   static_cast<double>(word(bytes, 20) << 16 | word(bytes, 22))};
  if (!bytes.starts_with("\xff\xd8")) return std::nullopt;
  for (std::size_t at = 2; at + 9 <= bytes.size();) {
    if (byte(bytes, at) != 0xff) return std::nullopt;
    const std::uint32_t marker = byte(bytes, at + 1);
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    // Frames are 0xc0 to 0xcf but for tables (0xc4, 0xcc) and an extension (0xc8).
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc)
      return Vector2{static_cast<double>(word(bytes, at + 7)), static_cast<double>(word(bytes, at + 5))};
    at += 2 + word(bytes, at + 2);
  }
  return std::nullopt;
}

}  // namespace blockrand::grammar
