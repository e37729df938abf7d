// A folder of profiles and element files that a test writes.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "pipeline/base/error.h"
#include "styles/elements/element_catalogue.h"

namespace blockrand::elements::test {

/// Gone at the end of the test.
class ElementFolder {
 public:
  explicit ElementFolder(const std::string& name = "a") {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string(test->test_suite_name()) + "_" + test->name() + "_" + name);
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_ / "elements");
    std::filesystem::create_directories(path_ / "profiles");
  }
  ElementFolder(const ElementFolder&) = delete;
  ElementFolder& operator=(const ElementFolder&) = delete;
  ~ElementFolder() { std::filesystem::remove_all(path_); }

  std::string path() const { return path_.string(); }
  void write(const std::string& file, const std::string& text) const {
    std::ofstream(path_ / file, std::ios::binary) << text;
  }

  /// What is read of configs/ and this folder.
  ElementCatalogue read(const ModelReader& reader = {}) const {
    return read_element_catalogue(std::vector<std::string>{BLOCKRAND_SOURCE_DIR "/configs", path()}, reader);
  }
  /// The message of the error; empty where it is read.
  std::string error(const ModelReader& reader = {}) const {
    try {
      (void)read(reader);
    } catch (const base::InputError& e) {
      return e.what();
    }
    return "";
  }
  /// The message where the folder has that element file alone.
  std::string error_of(const std::string& text, const ModelReader& reader = {}) const {
    write("elements/thing.toml", text);
    return error(reader);
  }

 private:
  std::filesystem::path path_;
};

}  // namespace blockrand::elements::test
