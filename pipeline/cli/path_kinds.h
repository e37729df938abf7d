// What people named, where it is another thing than a command takes.
#pragma once

#include <string>

namespace blockrand::cli {

/// \throws base::InputError  a folder stands where an extract should: which one it is, and the command for it
void expect_extract(const std::string& path);

/// \throws base::UsageError  no folder, or one that is no build, stands where a build should: what it is, and the command for it
void expect_build(const std::string& path);

}  // namespace blockrand::cli
