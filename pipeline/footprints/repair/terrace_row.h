// A terrace row: footprints that touch or almost touch, repaired together; and its topology while that happens.
//
// The way of a row: build_terrace_graph makes one corner of what several footprints mean as one, and puts corners where a
// neighbour ends in the middle of a wall; square_terrace_row moves corners, and with them every ring that has them;
// apply_terrace_graph writes the rings back. A wall is shared when two rings have the same corners.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pipeline/model/building.h"
#include "pipeline/model/polygon.h"
#include "pipeline/model/report.h"

namespace blockrand::repair {

/// Where a building stands in height: footprints conflict only where these meet. Metres above the ground.
struct Level {
  int layer = 0;        ///< OSM's layer tag: another layer, another level
  bool canopy = false;  ///< building=roof: stands over others and beside them
  double low = 0, high = std::numeric_limits<double>::infinity();
};
/// True when both may stand at the same height.
inline bool same_level(const Level& a, const Level& b) {
  return a.layer == b.layer && a.canopy == b.canopy && a.low < b.high && b.low < a.high;
}

/// A footprint of a row. `polygons` are valid before and after.
struct TerraceBuilding {
  model::OsmId id;
  std::vector<model::Polygon> polygons;
  Level level;
  bool has_parts = false;  ///< mapped parts describe it: stronger than an outline alone where two overlap
  int tags = 0;            ///< how much the mapper said of it
  model::ObjectState settled = model::ObjectState::pending;  ///< out: duplicate or represented, then without polygons
  model::OsmId related;                                      ///< out: of whom, by whom
  std::vector<model::Arc> arcs;                              ///< out: curves of the repaired polygons
  model::RepairRecord record;                                ///< mapped_area given; the rest out
};

struct TerraceRow {
  std::vector<TerraceBuilding> buildings;  ///< by OSM id
  std::vector<model::Polygon>
      beyond_cut;  ///< footprints of buildings that REACH_CUT put into other rows. Corners within
                   ///< `snap_reach` of them stay where they are
};

/// One corner of the row's topology.
struct Corner {
  model::Point2 start;     ///< m, before squaring: the mean of what is said
  model::Point2 position;  ///< m; where it ends. Equal to `start` at first
  std::vector<model::Point2>
      said;               ///< m, ascending, each once: where footprints have the corner (copies of one node say one
                          ///< thing); empty for the foot of a neighbour's wall alone
  bool fixed = false;     ///< must not move
  std::int64_t node = 0;  ///< OSM node, the least of those merged; 0 where repair made it
};

/// A ring of a footprint as a list of corners.
struct TerraceRing {
  std::uint32_t building = 0;  ///< index into TerraceRow::buildings
  std::uint32_t polygon = 0;   ///< index into its polygons
  std::uint32_t ring = 0;      ///< 0: outer; k: holes[k - 1]
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t>
      wall;  ///< parallel to `corners`: which edge of the ring before sharing the edge from here to the
             ///< next corner is a piece of; pieces of one wall stay in line
};

struct TerraceGraph {
  std::vector<Corner> corners;
  std::vector<TerraceRing> rings;  ///< by building, polygon, ring
};

}  // namespace blockrand::repair
