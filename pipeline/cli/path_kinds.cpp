#include "pipeline/cli/path_kinds.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <vector>

#include "pipeline/base/error.h"

namespace blockrand::cli {
namespace {

namespace fs = std::filesystem;

bool holds(const std::string& folder, const char* name) {
  std::error_code error;
  return fs::exists(fs::path(folder) / name, error);
}

bool is_extract_name(std::string name) {
  std::ranges::transform(name, name.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  constexpr std::string_view kEnds[] = {".osm", ".pbf", ".osm.gz", ".osm.bz2", ".o5m"};
  return std::ranges::any_of(kEnds, [&](std::string_view end) { return name.ends_with(end); });
}

/// The extract in a folder, where there is one alone; else empty.
std::string only_extract_in(const std::string& folder) {
  std::error_code error;
  std::string found;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_extract_name(entry->path().filename().string())) {
      if (!found.empty()) return {};
      found = entry->path().string();
    }
  return found;
}

}  // namespace

void expect_extract(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return;
  if (holds(path, "build.json"))
    throw base::InputError(path, "", "this is a build, where an extract should stand",
                           "To look at it: blockrand view " + path + ". To check it: blockrand validate " + path);
  if (holds(path, "region.toml"))
    throw base::InputError(path, "", "this is a region, where an extract should stand",
                           "To rebuild it: blockrand update " + path + ". What is published: blockrand status " + path);
  const std::string inner = only_extract_in(path);
  throw base::InputError(path, "", "this is a directory",
                         "Name the OSM file itself" + (inner.empty() ? "" : ". Did you mean " + inner + "?"));
}

void expect_build(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error))
    throw base::UsageError(path + " does not exist. Name the output folder of a build: blockrand build EXTRACT -o " +
                           (path.empty() ? "FOLDER" : path) + " makes one.");
  if (!fs::is_directory(path, error)) {
    const fs::path parent = fs::path(path).parent_path();
    if (is_extract_name(path))
      throw base::UsageError(path + " is an extract, not a build. To build it: blockrand build " + path +
                             " -o FOLDER. What is in it: blockrand info " + path);
    if (holds(parent.empty() ? "." : parent.string(), "build.json"))
      throw base::UsageError(
          path + " is a file of a build. Name the build's folder: " + (parent.empty() ? "." : parent.string()));
    throw base::UsageError(path + " is no folder. Name the output folder of a build.");
  }
  if (holds(path, "build.json")) return;
  if (holds(path, "region.toml")) {
    const std::string current = (fs::path(path) / "current").string();
    throw base::UsageError(path + " is a region, not a build. " +
                           (fs::exists(current, error) ? "Its published build is " + current
                                                       : "It has no build yet: blockrand update " + path));
  }
  throw base::UsageError(path + " is no build: there is no build.json in it. Name the output folder of a build.");
}

}  // namespace blockrand::cli
