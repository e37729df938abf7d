// The outer structure of a PBF file: what libosmium does not check, and the one thing it cannot read.
#pragma once

#include <string>
#include <unordered_set>

namespace blockrand::importers::osm {

/// Walks over the blobs, unpacking the first with data only. libosmium takes a file that ends within the length field of a blob, or
/// with zero bytes, as complete; a download cut there would lose objects silently. Nor does it
/// mind coordinates of granularity 0.
/// \throws base::InputError with the byte where the file stops making sense
void check_pbf_structure(const std::string& path);

/// A PBF file in memory whose strings hold no NUL.
struct CleanedPbf {
  std::string bytes;
  std::unordered_set<std::string> cleaned;  ///< the strings that held one, as they are now
};

/// libosmium keeps the tags of an object as NUL-terminated strings, so a NUL within one shifts all that follow. This
/// rewrites the string tables of such a file with U+FFFD in its place. Needed once in a blue moon: the whole file is
/// held in memory.
/// \throws base::InputError when the file cannot be unpacked
CleanedPbf clean_pbf_strings(const std::string& path);

}  // namespace blockrand::importers::osm
