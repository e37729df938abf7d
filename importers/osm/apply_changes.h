// The data of a region on disk: an extract, and change files (osmChange) applied to it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace blockrand::importers::osm {

/// Whether a file's name says that it holds changes: .osc, .osc.gz, .osc.bz2.
bool is_change_file(std::string_view path);

/// What became of the objects of change files.
struct AppliedChanges {
  std::uint64_t created = 0, modified = 0, deleted = 0;
  std::uint64_t known = 0;  ///< that the data has in this version or a newer one already
  bool any() const { return created + modified + deleted > 0; }
};

/// What a file's header says of where its data comes from.
struct ReplicationState {
  std::optional<std::uint64_t> sequence;
  std::string time;  ///< ISO 8601, or empty
};
/// \throws base::InputError
ReplicationState replication_state(const std::string& path);

/// Writes the objects of `base` with those of the change files in their place as PBF, sorted by type and id, with versions
/// and times. Of several versions of an object the highest counts, wherever it stands; of equal ones that of the later
/// file. Deleted objects are left out: a deletion counts when its version is not lower than the data's. All nodes, ways and
/// relations are kept, not only those that a build reads: a later change may bring a tag without the nodes.
/// The same data gives the same bytes, in whichever format and order it came.
/// Memory: the changes; of a base that is not sorted the base as well.
/// \param state  written into the header, where it is known
/// \throws base::InputError   a file is missing, damaged, cut off, or not what its name says
/// \throws base::OutputError  `out` cannot be written; nothing is left of it then
AppliedChanges apply_changes(const std::string& base, std::span<const std::string> changes, const std::string& out,
                             const ReplicationState& state = {});

}  // namespace blockrand::importers::osm
