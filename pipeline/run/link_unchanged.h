// Builds of a region share the files that they have in common.
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace blockrand::run {

struct LinkedFiles {
  std::uint64_t files = 0, bytes = 0;
};

/// Files that both builds have become one on disk, where the disk has hard links.
/// \param before, after  folders of builds
/// \param taken_over     areas whose files were linked when they were taken over: they are counted
LinkedFiles link_unchanged(const std::string& before, const std::string& after,
                           const std::set<std::string>& taken_over);

}  // namespace blockrand::run
