// The data of a region on disk: an extract, and change files (osmChange) applied to it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "importers/osm/clip_polygon.h"

namespace blockrand::importers::osm {

/// Objects before and after (changed_objects.h), for the store that comes after (update_store.h).
class ChangedObjects;
std::shared_ptr<ChangedObjects> no_changed_objects();

/// Whether a file's name says that it holds changes: .osc, .osc.gz, .osc.bz2, in small letters or capitals.
bool is_change_file(std::string_view path);

/// What became of the objects of change files.
struct AppliedChanges {
  std::uint64_t created = 0, modified = 0;
  std::uint64_t deleted = 0;   ///< or gone from the polygon
  std::uint64_t known = 0;     ///< that the data has in this version or a newer one already
  std::uint64_t outside = 0;   ///< of change files: beyond the polygon, as it was before
  bool cleaned_texts = false;  ///< NUL characters in texts of the base were replaced
  bool any() const { return created + modified + deleted > 0; }
};

/// The number of the newest change file that is in an extract, as its header says; nothing where it does not.
/// \throws base::InputError
std::optional<std::uint64_t> replication_sequence(const std::string& path);

/// Writes the objects of `base` with those of the change files in their place as PBF, sorted by type and id, with versions
/// and times. Of several versions of an object the highest counts, wherever it stands; of equal ones that of the later
/// file, in it the last one. All nodes, ways and relations are kept, not only those that a build reads: a later change may
/// bring a tag without the nodes. Deletions are kept as well, as objects that are not visible, so that an older change that
/// comes later does not bring back what was deleted. Memory: the changes; of a base that is not sorted the base as well.
/// \param clip  null: everything stays. Else nodes in it, ways that have one of these with all of their nodes, relations that have one
///              of these, multipolygons and buildings among them with all of their nodes and ways; deletions of what the base had. A way that
///              grows into it later may lack nodes that were outside before: the next full extract brings them. Memory: 1 bit for
///              each id near a kept one, and members of all relations
/// \param changed  null, or gets every object that is another one in `out` than in the base
/// \throws base::InputError   a file is missing, damaged, cut off, or not what its name says
/// \throws base::OutputError  `out` cannot be written; nothing is left of it then
AppliedChanges apply_changes(const std::string& base, std::span<const std::string> changes, const std::string& out,
                             const ClipPolygon* clip = nullptr, ChangedObjects* changed = nullptr);

}  // namespace blockrand::importers::osm
