// Text in columns for a terminal. Internal to this folder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

namespace blockrand::cli {

inline constexpr std::size_t kTerminalWidth = 100;  // columns

/// `text` at column `indent`, broken between words; the first line starts where the caller stands.
inline std::string wrapped(const std::string& text, std::size_t indent) {
  std::string out;
  std::size_t column = indent;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    // A letter of several bytes takes one column.
    const std::size_t length = static_cast<std::size_t>(std::count_if(text.begin() + static_cast<std::ptrdiff_t>(at),
                                                                      text.begin() + static_cast<std::ptrdiff_t>(end),
                                                                      [](char c) { return (c & 0xC0) != 0x80; }));
    if (column > indent && column + 1 + length > kTerminalWidth) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      out += ' ';
      ++column;
    }
    out.append(text, at, end - at);
    column += length;
    at = end + 1;
  }
  return out;
}

/// A name, padded to the column where the rest starts.
inline std::string row(const std::string& name, std::size_t width, const std::string& rest) {
  std::string line = "  " + name;
  if (line.size() + 1 > width) line += "\n" + std::string(width, ' ');
  while (line.size() < width) line += ' ';
  return line + wrapped(rest, width) + "\n";
}

}  // namespace blockrand::cli
