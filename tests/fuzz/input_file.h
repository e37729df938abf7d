// The bytes of an input as a file, for readers that want a path.
#pragma once

#include <stdlib.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace blockrand::fuzz {

/// A folder in memory for each process: libFuzzer runs several side by side. It goes with the process, unless that
/// crashes.
class InputFolder {
 public:
  InputFolder() {
    std::error_code error;
    path_ = std::filesystem::is_directory("/dev/shm", error) ? "/dev/shm/blockrand-fuzz-XXXXXX"
                                                             : "/tmp/blockrand-fuzz-XXXXXX";
    if (mkdtemp(path_.data()) == nullptr) std::abort();
  }
  ~InputFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline const std::string& folder() {
  static const InputFolder made;
  return made.path();
}

/// Writes a file of the folder anew. \param name  may lead into folders below it
/// \return its path
inline std::string write_file(const std::string& name, const std::uint8_t* data, std::size_t size) {
  const std::string path = folder() + "/" + name;
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return path;
}

}  // namespace blockrand::fuzz
