// The 3D Tiles of a build in one file: a 3D Tiles archive (.3tz).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/progress.h"
#include "pipeline/outward/build_files.h"

namespace blockrand::outward {

/// An entry of the archive's index: MD5 of its path, and where its local file header begins.
struct ArchiveEntry {
  std::array<std::uint8_t, 16> md5{};
  std::uint64_t offset = 0;
};

/// MD5 of a path without leading slashes (3D Tiles Archive Format 1.3, "Reading and writing the index file", steps 2 and 3).
std::array<std::uint8_t, 16> archive_hash(std::string_view path);

/// The file @3dtilesIndex1@: 24 bytes an entry, sorted by their hashes as two little-endian numbers of 64 bits (steps 4 to 6).
std::string archive_index(std::vector<ArchiveEntry> entries);

struct ArchiveSummary {
  std::uint64_t files = 0, bytes = 0;
};

/// Writes tileset.json and all that it leads to: tilesets, GLB, the textures of those. Texts are deflated, the rest is stored, which is
/// the fastest to read. The same build gives the same bytes: entries in the order of their paths, dated 1980-01-01; the index is the
/// last. ZIP64 (PKWARE APPNOTE 6.3.9, 4.3.14 and 4.5.3) where the archive has 4 GB or 65,535 files or more. It is written beside
/// its place and renamed.
/// \throws base::UsageError   the build has no tileset, or the name does not end with .3tz
/// \throws base::InputError   a file is missing, is not the one that build.json names, or has 4 GB
/// \throws base::OutputError  it cannot be written
ArchiveSummary write_archive(const std::string& build, const std::map<std::string, BuildFile>& files,
                             const std::string& path, base::Progress& progress);

/// A ZIP archive in the making, for write_archive and its tests.
class ZipWriter {
 public:
  /// \param append  takes the next bytes of the file
  explicit ZipWriter(std::function<void(std::string_view)> append) : append_(std::move(append)) {}
  /// \param deflate  where that is smaller  \returns  where the entry begins
  std::uint64_t add(std::string_view name, std::string_view bytes, bool deflate);
  /// Writes the directory.
  void close();
  std::uint64_t size() const { return size_; }
  /// For tests: as if so many bytes stood before.
  void pretend_size(std::uint64_t size) { size_ = size; }

 private:
  void write(std::string_view bytes);

  std::function<void(std::string_view)> append_;
  std::string directory_;
  std::uint64_t size_ = 0, entries_ = 0;
};

}  // namespace blockrand::outward
