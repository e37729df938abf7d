// Which walls of a row are one wall, and how sloppily the row was drawn.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "pipeline/footprints/repair/options.h"
#include "pipeline/footprints/repair/terrace_vertices.h"

namespace blockrand::repair {

/// Two edges of different buildings at the same level that are one wall, seen along their common axis. The axis runs with
/// edge `e`; `low` and `high` are the ends of what they have in common.
struct Contact {
  struct End {
    std::uint32_t of_e = 0, of_f = 0;  ///< the vertices of both edges at this end
    double gap = 0;                    ///< m, from e outward to f; negative where they overlap
    double along = 0;                  ///< m, how far f's vertex lies before (negative) or behind e's along the axis
    bool e_inside = false;             ///< e's vertex is the end of what is common, f goes on behind it
  };
  std::uint32_t e = 0, f = 0;  ///< edges (index of their first vertex), e of the building that comes first
  End low, high;
  double length = 0;    ///< m, in common
  bool opposed = true;  ///< false: they run the same way, one footprint lies over the other
};

struct Contacts {
  std::vector<Contact> walls;
  /// Corners that stand at the same mouth of an alley (walls that face each other across a gap wider than a slip of
  /// mapping): never one corner. Least vertex first, sorted.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> apart;
  /// m, by building: how far two copies of one point differ, as standard deviation per coordinate. Estimated from the
  /// ends of its contacts that were not drawn on the same point, with the row's and a fixed prior behind it.
  std::vector<double> noise;
};

/// Finds the walls that are one. Two edges qualify where they run against each other, have at least `min_overlap` in
/// common, lie no farther apart than `snap_distance` in the mean and `snap_reach` at the ends (less where the noise of
/// the row would let alleys of 0.8 m close), and differ in direction by no more than `snap_angle` and the noise of their
/// ends. Edges that run the same way qualify where the buildings overlap anyhow. Cost O(n log n) in edges.
Contacts find_contacts(const TerraceVertices& vertices, const TerraceRow& row, const RepairOptions& options);

}  // namespace blockrand::repair
