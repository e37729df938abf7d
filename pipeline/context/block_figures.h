// What stands in a block: built share, floor area ratio, closure of the perimeter, courtyards.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/context/blocks.h"
#include "pipeline/context/courtyards.h"

namespace blockrand::context {

/// How the built share of a street front is measured.
struct FrontOptions {
  double sample_step = 2;  ///< m between samples along the perimeter; half a narrow house
  /// m from the centre line inwards. The widest streets have their building line 35 m from the nearer centre line.
  double max_depth = 40;
  /// m. What stands this much behind the building line is no longer the front but a house behind it.
  double front_tolerance = 6;
  /// m. Where a side has no building: how far the corner is cut off its neighbours. Half a common street.
  double half_street = 9;
  double corner_cosine = 0.866;  ///< cos 30 degrees: where the perimeter turns more, a new side begins
};

struct BlockFigures {
  std::vector<std::uint32_t> buildings;  ///< indices of the footprints of buildings that belong to it, by OSM id
  std::vector<Courtyard> courtyards;     ///< `buildings` are indices of footprints
  double built_area = 0;                 ///< m² of footprints within the block
  double tagged_area = 0;                ///< m² of it under buildings with tagged storeys
  double floor_area = 0;                 ///< m², sum over these of area times storeys
  double courtyard_area = 0;             ///< m²

  // Ratios: for blocks that give any (Block::gives_ratios).
  std::optional<double> built_share;       ///< built area / block area. The block reaches to the centre lines of its
                                           ///< streets, so this is less than the GRZ of its lots
  std::optional<double> tagged_share;      ///< tagged area / built area, where something is built
  std::optional<double> floor_area_ratio;  ///< GFZ: built share times mean storeys of the tagged buildings by area; as
                                           ///< good as `tagged_share`; empty where nothing is tagged
  std::optional<double> closure;           ///< share of the street front that is built
  double front_length = 0;                 ///< m of street front that was measured
};

/// m² of a polygon of a building that count to a block: all where every corner of its outer ring lies in the block, none
/// where no corner does, else what both have in common (none below 0.5 m²: drawing noise).
double area_within(const model::Polygon& building, const model::Polygon& block);

/// Figures of every block, parallel to `blocks`.
///
/// A building, all its polygons together, belongs to the block that holds more than half of its area; to none where no
/// block does. Each block counts the area within it (area_within). Courtyards and the front are made by what stands in
/// the block: polygons with more than half of their own area in it.
///
/// Closure: along streets and squares (Block::along_street); banks and railways are no front, and a block without a street
/// has no closure. The perimeter is cut into sides at corners. From samples along a side a ray goes inwards; the building line
/// of the side is the lower quartile of the distances at which rays from its streets meet a wall, and a sample is built when its ray
/// meets a wall no more than `front_tolerance` behind that line. Samples beside a corner, whose rays run along the
/// other street, are left out: a side ends where the building line of its neighbour crosses its own. Islands in the
/// block are not measured.
///
/// \param lines  the network of find_blocks: its streets lead into no courtyard
///
/// Sums run in the order of OSM ids: the result does not depend on the order of footprints, nor on other blocks; the
/// figures of a block depend on buildings that reach into it and on streets within its box alone.
std::vector<BlockFigures> measure_blocks(std::span<const Block> blocks, std::span<const Footprint> footprints,
                                         std::span<const NetworkLine> lines, const FrontOptions& front = {},
                                         const CourtyardOptions& courtyards = {});

}  // namespace blockrand::context
