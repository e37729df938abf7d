// What other programs leave beside files that they open.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace blockrand::base {

/// Whether a path looks like a file that a program wrote beside one that it opened: GDAL's .gfs, .aux.xml and .ovr,
/// SQLite's -wal, -shm and -journal, QGIS's .qmd and backups of projects, the folder files of macOS and Windows.
inline bool is_side_file(std::string_view path) {
  constexpr std::array<std::string_view, 11> kEndings = {
      ".aux.xml", ".gfs", ".ovr", "-wal", "-shm", "-journal", ".qmd", ".qgz~", ".DS_Store", "Thumbs.db", "desktop.ini"};
  return std::any_of(kEndings.begin(), kEndings.end(), [&](std::string_view ending) { return path.ends_with(ending); });
}

}  // namespace blockrand::base
