// The shipped configuration with one thing changed, and what reading it says.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "pipeline/base/error.h"

namespace blockrand::classify::test {

/// The message of the InputError when `read` reads a copy of configs/ whose `file` has the first `from` replaced by
/// `to`; empty when it reads well.
inline std::string complaint(const std::string& file, const std::string& from, const std::string& to,
                             const std::function<void(const std::string& configs)>& read) {
  namespace fs = std::filesystem;
  const fs::path configs = fs::path(BLOCKRAND_SOURCE_DIR) / "configs";
  const fs::path dir = fs::path(testing::TempDir()) / ("blockrand_classify_" + fs::path(file).stem().string());
  fs::remove_all(dir);
  for (const char* folder : {"styles", "materials"}) {
    fs::create_directories(dir / folder);
    fs::copy(configs / folder, dir / folder, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  std::ostringstream shipped;
  shipped << std::ifstream(configs / file).rdbuf();
  std::string text = shipped.str();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at == std::string::npos) return {};
  text.replace(at, from.size(), to);
  std::ofstream(dir / file) << text;
  std::string message;
  try {
    read(dir.string());
  } catch (const base::InputError& error) {
    message = error.what();
  }
  fs::remove_all(dir);
  return message;
}

}  // namespace blockrand::classify::test
