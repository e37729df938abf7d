// Files of a build as they are read and written here: whole, or not at all.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/outward/build_files.h"

namespace blockrand::outward {

/// A file beside its place (PLACE.blockrand-part), which takes that place when it is whole; else it is removed.
class PartFile {
 public:
  /// \throws base::OutputError  it cannot be written
  explicit PartFile(const std::string& place);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// \throws base::OutputError
  void append(std::string_view bytes);
  /// Readers see it from now on. Nothing says that it is on the disk. \throws base::OutputError
  void publish();
  /// The same; the file is on the disk before readers see it, and its name when this returns. \throws base::OutputError
  void publish_on_disk();

 private:
  std::string place_, part_;
  int descriptor_ = -1;
  bool done_ = false;
};

/// \throws base::OutputError  with what the system says of `error`, and the remedy
[[noreturn]] void cannot_put(const std::string& path, int error);

/// The bytes of a file of a build.
/// \throws base::InputError  it is missing, or is not the one that the build's record names
std::string whole_file(const std::string& build, const BuildFile& file);

/// \throws base::InputError  `place` is not the file that the build's record names
[[noreturn]] void throw_damaged(const std::string& place);

/// A place that is written may lie neither in a region nor in a build, which both hold nothing but their own.
/// \param option  "--web-root", for the message
/// \throws base::UsageError  the place, or a folder above it, is one
void refuse_own_folders(const std::string& option, const std::string& place);

}  // namespace blockrand::outward
