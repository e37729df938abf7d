// One file that is written whole or not at all.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "pipeline/base/error.h"

namespace blockrand::cli {

/// A file that is written beside its place and moved there at the end: what stood there stays where something fails.
class StagedFile {
 public:
  /// \throws OutputError  nothing can be written there
  explicit StagedFile(std::string target)
      : target_(std::move(target)),
        staging_(target_ + ".part-" + std::to_string(getpid())),
        out_(staging_, std::ios::binary) {
    std::error_code none;
    if (!out_ || std::filesystem::is_directory(target_, none)) fail();
  }
  ~StagedFile() {
    std::error_code none;
    std::filesystem::remove(staging_, none);
  }
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  void publish(const std::string& text) {
    out_ << text;
    out_.close();
    std::error_code error;
    if (out_) std::filesystem::rename(staging_, target_, error);
    if (!out_ || error) fail();
  }

 private:
  [[noreturn]] void fail() {
    out_.close();
    std::error_code none;
    std::filesystem::remove(staging_, none);
    throw base::OutputError(target_ + ": cannot be written. Check the folder and the space on the disk");
  }
  std::string target_, staging_;
  std::ofstream out_;
};

}  // namespace blockrand::cli
