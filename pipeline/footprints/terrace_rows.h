// Which buildings are repaired together.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/footprints/footprint_store.h"

namespace blockrand::footprints {

/// m, longer side of the box of a row. Longer rows are cut at the lines of a fixed grid (REACH_CUT): what a row becomes
/// depends on data within this distance of it. Berlin's longest row is 2.5 km.
inline constexpr double kMaxTerraceRowExtent = 1000;
/// m. Rows that are too long are cut between buildings whose middles lie in different cells of this size.
inline constexpr double kTerraceRowCell = 500;

struct TerraceRowPlan {
  std::vector<std::uint32_t> buildings;  ///< numbers in the store, by OSM id
  std::vector<std::uint32_t> beyond;     ///< buildings of other rows, near these, that a cut parted from them
};

/// Groups the buildings of the store into rows: of one row are those that come within `link_distance` metres of each
/// other, or overlap, and so on from one to the next. Buildings without an outline are in none.
/// The rows come in the order of their least building. A row depends on buildings within kMaxTerraceRowExtent of it alone (and
/// on whether the chain of buildings goes on beyond): a part of the extract that reaches this far gives the same.
std::vector<TerraceRowPlan> find_terrace_rows(const FootprintStore& store, double link_distance);

}  // namespace blockrand::footprints
