// A file of a folder that strangers name: nothing outside of the folder is ever opened.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blockrand::view {

/// An open file that can be read from several threads.
class FileBeneath {
 public:
  /// \param folder  without links itself
  /// \param path    relative, '/' between names. None of these is opened: empty or hidden names, `.`, `..`, a backslash, a control
  ///                character, a link that leads out of the folder, anything but a regular file
  static std::shared_ptr<const FileBeneath> open(const std::string& folder, std::string_view path);
  ~FileBeneath();
  FileBeneath(const FileBeneath&) = delete;
  FileBeneath& operator=(const FileBeneath&) = delete;

  std::uint64_t size() const { return size_; }
  /// Another one when the file was changed: for ETag.
  std::string version() const;
  /// Up to `length` bytes from `offset` on. \returns nothing where the file cannot be read
  std::optional<std::string> read(std::uint64_t offset, std::size_t length) const;

 private:
  FileBeneath(int descriptor, std::uint64_t size, std::int64_t changed, std::uint64_t inode)
      : descriptor_(descriptor), size_(size), changed_(changed), inode_(inode) {}
  int descriptor_;
  std::uint64_t size_;
  std::int64_t changed_;  ///< ns
  std::uint64_t inode_;
};

/// Whether a path may be looked for at all, as open() says.
bool is_plain_path(std::string_view path);

}  // namespace blockrand::view
