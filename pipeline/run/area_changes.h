// Which tiles of an area the changes of a map concern, and what must be read to work on these.
#pragma once

#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "importers/osm/extract_store.h"
#include "pipeline/georef/projection.h"
#include "pipeline/run/area_reach.h"
#include "pipeline/run/tile_choice.h"

namespace blockrand::run {

struct AreaChanges {
  std::set<model::TileId> tiles;  ///< empty, and no reason to look into all: nothing here differs
  /// West, south, east, north in degrees: what must be read to look into them; and around all of it.
  std::vector<std::array<double, 4>> parts;
  std::array<double, 4> window{};
  std::set<model::TileId> other_network;  ///< of the tiles: those near which streets or the like changed
  std::string why_whole;                  ///< not empty: all tiles are to be looked into, and why
};

/// What district rules ask for beyond a tile.
struct RulesReach {
  double metres = 0;       ///< how far they look at most (rules_reach)
  bool asks_look = false;  ///< rules_ask_look
};

/// \param reaches       of all tiles of the area, as they were before the changes
/// \param surroundings  are made
AreaChanges concerned_tiles(const TileChoice& area, const AreaReach& reaches,
                            std::span<const importers::osm::ChangedObject> changes, const RulesReach& rules,
                            bool surroundings, const georef::Projection& projection);

}  // namespace blockrand::run
