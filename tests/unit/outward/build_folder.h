// A folder that looks like a build, for tests of publishing.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/base/sha256.h"

namespace blockrand::outward {

/// A folder of its own for each test, gone at its end.
class TestFolder : public testing::Test {
 protected:
  TestFolder()
      : folder_(testing::TempDir() + "blockrand-outward-" +
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~TestFolder() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  static void write(const std::string& place, const std::string& bytes) {
    std::filesystem::create_directories(std::filesystem::path(place).parent_path());
    std::ofstream(place, std::ios::binary) << bytes;
  }

  /// \param files  path → bytes; a build.json that names them is written, too
  std::string build(const std::string& name, const std::map<std::string, std::string>& files,
                    const nlohmann::ordered_json& areas = {}) const {
    nlohmann::ordered_json record = {{"files", nlohmann::ordered_json::object()}};
    for (const auto& [file, bytes] : files) {
      write(path(name + "/" + file), bytes);
      record["files"][file] = {{"bytes", bytes.size()}, {"sha256", base::sha256_of(bytes)}};
    }
    if (!areas.empty()) record["areas"] = areas;
    write(path(name + "/build.json"), record.dump());
    return path(name);
  }

  /// A tileset that leads to these.
  static std::string tileset(const std::vector<std::string>& contents) {
    nlohmann::ordered_json root = {{"children", nlohmann::ordered_json::array()}};
    for (const std::string& uri : contents) root["children"].push_back({{"content", {{"uri", uri}}}});
    return nlohmann::ordered_json{{"asset", {{"version", "1.1"}}}, {"root", root}}.dump();
  }

 private:
  std::string folder_;
};

}  // namespace blockrand::outward
