// One tile's worth of buildings: the unit of work. Exists while its tile is in flight only.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/model/building.h"
#include "pipeline/model/element.h"
#include "pipeline/model/report.h"
#include "pipeline/model/sourced.h"

namespace blockrand::model {

/// Tile of the geodetic quadtree: at level L the globe is 2^(L+1) x 2^L tiles; x counts from 180 W, y from 90 S.
struct TileId {
  int level = 15;
  std::uint32_t x = 0, y = 0;
  friend auto operator<=>(const TileId&, const TileId&) = default;
};

/// A mapped part that could not be built.
struct PartFailure {
  std::uint32_t mapped_index = kNoIndex;  ///< into Extract::buildings
  IssueCode code = IssueCode::none;
};

/// A mapped part of a building without an outline of its own, whose head turned out to be drawn elsewhere: it goes the
/// head's way.
struct SettledPart {
  std::uint32_t mapped_index = kNoIndex;  ///< into Extract::buildings
  ObjectState state = ObjectState::duplicate;
  OsmId related;  ///< who stands for it
};

struct Region {
  TileId tile;
  const Extract* extract = nullptr;       ///< for tags; outlives the region
  std::vector<Building> buildings;        ///< sorted by OSM id
  std::vector<MaterialClass> materials;   ///< what Face::material indexes
  std::vector<ColouredElement> elements;  ///< what Placement::element indexes
  EvidenceTable evidence;
  std::vector<PartFailure> part_failures;
  std::vector<SettledPart> settled_parts;
  Report report;
};

}  // namespace blockrand::model
