// Nodes that mean more than a corner: they stay even where the wall runs straight on.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/extract.h"

namespace blockrand::repair {

/// An immutable sorted set of OSM node ids that must not be dropped as collinear. Eight bytes per node.
class KeptNodes {
 public:
  /// None.
  KeptNodes() = default;
  /// These; in any order, repeated or not.
  explicit KeptNodes(std::vector<std::int64_t> nodes);
  /// Nodes that are features themselves (entrances, addresses, shops ...), that a line feature uses (street, passage,
  /// barrier, roof line), or that two pending buildings or parts use. Objects that are not pending do not count: a
  /// duplicate would keep all nodes of the building that it repeats. Memory while it works: eight bytes per vertex of
  /// the pending objects.
  explicit KeptNodes(const model::Extract& extract);

  bool contains(std::int64_t node) const;
  std::size_t size() const { return nodes_.size(); }

 private:
  std::vector<std::int64_t> nodes_;  ///< sorted, each once, never 0
};

}  // namespace blockrand::repair
