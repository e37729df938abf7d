// How much was built, and where its values come from.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/masses/roofscape.h"
#include "pipeline/model/region.h"
#include "pipeline/model/surroundings.h"

namespace blockrand::outputs {

/// Sums over the whole build, with every shared wall counted once.
struct Statistics {
  double footprint_area = 0;     ///< m²
  double outer_wall_area = 0;    ///< m², without what neighbours cover
  double party_wall_area = 0;    ///< m², each wall between two buildings once
  double party_wall_length = 0;  ///< m
  std::uint64_t party_walls = 0;
  double volume = 0;            ///< m³ of the best solids
  std::uint64_t buildings = 0;  ///< with at least one body: what every format holds as a building
  std::uint64_t bodies = 0;     ///< parts, rests of outlines, and buildings without parts
  std::uint64_t solids_lod1 = 0, solids_lod2 = 0, solids_lod3 = 0;
  std::uint64_t windows = 0, doors = 0;                                  ///< polygons of openings in LoD3 solids
  std::uint64_t dormers = 0, cross_gables = 0;                           ///< that LoD3 solids have
  std::uint64_t placements = 0;                                          ///< elements placed in and on walls
  std::uint64_t installations = 0;                                       ///< bodies of their own on walls and roofs
  std::map<std::string, std::map<std::string, std::uint64_t>> sources;   ///< attribute → source → parts
  std::map<std::string, std::uint64_t> roofs;                            ///< built roof shape → parts
  std::array<std::uint64_t, model::kWallSegmentKindCount> edges{};       ///< wall segments by model::WallSegmentKind
  std::array<double, model::kWallSegmentKindCount> edge_length{};        ///< m
  std::array<std::uint64_t, model::kBuildingPositionCount> positions{};  ///< buildings by model::BuildingPosition
  masses::Roofscape roofscape;
};

/// One building's side of a shared wall.
struct PartySide {
  std::uint64_t wall = 0;    ///< of both ends: the same for both sides, others' differ but for one in 10^8 cities
  double length = 0;         ///< m
  double base = 0, top = 0;  ///< m above the height reference
};

/// A tile's share. Party walls are settled when both sides are known.
struct TileStatistics {
  Statistics sums;
  std::vector<PartySide> party_sides;
  std::vector<masses::SlopeEnd> slope_ends;             ///< whose neighbours are not in the tile
  std::vector<model::SurroundingOutcome> surroundings;  ///< of objects that come into the tile's squares
};

TileStatistics count_statistics(const model::Region& region);

/// Adds a tile's sums to those of the build; in tile order, since sums of floats depend on theirs.
void add(Statistics& sum, const Statistics& tile);

/// Pairs up the sides of shared walls: each shows what the other does not cover, above and, on a
/// slope, below. \param alone  gets the sides whose other is not among them, which count as outer walls; null: nobody asks
void settle_party_walls(std::vector<PartySide> sides, Statistics& sum, std::vector<PartySide>* alone = nullptr);

}  // namespace blockrand::outputs
