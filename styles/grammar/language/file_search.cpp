#include "styles/grammar/language/file_search.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace blockrand::grammar {

namespace {

bool same_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}

std::string joined(std::string_view folder, std::string_view path) {
  if (folder.empty()) return std::string(path);
  std::string all(folder);
  if (!all.ends_with('/')) all += '/';
  while (path.starts_with('/')) path.remove_prefix(1);
  return all + std::string(path);
}

/// Where a path may lie, best first.
struct Place {
  std::string folder;
  std::string rest;
};

std::vector<Place> places(std::string_view path, std::string_view from, const LoadOptions& options) {
  std::vector<Place> all;
  if (from.empty()) return {{"", std::string(path)}};
  if (path.starts_with('/')) {
    const std::pair<std::string, std::string>* longest = nullptr;
    for (const auto& mount : options.mounts)
      if (path.starts_with(mount.first) && (longest == nullptr || mount.first.size() > longest->first.size()))
        longest = &mount;
    if (longest != nullptr) all.push_back({longest->second, std::string(path.substr(longest->first.size()))});
    for (const std::string& root : options.roots) all.push_back({root, std::string(path.substr(1))});
    return all;
  }
  const std::size_t slash = from.find_last_of('/');
  all.push_back({slash == std::string_view::npos ? "" : std::string(from.substr(0, std::max<std::size_t>(slash, 1))),
                 std::string(path)});
  for (const std::string& root : options.roots)
    for (const char* folder : {"", "assets", "rules"}) all.push_back({joined(root, folder), std::string(path)});
  return all;
}

/// The path below `folder` with the case of letters that the disk has.
std::optional<std::string> corrected(const Place& place, const FolderLister& list) {
  std::string path = place.folder;
  std::string_view rest = place.rest;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('/'), rest.size());
    const std::string_view part = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (part.empty() || part == ".") continue;
    if (part == "..") {
      path = normal_path(joined(path, ".."));
      continue;
    }
    std::vector<std::string> entries = list(path);
    std::sort(entries.begin(), entries.end());
    auto found = std::find(entries.begin(), entries.end(), part);
    if (found == entries.end())
      found = std::find_if(entries.begin(), entries.end(),
                           [&](const std::string& entry) { return same_ignoring_case(entry, part); });
    if (found == entries.end()) return std::nullopt;
    path = joined(path, *found);
  }
  return path;
}

}  // namespace

std::string normal_path(std::string_view path) {
  std::string slashes(path);
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  return std::filesystem::path(slashes).lexically_normal().generic_string();
}

std::optional<FoundFile> find_file(std::string_view path, std::string_view from, const LoadOptions& options) {
  if (!options.read || path.empty() || path.find('\0') != std::string_view::npos) return std::nullopt;
  std::string slashes(path);
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const std::vector<Place> all = places(slashes, from, options);
  for (const Place& place : all) {
    std::string full = normal_path(joined(place.folder, place.rest));
    if (std::optional<std::string> bytes = options.read(full)) return FoundFile{std::move(full), std::move(*bytes), {}};
  }
  if (!options.list) return std::nullopt;
  for (const Place& place : all) {
    const std::optional<std::string> other = corrected(place, options.list);
    if (!other) continue;
    std::string full = normal_path(*other);
    if (std::optional<std::string> bytes = options.read(full)) return FoundFile{full, std::move(*bytes), full};
  }
  return std::nullopt;
}

}  // namespace blockrand::grammar
