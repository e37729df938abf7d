// Walls that two footprints share, first version: edges with the same two OSM nodes.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/model/extract.h"
#include "pipeline/model/region.h"

namespace blockrand::context {

/// All edges that occur in the rings of at least two different buildings of an extract, by their OSM nodes.
/// Read-only after construction, safe to share.
class SharedEdges {
 public:
  using Key = std::pair<std::int64_t, std::int64_t>;  ///< nodes, smaller first
  static Key key(std::int64_t a, std::int64_t b) { return a < b ? Key{a, b} : Key{b, a}; }

  /// Buildings that are duplicates or reported do not count, nor do building parts: they share walls with their own.
  explicit SharedEdges(const model::Extract& extract);

  /// Index of the shared edge, or -1.
  std::int64_t find(std::int64_t from_node, std::int64_t to_node) const;
  /// The buildings of shared edge `index`: the first two of Extract::buildings that have it.
  std::pair<std::uint32_t, std::uint32_t> owners(std::int64_t index) const { return owners_[static_cast<std::size_t>(index)]; }
  std::size_t size() const { return keys_.size(); }

 private:
  std::vector<Key> keys_;  ///< sorted
  std::vector<std::pair<std::uint32_t, std::uint32_t>> owners_;  ///< parallel to keys_
};

/// Marks the party walls among `Building::edges`.
void mark_party_walls(model::Region& region, const SharedEdges& shared);

}  // namespace blockrand::context
