// Files as bytes, plain or gzipped. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace blockrand::importers::reference {

/// \throws base::InputError  when there is no such file, or it is a folder or empty
void check_readable(const std::string& path);

/// On disk; 0 where there is no such file.
std::uint64_t size_on_disk(const std::string& path);

/// Bytes of a plain or gzipped file, one piece after the other; zlib tells them apart.
class ByteReader {
 public:
  /// \throws base::InputError  when it cannot be opened
  explicit ByteReader(const std::string& path);
  ~ByteReader();
  ByteReader(const ByteReader&) = delete;
  ByteReader& operator=(const ByteReader&) = delete;

  /// The next bytes; 0 at the end. A damaged archive ends where it is damaged, so that what came before is read.
  std::size_t read(char* buffer, std::size_t length);
  bool damaged() const { return damaged_; }

  /// The next line without its end; nothing after the last. \throws base::InputError  when it exceeds kLongestText
  std::optional<std::string> line();

 private:
  std::string path_;
  struct File;
  std::unique_ptr<File> file_;
  bool damaged_ = false;
  std::string buffer_;  ///< read, but not yet given away by line()
  std::size_t used_ = 0;
};

/// Longest text that is taken into memory at once: a line, or a JSON document. An archive of a few megabytes may hold
/// terabytes.
inline constexpr std::size_t kLongestText = std::size_t{4} << 30;

/// The first bytes of a file, unpacked; `length` of them or all.
std::string first_bytes(const std::string& path, std::size_t length);

/// All bytes, unpacked. \throws base::InputError  when there are more than kLongestText, or the archive is damaged
std::string all_bytes(const std::string& path);

}  // namespace blockrand::importers::reference
